"""A scene on GrainLoop or on YADE's loop, run in portions that the benchmark asks for on standard input."""

import json
import sys
import time

import numpy as np

from ..lazily import engines
from . import features, layout
from .layout import DRIVEN, FREE, WALL

DRUM_MASS = 1e9  # wall and intruder of a drum are practically infinitely heavy


def bodies(a_scene):
    """Put the scene's grains into YADE: walls frozen, or one turning clump where the scene is a drum."""
    from yade import O, utils
    from yade.minieigenHP import Vector3

    O.reset()
    make_periodic(a_scene)
    turning, moving_freely = [], "" if layout.in_space(a_scene) else "zXY"
    tables = layout.places(a_scene), layout.velocities(a_scene), layout.spins(a_scene), *layout.masses(a_scene)
    columns = [table.tolist() for table in (*tables, a_scene["r"], a_scene["kind"])]
    for place, velocity, spin, mass, inertia, r, kind in zip(*columns):
        body = utils.sphere(place, r, color=(1, 1, 1))
        body.state.mass, body.state.inertia = mass, Vector3(1, 1, 1) * inertia
        body.state.blockedDOFs = moving_freely if kind == FREE else "xyzXYZ"
        body.state.vel, body.state.angVel = Vector3(*velocity), Vector3(*spin)
        if kind == WALL and is_drum(a_scene):
            turning.append(body)
        else:
            O.bodies.append(body)
    if turning:
        drum, _ = O.bodies.appendClumped(turning)
        state = O.bodies[drum].state
        state.mass, state.inertia = DRUM_MASS, Vector3(1, 1, 1) * DRUM_MASS
        state.blockedDOFs, state.angVel = "xyzXYZ", Vector3(0, 0, float(a_scene["drive"][2]))
    O.dt = float(a_scene["dt"])


def make_periodic(a_scene):
    """Make YADE's cell periodic as the scene; along other axes it is so long that no body reaches its image."""
    from yade import O

    if any(layout.periods(a_scene)):
        O.periodic = True
        far = 4 * (np.abs(layout.places(a_scene)[:, 1:]).max() + 10 * a_scene["r"].max())
        O.cell.setBox(*(period or float(far) for period in layout.periods(a_scene)))


def is_drum(a_scene):
    """Return True if the wall turns as one body."""
    return not any(layout.periods(a_scene)) and bool(a_scene["drive"][2])


def law_settings(a_scene):
    """Return the law's constants under YADE's names."""
    return dict(zip(engines.contact_laws()[str(a_scene["law"])], map(float, a_scene["constants"])))


def grain_loop(a_scene, **settings):
    """Put GrainLoop into O.engines and return it."""
    from yade import O

    loop = engines.GrainLoop(
        dimensions=3 if layout.in_space(a_scene) else 2,
        law=str(a_scene["law"]),
        friction=float(a_scene["friction"]),
        gravity=layout.gravity(a_scene),
        periods=layout.periods(a_scene),
        **law_settings(a_scene),
        **settings,
    )
    O.engines = [loop]
    return loop


def with_features(a_scene, settings):
    """Put GrainLoop into O.engines with `settings` of its own, and what else `benchmark.features` names; return it.

    binned: forces by angle on the driven disk at every step; averaged: fields around it every so many steps; walls: "near",
    half a diameter beyond the outer grains, or "far".
    """
    from yade import O

    settings = dict(settings)
    binned, averaged, walls = (settings.pop(key, None) for key in ("binned", "averaged", "walls"))
    loop = grain_loop(a_scene, **settings)
    measures = []
    if binned:
        measures.append(engines.ContactForceBinner(body=driven(a_scene)))
    if averaged:
        fields = dict(low=(-5, -5, 0), high=(5, 5, 0), spacing=0.5, width=1.0, kernel="gaussian")
        measures.append(engines.FieldAverager(body=driven(a_scene), every=averaged, **fields))
    O.engines = [*measures, loop]
    if walls:
        for side, position in features.walls_of(a_scene, away=features.FAR if walls == "far" else 0.0).items():
            loop.setWall(side, position=position)
    return loop


