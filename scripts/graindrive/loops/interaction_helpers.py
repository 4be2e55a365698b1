"""YADE's helpers that read interactions or contact forces: under GrainLoop, which keeps neither, they answer truly or refuse.

Without this they would give 0 or nan in silence. On YADE's own loop, and in scenes without a living GrainLoop, YADE's own
functions answer.
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
    """What stands for a function that cannot answer."""
    refuse(name)


def avg_num_interactions(cutoff=0.0, skipFree=False, considerClumps=False):
    """Return 2 C/N as YADE's avgNumInteractions: contacts at the present positions over the length of O.bodies."""
    from yade import O

    if cutoff or skipFree or considerClumps:
        refuse("avgNumInteractions with cutoff, skipFree or considerClumps")
    return 2 * len(live_loop().presentContacts()["i"]) / len(O.bodies)


def unbalanced_force(useMaxForce=False):
    """Return the mean (or largest) |force + m g| on what can move over the mean |force| of contacts, at the present positions.

    As YADE's unbalancedForce: a clump counts once, with the forces on its members. YADE's number behind the integrator and
    between runs is that of the positions before the step.
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
    """Return the forces and weights on all that can move, from forces by id, both of shape (n, 3); members go to their clump."""
    from yade import O

    bodies = [b for b in O.bodies if b is not None]
    for member in bodies:
        if member.isClumpMember:
            force[member.clumpId] += force[member.id]
    gravity = np.array(live_loop().gravity)
    free = [b for b in bodies if b.dynamic and not b.isClumpMember]
    return np.array([force[b.id] + b.state.mass * gravity for b in free]).reshape(-1, 3)


def outside_forces():
    """Return the forces from outside by id [N], shape (n, 3): those in O.forces, and GrainLoop's loads.

    RuntimeError where an engine adds forces at each step and they are gone by now: GrainLoop empties O.forces in its step.
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
    """Return what O.forces.setPermF gave, shape (n, 3); YADE crashes if asked where nobody gave any."""
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
    """Put these functions wherever a loaded module holds YADE's own under its name; once."""
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
    """Let exporters of interactions, and post2d.data(intr=True), refuse too; once."""
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
