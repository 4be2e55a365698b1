"""What YADE's own engines can carry and GrainLoop cannot: one list, asked before a scene is taken over.

Bodies, cell and the other engines are looked at by GrainLoop itself (`GrainLoop.requireScene`), whoever made it.
"""

from collections.abc import Callable
from dataclasses import dataclass

from .errors import UsageError

REPLACED = ("ForceResetter", "InsertionSortCollider", "InteractionLoop", "NewtonIntegrator")


@dataclass(frozen=True)
class Loop:
    """YADE's four engines as they stand in O.engines."""

    resetter: object
    collider: object
    contacts: object
    newton: object

    def __iter__(self):
        return iter((self.resetter, self.collider, self.contacts, self.newton))


@dataclass(frozen=True)
class Rule:
    """One thing that YADE heeds and GrainLoop does not: `obstacle(loop)` says in words what stands in the way, or ""."""

    name: str
    obstacle: Callable


def dead(loop):
    """A dead engine does not act: disks would not meet, or would not move."""
    names = [type(e).__name__ for e in loop if e.dead]
    return f"{names[0]}.dead is True, so YADE's loop goes without it; set it to False" if names else ""


def newton_mask(loop):
    """NewtonIntegrator moves the bodies with a bit of its mask."""
    mask, (outside, groups) = loop.newton.mask, first_body(
        lambda b: loop.newton.mask > 0 and not b.groupMask & loop.newton.mask
    )
    return outside and f"NewtonIntegrator.mask={mask} leaves out body {outside} (its mask is {groups}); set it to -1"


def self_interaction(loop):
    """Bodies that share a bit of avoidSelfInteractionMask do not meet."""
    mask = loop.collider.avoidSelfInteractionMask
    first, groups = first_body(lambda b: not b.isClump and b.groupMask & mask)
    return (
        first and f"avoidSelfInteractionMask={mask} keeps body {first} (its mask is {groups}) from others; set it to 0"
    )


def distant_contacts(loop):
    """An interactionDetectionFactor other than 1 makes contacts at a distance."""
    factors = [getattr(f, "interactionDetectionFactor", 1) for f in loop.contacts.geomDispatcher.functors]
    return "" if set(factors) <= {1} else f"Ig2's interactionDetectionFactor is {max(factors):g}; set it to 1"


def geometry(loop):
    """Contacts of disks are those of Ig2_Sphere_Sphere_ScGeom."""
    names = [type(f).__name__ for f in loop.contacts.geomDispatcher.functors]
    known = "Ig2_Sphere_Sphere_ScGeom"
    return "" if known in names else f"InteractionLoop needs {known}, it has {', '.join(names) or 'no Ig2_ functor'}"


def one_functor_each(loop):
    """Which of several functors acts depends on the pair of materials."""
    for kind, dispatcher in (("Ip2_", loop.contacts.physDispatcher), ("Law2_", loop.contacts.lawDispatcher)):
        names = [type(f).__name__ for f in dispatcher.functors]
        if len(names) != 1:
            return f"InteractionLoop must have one {kind} functor, it has {', '.join(names) or 'none'}; keep one"
    return ""


def callbacks(loop):
    """IntrCallbacks are called for each of YADE's interactions."""
    names = [type(c).__name__ for c in loop.contacts.callbacks]
    return f"InteractionLoop.callbacks holds {names[0]}, which needs YADE's interactions; remove it" if names else ""


def energy_of_yade(_loop):
    """O.energy is filled by YADE's own engines."""
    from yade import O

    return (
        "O.trackEnergy is True, and YADE's engines fill O.energy; use GrainLoop's trackEnergy" if O.trackEnergy else ""
    )


def recorded_contacts(_loop):
    """VTKRecorder writes YADE's interactions and forces if asked for them."""
    from yade import O

    asked = {r for e in O.engines if type(e).__name__ == "VTKRecorder" for r in e.recorders} & {"intr", "force", "all"}
    return asked and f"VTKRecorder is to record {sorted(asked)[0]!r}, which needs YADE's interactions; leave it out"


RULES = [
    Rule(rule.__name__, rule)
    for rule in (
        dead,
        newton_mask,
        self_interaction,
        geometry,
        distant_contacts,
        one_functor_each,
        callbacks,
        energy_of_yade,
        recorded_contacts,
    )
]


def first_body(wanted):
    """Return (id, mask) of the first body for which `wanted(body)` holds, as words; ("", "") if there is none."""
    from yade import O

    return next(((str(b.id), str(b.groupMask)) for b in O.bodies if wanted(b)), ("", ""))


def yades_loop():
    """Return the `Loop` that stands in O.engines; UsageError unless each of its engines is there once."""
    from yade import O

    found = []
    for name in REPLACED:
        here = [engine for engine in O.engines if type(engine).__name__ == name]
        if len(here) != 1:
            names = ", ".join(type(e).__name__ for e in O.engines) or "nothing"
            raise UsageError(f"O.engines must hold {'one' if here else 'a'} {name}; it holds {names}")
        found += here
    return Loop(*found)


def require(loop):
    """Raise UsageError with the first obstacle, in words."""
    for rule in RULES:
        obstacle = rule.obstacle(loop)
        if obstacle:
            raise UsageError(f"GrainLoop cannot take this scene over: {obstacle}, or stay on YADE's loop")
