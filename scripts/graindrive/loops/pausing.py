"""After O.pause() the bodies are true, as on YADE's loop.

GrainLoop writes all bodies in the last step of a run, but a pause from outside may come when that step has looked already.
"""

from yade.wrapper import Omega

pause_of_yade = Omega.pause


def pause(omega):
    """Stop the run after the present step, and have GrainLoop write all bodies."""
    pause_of_yade(omega)
    for engine in omega.engines:
        if type(engine).__name__ == "GrainLoop":
            engine.showBodies()


pause.__doc__ = f"{pause_of_yade.__doc__}\n\n{pause.__doc__}"


def watch():
    """Put `pause` in the place of O.pause; a second call changes nothing."""
    Omega.pause = pause
