"""Makes O.run, O.step and O.wait raise the errors of solids on YADE's own loop.

YADE calls functors in parallel loops, where an exception would end the process. So rules are checked before the run if
possible; an error that a functor finds stops the run, and is raised here.
"""

import functools

from yade.wrapper import Omega

from .._engines import check_solids, solids_outgrow_cell, take_complaint


LARGEST_SKIN = 0.9  # smallest radii


def raise_complaint():
    """Raise RuntimeError with the message of a functor, if there is one."""
    complaint = take_complaint()
    if complaint:
        raise RuntimeError(complaint)


def check(omega):
    """Raise ValueError for solids of the present scene that YADE's collider cannot handle."""
    check_solids(omega._sceneObj)
    if not solids_outgrow_cell(omega._sceneObj):
        return
    for engine in omega.engines:
        if type(engine).__name__ != "InsertionSortCollider":
            continue
        if not engine.allowBiggerThanPeriod:
            raise ValueError(
                "a Solid without end in a periodic cell needs InsertionSortCollider.allowBiggerThanPeriod=True, got False; set it"
            )
        check_skin(omega, engine.verletDist)


def check_skin(omega, skin):
    """Raise ValueError if the collider enlarges the boxes of endless solids beyond two periods (see Bo1_Solid_Aabb)."""
    radii = [body.shape.radius for body in omega.bodies if type(body.shape).__name__ == "Sphere"]
    smallest = min(radii, default=0)
    most = LARGEST_SKIN * smallest
    if radii and (skin if skin >= 0 else -skin * smallest) > most:
        raise ValueError(
            "with a Solid without end in a periodic cell InsertionSortCollider.verletDist must be at most"
            f" {LARGEST_SKIN} smallest radii, {most:g}, or -{LARGEST_SKIN}, got {skin:g}; lower it"
        )


def checked(of_yade, starts):
    """Wrap a method of O: raise functors' errors after the call; if it `starts` a run, check the scene before it."""

    @functools.wraps(of_yade)
    def method(omega, *args, **keys):
        if starts:
            check(omega)
        result = of_yade(omega, *args, **keys)
        raise_complaint()
        return result

    method.__doc__ = of_yade.__doc__
    return method


def watch():
    """Replace O.run, O.step and O.wait by checked methods; a second call changes nothing."""
    if hasattr(Omega.run, "__wrapped__"):
        return
    Omega.run, Omega.step = checked(Omega.run, True), checked(Omega.step, True)
    Omega.wait = checked(Omega.wait, False)
