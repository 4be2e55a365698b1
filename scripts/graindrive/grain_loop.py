"""Moves a scene built for YADE's loop over to GrainLoop, and back."""

import math

from . import engines, take_over
from .errors import UsageError

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

exchanged = {}  # label of a GrainLoop -> the `take_over.Loop` that it replaced


def use_grain_loop(periods=None, **settings):
    """Replace YADE's four engines in O.engines by one GrainLoop with the same law, friction and gravity; return it.

    Measures, drives and other engines stay, in their order, before it. `periods` are the lengths (x, y) after which the
    box repeats, 0 where it does not; by default those of O.cell. A cell that is long on purpose runs faster with 0 there.
    Other `settings` (precision, threads, syncEvery, ...) go to GrainLoop. Tangential springs of present contacts go along.
    Raises UsageError for what GrainLoop does not do (`take_over.RULES`), ValueError for bodies and cells that it cannot
    move, RuntimeError for engines that it does not know; O.engines then stays as it was.
    """
    from yade import O

    loop = take_over.yades_loop()
    take_over.require(loop)
    if loop.newton.damping != 0:
        raise UsageError(
            f"GrainLoop has no artificial damping, NewtonIntegrator.damping is {loop.newton.damping:g}; set it to 0"
        )
    if periods is None:
        periods = (O.cell.size[0], O.cell.size[1]) if O.periodic else (0, 0)
    made = engines.GrainLoop(
        gravity=loop.newton.gravity,
        friction=friction_of(loop.contacts.physDispatcher.functors[0]),
        periods=(*periods, 0),
        springs=present_springs(),
        **law_of(loop.contacts.lawDispatcher.functors[0]),
        **settings,
    )
    before = O.engines
    O.engines = [e for e in before if type(e).__name__ not in take_over.REPLACED] + [made]
    try:
        made.requireScene()
    except Exception:
        O.engines = before
        raise
    exchanged[made.label or "GrainLoop"] = loop
    return made


def use_yade_loop():
    """Put YADE's own engines back in place of the GrainLoop that `use_grain_loop` made; all bodies are brought up to date.

    Contacts are found anew and get the tangential springs that they have now; gravity, friction and constants of the law
    go along if they were changed.
    """
    from yade import O

    loop = find("GrainLoop")
    if (loop.label or "GrainLoop") not in exchanged:
        raise UsageError(
            "the GrainLoop in O.engines was not made by use_grain_loop in this session, or was given another label;"
            " put YADE's engines into O.engines yourself"
        )
    if loop.walls or loop.loads:
        raise UsageError(
            "YADE's loop has no flat walls and loads of GrainLoop's; remove them (removeWall, setLoad) first"
        )
    loop.sync()
    before = exchanged.pop(loop.label or "GrainLoop")
    hand_settings_back(loop, before)
    between = [e for e in O.engines if type(e).__name__ != "GrainLoop"]
    O.engines = [before.resetter, before.collider, before.contacts, *between, before.newton]
    make_contacts_anew(before, loop.springs)


def present_springs():
    """Return id, id, tangential spring of the contacts in O.interactions, one list of numbers, as GrainLoop.springs is."""
    from yade import O

    springs = []
    for contact in O.interactions:
        if contact.isReal and (spring := spring_of(contact.phys, along(contact))) != 0:
            springs += [contact.id1, contact.id2, spring]
    return springs


def along(contact):
    """Return the tangent z x n of a contact, as (x, y)."""
    normal = contact.geom.normal
    return -normal[1], normal[0]


def spring_of(phys, tangent):
    """Return the tangential spring of body 1 against body 2 along the tangent [m]."""
    if hasattr(phys, "slip"):
        return phys.slip[0] * tangent[0] + phys.slip[1] * tangent[1]
    return (phys.shearForce[0] * tangent[0] + phys.shearForce[1] * tangent[1]) / phys.ks


def stretch(phys, tangent, spring):
    """Give a contact of YADE's this tangential spring [m]."""
    from yade.minieigenHP import Vector3

    if hasattr(phys, "slip"):
        phys.slip = Vector3(*tangent, 0) * spring
    else:
        phys.shearForce = Vector3(*tangent, 0) * (spring * phys.ks)


def hand_settings_back(loop, before):
    """Give YADE's engines gravity, friction and law's constants as GrainLoop has them now."""
    before.newton.gravity = loop.gravity
    ip2, law2 = before.contacts.physDispatcher.functors[0], before.contacts.lawDispatcher.functors[0]
    if getattr(ip2, "friction", -1) >= 0:
        ip2.friction = loop.friction
    for key in LAW_ATTRIBUTES:
        if hasattr(law2, key):
            setattr(law2, key, getattr(loop, key))


def make_contacts_anew(loop, springs):
    """Have YADE find all contacts of the present positions, in a step that takes no time, and give them these springs."""
    from yade import O

    engines_of_scene, dt, clock = O.engines, O.dt, (O.iter, O.time)
    O.interactions.clear()
    loop.collider()  # at once: in a step it may wait until something has moved
    O.engines, O.dt = list(loop), 0
    O.run(1, True)  # in the loop's own thread: forces of engines that are called by hand are not cleared
    O.engines, O.dt = engines_of_scene, dt
    engines.set_clock(O._sceneObj, *clock)
    stretched = {frozenset(map(int, springs[k : k + 2])): springs[k + 2] for k in range(0, len(springs), 3)}
    for contact in O.interactions:
        if contact.isReal:
            spring = stretched.get(frozenset((contact.id1, contact.id2)), 0.0)
            stretch(contact.phys, along(contact), spring)


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
