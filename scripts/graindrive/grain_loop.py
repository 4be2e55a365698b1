"""Moves a scene built for YADE's loop over to GrainLoop, and back."""

import math

from . import engines
from .errors import UsageError

REPLACED = ("ForceResetter", "InsertionSortCollider", "InteractionLoop", "NewtonIntegrator")
LAWS = {
    "Law2_ScGeom_ContactPhys_HertzHistory": "hertzHistory",
    "Law2_ScGeom_ContactPhys_HertzRestitution": "hertzRestitution",
    "Law2_ScGeom_ContactPhys_SpringDashpot": "springDashpot",
}
LAW_ATTRIBUTES = (
    "normalStiffness",
    "tangentialStiffness",
    "normalDamping",
    "tangentialDamping",
    "young",
    "poisson",
    "restitution",
)


def use_grain_loop(periods=None, **settings):
    """Replace YADE's four engines in O.engines by one GrainLoop with the same law, friction and gravity; return it.

    Measures and drives stay, in their order, before it. `periods` are the lengths (x, y) after which the box repeats, 0
    where it does not; by default a periodic scene repeats in x only, as YADE's long cells are meant. Other `settings`
    (precision, threads, syncEvery, ...) go to GrainLoop. Springs of present contacts begin at zero.
    """
    from yade import O

    contacts, newton = find("InteractionLoop"), find("NewtonIntegrator")
    if newton.damping != 0:
        raise UsageError(
            f"GrainLoop has no artificial damping, NewtonIntegrator.damping is {newton.damping:g}; set it to 0"
        )
    if periods is None:
        periods = (O.cell.size[0], 0) if O.periodic else (0, 0)
    made = engines.GrainLoop(
        gravity=newton.gravity,
        friction=friction_of(contacts.physDispatcher.functors[0]),
        periods=(*periods, 0),
        **law_of(contacts.lawDispatcher.functors[0]),
        **settings,
    )
    made_before = [e for e in O.engines if type(e).__name__ in REPLACED]
    O.engines = [e for e in O.engines if type(e).__name__ not in REPLACED] + [made]
    exchanged[made.label or "GrainLoop"] = made_before
    return made


exchanged = {}  # label of a GrainLoop -> the engines that it replaced


def use_yade_loop():
    """Put YADE's own engines back in place of the GrainLoop that `use_grain_loop` made; all bodies are brought up to date."""
    from yade import O

    loop = find("GrainLoop")
    if (loop.label or "GrainLoop") not in exchanged:
        raise UsageError(
            "the GrainLoop in O.engines was not made by use_grain_loop in this session, or was given another label;"
            " put YADE's engines into O.engines yourself"
        )
    loop.sync()
    before = {type(e).__name__: e for e in exchanged.pop(loop.label or "GrainLoop")}
    between = [e for e in O.engines if type(e).__name__ != "GrainLoop"]
    *first, last = [before[name] for name in REPLACED]
    O.engines = [*first, *between, last]


def find(name):
    """Return the engine of O.engines of that class; UsageError if there is none."""
    from yade import O

    for engine in O.engines:
        if type(engine).__name__ == name:
            return engine
    raise UsageError(f"O.engines must hold a {name}; it holds {', '.join(type(e).__name__ for e in O.engines)}")


def law_of(functor):
    """Return GrainLoop's arguments for one of Graindrive's Law2_ functors."""
    name = type(functor).__name__
    if name not in LAWS:
        raise UsageError(f"GrainLoop knows the laws {', '.join(LAWS)}; the scene uses {name}")
    if functor.leverArm != "radius":
        raise UsageError(
            f"GrainLoop's friction acts at the grains' radius; the functor has leverArm='{functor.leverArm}'"
        )
    return dict(law=LAWS[name], **{key: getattr(functor, key) for key in LAW_ATTRIBUTES if hasattr(functor, key)})


def friction_of(functor):
    """Return the friction coefficient of every contact; UsageError where materials would make them differ."""
    from yade import O

    if functor.friction >= 0:
        return functor.friction
    angles = {m.frictionAngle for m in O.materials}
    if len(angles) != 1:
        raise UsageError(
            "GrainLoop has one friction coefficient for all contacts; give it as friction=... of the Ip2_ functor"
        )
    return math.tan(angles.pop())