def driven(a_scene):
    """Return the id of the driven disk: every disk is a body, in the scene's order."""
    return int(np.flatnonzero(a_scene["kind"] == DRIVEN)[0])


def yade_loop(a_scene):
    """Put YADE's own loop with the same law into O.engines."""
    from yade import O, wrapper

    functor = {law: name for name, law in engines.law_functors().items()}[str(a_scene["law"])]
    law = getattr(engines, functor)(**law_settings(a_scene))
    phys = engines.Ip2_FrictMat_FrictMat_ContactPhys(friction=float(a_scene["friction"]))
    skin = 0.1 * 2 * float(np.median(a_scene["r"]))
    O.engines = [
        wrapper.ForceResetter(),
        wrapper.InsertionSortCollider([wrapper.Bo1_Sphere_Aabb()], verletDist=skin),
        wrapper.InteractionLoop([wrapper.Ig2_Sphere_Sphere_ScGeom()], [phys], [law]),
        wrapper.NewtonIntegrator(damping=0, gravity=layout.gravity(a_scene)),
    ]


def move_on(a_scene, until, dt=None, **settings):
    """Run a scene on GrainLoop, with other `settings` of it, until `until(loop, steps)`; return it as it then is."""
    from yade import O

    bodies(a_scene)
    loop = grain_loop(a_scene, **settings)
    O.dt = dt or O.dt
    steps = 0
    while not until(loop, steps):
        O.run(1000, True)
        steps += 1000
    moved = layout.with_motion(a_scene, *(in_order(a_scene, t) for t in (loop.positions, loop.velocities, loop.spins)))
    if not layout.in_space(a_scene) and a_scene["drive"][0]:
        moved["vx"][a_scene["kind"] == DRIVEN] = a_scene["drive"][0]
    return moved


def halt():
    """Set all velocities of a scene to zero; GrainLoop takes this up in the next step, and keeps its springs."""
    from yade import O
    from yade.minieigenHP import Vector3

    for body in O.bodies:
        body.state.vel, body.state.angVel, body.state.angMom = Vector3.Zero, Vector3.Zero, Vector3.Zero


def in_order(a_scene, table):
    """Return a table of the loop's in the order of the scene: a drum's clump comes last among the bodies."""
    if not is_drum(a_scene):
        return table
    ordered = np.empty_like(table)
    ordered[np.argsort(a_scene["kind"] == WALL, kind="stable")] = table
    return ordered


def kinetic_energy():
    """Return the kinetic energy of the free grains in O.bodies, velocities half a step behind [J]."""
    from yade import O

    table = engines.body_table(O._sceneObj)
    states = [O.bodies[int(i)].state for i in table["id"]]
    free = np.array([state.blockedDOFs != "xyzXYZ" for state in states])
    inertia = np.array([state.inertia[2] for state in states])
    spinning = inertia * (table["spin"] ** 2).sum(axis=1)
    energy = (table["mass"] * (table["velocity"] ** 2).sum(axis=1) + spinning) / 2
    return float(energy[free].sum())


def serve(path, which, settings):
    """Answer `run N` on standard input by {wall, cpu, energy, ...}, until the input ends."""
    from yade import O

    with np.load(path) as file:
        a_scene = {name: file[name] for name in file.files}
    bodies(a_scene)
    begins_on_step = settings.pop("onStep", True)
    loop = with_features(a_scene, settings) if which == "grain" else None
    if loop is None:
        yade_loop(a_scene)
    elif begins_on_step:
        loop.beginOnStep()
    for line in sys.stdin:
        steps = int(line)
        wall, cpu = time.perf_counter(), time.process_time()
        O.run(steps, True)
        wall, cpu = time.perf_counter() - wall, time.process_time() - cpu
        answer = dict(wall=wall, cpu=cpu, half_step=kinetic_energy())
        if loop is not None:
            answer.update(
                energy=loop.kineticEnergyOnStep(), processor=loop.processor, contacts=len(loop.contacts()["i"])
            )
        print(json.dumps(answer), flush=True)


if __name__ == "__main__":
    serve(sys.argv[1], sys.argv[2], json.loads(sys.argv[3]))
