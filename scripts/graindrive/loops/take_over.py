"""Lists features of YADE's engines that GrainLoop lacks; the rules are checked before GrainLoop takes a scene over.

GrainLoop itself checks bodies, cell and the other engines (`GrainLoop.requireScene`).
"""

import sys
from collections.abc import Callable
from dataclasses import dataclass

from ..base.errors import UsageError

REPLACED = ("ForceResetter", "InsertionSortCollider", "InteractionLoop", "NewtonIntegrator")
ADD_FORCES = (  # YADE's engines that act by adding forces, as listed in engines/seam/onlookers.cpp
    "AxialGravityEngine",
    "CentralConstantAccelerationEngine",
    "DragEngine",
    "ForceEngine",
    "GravityEngine",
    "HarmonicForceEngine",
    "HdapsGravityEngine",
    "InterpolatingDirectedForceEngine",
    "LinearDragEngine",
    "RadialForceEngine",
    "TorqueEngine",
)
DRIVES_AND_MEASURES = (
    "ContactForceBinner",
    "DrumDrive",
    "FieldAverager",
    "OscillationDrive",
    "ShearDrive",
    "SpinTranslateDrive",
)


@dataclass(frozen=True)
class Loop:
    """YADE's four engines of O.engines, and all engines in their order."""

    resetter: object
    collider: object
    contacts: object
    newton: object
    order: tuple

    def __iter__(self):
        return iter((self.resetter, self.collider, self.contacts, self.newton))

    def place(self, engine):
        """Return the position of one of the four engines in the order, from 0."""
        return self.order.index(engine)

    def with_grain_loop(self, made):
        """Return the engines with a GrainLoop in NewtonIntegrator's place; engines after NewtonIntegrator stay after it."""
        kept = [e for e in self.order if type(e).__name__ not in REPLACED or e == self.newton]
        return [made if e == self.newton else e for e in kept]

    def put_back(self, engines):
        """Return O.engines with the four again in place of its GrainLoop.

        The order is the original one if the other engines are the same; else engines before GrainLoop stand between contacts
        and integrator, engines after it after the integrator. Other engines are identified by class and label, because a
        scene that was saved and loaded holds new objects.
        """
        names = [e if isinstance(e, str) else (type(e).__name__, e.label) for e in self.with_grain_loop("GrainLoop")]
        now = ["GrainLoop" if type(e).__name__ == "GrainLoop" else (type(e).__name__, e.label) for e in engines]
        if now == names:
            others = iter([e for e in engines if type(e).__name__ != "GrainLoop"])
            return [e if type(e).__name__ in REPLACED else next(others) for e in self.order]
        at = now.index("GrainLoop")
        return [self.resetter, self.collider, self.contacts, *engines[:at], self.newton, *engines[at + 1 :]]


@dataclass(frozen=True)
class Rule:
    """A feature of YADE that GrainLoop lacks: `obstacle(loop)` returns a message if the scene uses it, else ""."""

    name: str
    obstacle: Callable


def dead(loop):
    """A dead engine does not act: disks would have no contacts, or would not move."""
    names = [type(e).__name__ for e in loop if e.dead]
    return f"{names[0]}.dead is True, so YADE's loop goes without it; set it to False" if names else ""


def newton_mask(loop):
    """NewtonIntegrator moves only bodies that share a bit with its mask."""
    mask, (outside, groups) = loop.newton.mask, first_body(
        lambda b: loop.newton.mask > 0 and not b.groupMask & loop.newton.mask
    )
    return outside and f"NewtonIntegrator.mask={mask} leaves out body {outside} (its mask is {groups}); set it to -1"


def self_interaction(loop):
    """Bodies that share a bit of avoidSelfInteractionMask have no contacts with each other."""
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
    """Ig2_Sphere_Sphere_ScGeom must compute the contacts of disks."""
    names = [type(f).__name__ for f in loop.contacts.geomDispatcher.functors]
    known = "Ig2_Sphere_Sphere_ScGeom"
    return "" if known in names else f"InteractionLoop needs {known}, it has {', '.join(names) or 'no Ig2_ functor'}"


def one_functor_each(loop):
    """With several functors, the pair of materials decides which one acts."""
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


def order_of_the_four(loop):
    """GrainLoop finds contacts and moves disks in one step; in another order of the engines forces act a step later."""
    resetter, collider, contacts, newton = (loop.place(engine) for engine in loop)
    if max(resetter, collider) < contacts < newton:
        return ""
    names = ", ".join(type(e).__name__ for e in loop.order if type(e).__name__ in REPLACED)
    return f"the order of its engines is {names}; it must be {', '.join(REPLACED)}"


def forces_that_are_erased(loop):
    """ForceResetter erases forces added before it or after the integrator, so on YADE's loop they have no effect."""
    first, last = loop.place(loop.resetter), loop.place(loop.newton)
    for at, engine in enumerate(loop.order):
        name = type(engine).__name__
        if name in ADD_FORCES and not first < at < last:
            where = "before ForceResetter" if at < first else "behind NewtonIntegrator"
            return (
                f"{name} stands {where}, so that ForceResetter erases its forces before they act;"
                " put it between InteractionLoop and NewtonIntegrator, or remove it"
            )
    return ""


def misplaced_drives_and_measures(loop):
    """Elsewhere they would see contacts of another step, or impose a velocity too late."""
    first, last = loop.place(loop.contacts), loop.place(loop.newton)
    for at, engine in enumerate(loop.order):
        name = type(engine).__name__
        if name in DRIVES_AND_MEASURES and not first < at < last:
            where = "before InteractionLoop" if at < first else "behind NewtonIntegrator"
            return f"{name} stands {where}; put it between InteractionLoop and NewtonIntegrator"
    return ""


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
        order_of_the_four,
        forces_that_are_erased,
        misplaced_drives_and_measures,
    )
]


def first_body(wanted):
    """Return (id, mask) of the first body for which `wanted(body)` is true, as text; ("", "") if there is none."""
    from yade import O

    return next(((str(b.id), str(b.groupMask)) for b in O.bodies if wanted(b)), ("", ""))


def yades_loop():
    """Return the `Loop` in O.engines; UsageError unless each of its engines is there exactly once."""
    from yade import O

    if any(type(engine).__name__ == "GrainLoop" for engine in O.engines):
        raise UsageError("O.engines holds a GrainLoop already; change its settings, or use_yade_loop() first")
    found = []
    for name in REPLACED:
        here = [engine for engine in O.engines if type(engine).__name__ == name]
        if len(here) != 1:
            names = ", ".join(type(e).__name__ for e in O.engines) or "nothing"
            raise UsageError(f"O.engines must hold {'one' if here else 'a'} {name}; it holds {names}")
        found += here
    return Loop(*found, order=tuple(O.engines))


def require(loop, rules=tuple(RULES)):
    """Raise UsageError with the message of the first rule that finds an obstacle."""
    for rule in rules:
        obstacle = rule.obstacle(loop)
        if obstacle:
            raise UsageError(f"GrainLoop cannot take this scene over: {obstacle}, or use YADE's loop")


def warn_of_runners():
    """Warn at take-over if there is a PyRunner, which may read data that GrainLoop does not keep."""
    from yade import O

    if any(type(engine).__name__ == "PyRunner" for engine in O.engines):
        print(
            "graindrive: O.engines holds a PyRunner: under GrainLoop O.interactions is empty, contacts are in"
            " loop.contacts(), and O.forces holds only external forces",
            file=sys.stderr,
        )
