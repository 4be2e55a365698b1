"""Makes O.pause() leave all bodies up to date, as on YADE's loop.

GrainLoop writes all bodies in the last step of a run, but it may notice a pause from another thread too late for that.
"""

from yade.wrapper import Omega

pause_of_yade = Omega.pause


def pause(omega):
    """Stop the run after the present step, and make GrainLoop write all bodies."""
    pause_of_yade(omega)
    for engine in omega.engines:
        if type(engine).__name__ == "GrainLoop":
            engine.showBodies()


pause.__doc__ = f"{pause_of_yade.__doc__}\n\n{pause.__doc__}"


def watch():
    """Replace O.pause by `pause`; a second call changes nothing."""
    Omega.pause = pause
