"""Replaces YADE's helpers that read interactions or contact forces: under GrainLoop they compute the right answer or refuse.

GrainLoop keeps neither interactions nor their forces, so without this the helpers would return 0 or nan without a warning. On
YADE's own loop, and in scenes without an active GrainLoop, YADE's own functions are called.
"""

import functools
import sys

import numpy as np

from .take_over import ADD_FORCES

REFUSED = {  # module -> what reads interactions, or forces of contacts, by YADE's documentation
    "yade._utils": (
        "bodyNumInteractionsHistogram",
        "bodyStressTensors",
        "createInteraction",
        "fabricTensor",
        "forcesOnCoordPlane",
        "forcesOnPlane",
        "getBodyIdsContacts",
        "getCapillaryStress",
        "getStress",
        "getStressAndTangent",
        "getStressProfile",
        "getStressProfile_contact",
        "interactionAnglesHistogram",
        "intrsOfEachBody",
        "maxOverlapRatio",
        "normalShearStressTensors",
        "numIntrsOfEachBody",
        "setContactFriction",
        "stressTensorOfPeriodicCell",
        "sumFacetNormalForces",
        "sumForces",
        "sumTorques",
        "totalForceInVolume",
    ),
    "yade.utils": ("plotDirections", "plotNumInteractionsHistogram"),
}
EXPORTS = ("exportContactPoints", "exportInteractions")  # methods of yade.export.VTKExporter
WAYS_OUT = {"setContactFriction": "assign loop.friction", "createInteraction": "GrainLoop finds all contacts by itself"}


def live_loop():
    """Return the GrainLoop that moves the present scene; None on YADE's own loop."""
    from yade import O

    return next((e for e in O.engines if type(e).__name__ == "GrainLoop" and not e.dead), None)


def refuse(name):
    """Raise RuntimeError with the function's name and the way out."""
    way_out = WAYS_OUT.get(name, "take loop.contacts() or loop.presentContacts()")
    raise RuntimeError(
        f"{name} needs YADE's interactions or their forces, which GrainLoop does not keep; {way_out},"
        " or go back with grain_loop.use_yade_loop()"
    )


def refusing(name, *_args, **_keys):
    """Replaces a function that cannot work under GrainLoop."""
    refuse(name)


def avg_num_interactions(cutoff=0.0, skipFree=False, considerClumps=False):
    """Return 2 C/N like YADE's avgNumInteractions: contacts at the present positions over the length of O.bodies."""
    from yade import O

    if cutoff or skipFree or considerClumps:
        refuse("avgNumInteractions with cutoff, skipFree or considerClumps")
    return 2 * len(live_loop().presentContacts()["i"]) / len(O.bodies)


def unbalanced_force(useMaxForce=False):
    """Return the mean (or largest) |force + m g| on movable bodies over the mean |force| of contacts, at present positions.

    Like in YADE's unbalancedForce, a clump counts once, with the forces on its members. After the integrator and between
    runs, YADE's number belongs to the positions before the step.
    """
    from yade import O

    contacts = live_loop().presentContacts()
    of_contacts = contacts["normal_force"] + contacts["tangential_force"]  # on j; j < -1 are flat walls
    force = np.zeros((len(O.bodies), 3))
    np.add.at(force, contacts["i"], -of_contacts)
    with_disks = contacts["j"] >= 0
    np.add.at(force, contacts["j"][with_disks], of_contacts[with_disks])
    force += outside_forces()
    on_bodies = net_forces(force)
    if not len(on_bodies) or not len(of_contacts):
        return float("nan")  # as YADE's 0/0
    sizes = np.linalg.norm(on_bodies, axis=1)
    return float((sizes.max() if useMaxForce else sizes.mean()) / np.linalg.norm(of_contacts, axis=1).mean())


def net_forces(force):
    """Return forces and weights of all movable bodies, (n, 3) each, from forces by id; those of members go to their clump."""
    from yade import O

    bodies = [b for b in O.bodies if b is not None]
    for member in bodies:
        if member.isClumpMember:
            force[member.clumpId] += force[member.id]
    gravity = np.array(live_loop().gravity)
    free = [b for b in bodies if b.dynamic and not b.isClumpMember]
    return np.array([force[b.id] + b.state.mass * gravity for b in free]).reshape(-1, 3)


def outside_forces():
    """Return the external forces by id [N], shape (n, 3): those in O.forces, and GrainLoop's loads.

    RuntimeError if an engine adds forces at each step and they are no longer there: GrainLoop empties O.forces in its step.
    """
    from yade import O

    ids = range(len(O.bodies))
    force = np.array([O.forces.f(k) for k in ids]).reshape(-1, 3)
    pushing = [type(e).__name__ for e in O.engines if type(e).__name__ in ADD_FORCES and not e.dead]
    if pushing and np.array_equal(force, permanent_forces(ids)):
        raise RuntimeError(
            f"unbalancedForce needs the forces of {pushing[0]}, which are gone after GrainLoop's step;"
            f" call it in a PyRunner between {pushing[0]} and GrainLoop"
        )
    loads = np.array(live_loop().loads).reshape(-1, 4)  # id, F_x, F_y, F_z
    np.add.at(force, loads[:, 0].astype(int), loads[:, 1:])
    return force


def permanent_forces(ids):
    """Return the forces set by O.forces.setPermF, shape (n, 3); YADE crashes if there are none, so this is checked first."""
    from yade import O

    used = O.forces.getPermForceUsed()
    return np.array([O.forces.permF(k) if used else (0, 0, 0) for k in ids]).reshape(-1, 3)


ANSWERED = {
    "unbalancedForce": ("yade._utils", unbalanced_force),
    "avgNumInteractions": ("yade.utils", avg_num_interactions),
}


def instead(original, answer):
    """Return a function that calls `answer` while GrainLoop moves the scene, `original` otherwise."""

    @functools.wraps(original, assigned=("__name__", "__doc__"), updated=())
    def chosen(*args, **keys):
        return (original if live_loop() is None else answer)(*args, **keys)

    return chosen


def install():
    """Replace YADE's functions in all loaded modules that hold them; once."""
    install_methods()
    answers = {name: (module, functools.partial(refusing, name)) for module in REFUSED for name in REFUSED[module]}
    for name, (module, answer) in {**answers, **ANSWERED}.items():
        original = getattr(sys.modules[module], name, None)  # not every version of YADE has each
        if original is None or hasattr(original, "__wrapped__"):
            continue
        chosen = instead(original, answer)
        for holder in [m for m in list(sys.modules.values()) if getattr(m, "__dict__", {}).get(name) is original]:
            setattr(holder, name, chosen)


def install_methods():
    """Make exporters of interactions, and post2d.data(intr=True), refuse too; once."""
    from yade import export, post2d, utils  # noqa: F401

    for name in EXPORTS:
        original = getattr(export.VTKExporter, name, None)
        if original is not None and not hasattr(original, "__wrapped__"):
            setattr(export.VTKExporter, name, instead(original, functools.partial(refusing, name)))
    if hasattr(post2d.data, "__wrapped__"):
        return
    original = post2d.data

    def data(extractor, flattener, intr=False, *args, **keys):
        if intr:
            refuse("post2d.data with intr=True")
        return original(extractor, flattener, intr, *args, **keys)

    post2d.data = instead(original, data)
