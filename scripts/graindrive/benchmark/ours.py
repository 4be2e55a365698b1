"""A scene on GrainLoop or on YADE's loop, run in portions that the benchmark asks for on standard input."""

import json
import math
import sys
import time

import numpy as np

from .. import engines
from .scenes import DRIVEN, FREE, WALL

DRUM_MASS = 1e9  # wall and intruder of a drum are as good as infinitely heavy


def bodies(a_scene):
    """Put the scene's disks into YADE: walls frozen, or one turning clump where the scene is a drum."""
    from yade import O, utils
    from yade.minieigenHP import Vector3

    O.reset()
    if a_scene["period"] > 0:
        O.periodic = True
        height = 4 * (np.abs(a_scene["y"]).max() + 10 * a_scene["r"].max())
        O.cell.setBox(float(a_scene["period"]), float(height), float(height))
    turning = []
    for x, y, r, vx, vy, spin, kind in zip(
        *(a_scene[key].tolist() for key in ("x", "y", "r", "vx", "vy", "spin", "kind"))
    ):
        body = utils.sphere((x, y, 0), r, color=(1, 1, 1))
        mass = float(a_scene["density"]) * math.pi * r**2
        body.state.mass, body.state.inertia = mass, Vector3(1, 1, 1) * (mass * r**2 / 2)
        body.state.blockedDOFs = "zXY" if kind == FREE else "xyzXYZ"
        body.state.vel, body.state.angVel = Vector3(vx, vy, 0), Vector3(0, 0, spin)
        if kind == WALL and a_scene["drive"][2] and a_scene["period"] == 0:
            turning.append(body)
        else:
            O.bodies.append(body)
    if turning:
        drum, _ = O.bodies.appendClumped(turning)
        state = O.bodies[drum].state
        state.mass, state.inertia = DRUM_MASS, Vector3(1, 1, 1) * DRUM_MASS
        state.blockedDOFs, state.angVel = "xyzXYZ", Vector3(0, 0, float(a_scene["drive"][2]))
    O.dt = float(a_scene["dt"])


def law_settings(a_scene):
    """Return the law's constants under YADE's names."""
    return dict(zip(engines.contact_laws()[str(a_scene["law"])], map(float, a_scene["constants"])))


def grain_loop(a_scene, **settings):
    """Put GrainLoop into O.engines and return it."""
    from yade import O

    loop = engines.GrainLoop(
        law=str(a_scene["law"]),
        friction=float(a_scene["friction"]),
        gravity=(0, -float(a_scene["gravity"]), 0),
        periods=(float(a_scene["period"]), 0, 0),
        **law_settings(a_scene),
        **settings,
    )
    O.engines = [loop]
    return loop


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
        wrapper.NewtonIntegrator(damping=0, gravity=(0, -float(a_scene["gravity"]), 0)),
    ]


def move_on(a_scene, until, dt=None):
    """Run a scene on GrainLoop until `until(loop, steps)`; return it as it then is."""
    from yade import O

    bodies(a_scene)
    loop = grain_loop(a_scene)
    O.dt = dt or O.dt
    steps = 0
    while not until(loop, steps):
        O.run(1000, True)
        steps += 1000
    positions, velocities, order = loop.positions, loop.velocities, np.argsort(a_scene["kind"] == WALL, kind="stable")
    rows = order if a_scene["period"] == 0 else np.arange(len(a_scene["x"]))  # a drum's clump comes last
    moved = {key: np.empty(len(a_scene["x"])) for key in ("x", "y", "vx", "vy", "spin")}
    moved["x"][rows], moved["y"][rows] = positions.T
    moved["vx"][rows], moved["vy"][rows], moved["spin"][rows] = *velocities.T, loop.spins
    if a_scene["drive"][0]:
        moved["vx"][a_scene["kind"] == DRIVEN] = a_scene["drive"][0]
    return dict(a_scene, **moved)


def kinetic_energy():
    """Return the kinetic energy of the free disks in O.bodies, velocities half a step behind [J]."""
    from yade import O

    table = engines.body_table(O._sceneObj)
    free = np.array([O.bodies[int(i)].state.blockedDOFs == "zXY" for i in table["id"]])
    spinning = table["radius"] ** 2 / 2 * table["spin"][:, 2] ** 2
    energy = table["mass"] / 2 * ((table["velocity"] ** 2).sum(axis=1) + spinning)
    return float(energy[free].sum())


def serve(path, which, settings):
    """Answer `run N` on standard input by {wall, cpu, energy, ...}, until the input ends."""
    from yade import O

    with np.load(path) as file:
        a_scene = {name: file[name] for name in file.files}
    bodies(a_scene)
    begins_on_step, binned = settings.pop("onStep", True), settings.pop("binned", False)
    loop = grain_loop(a_scene, **settings) if which == "grain" else None
    if loop is None:
        yade_loop(a_scene)
    elif begins_on_step:
        loop.beginOnStep()
    if binned:
        driven = int(np.flatnonzero(a_scene["kind"] == DRIVEN)[0])  # every disk is a body, in the scene's order
        O.engines = [engines.ContactForceBinner(body=driven), loop]
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
