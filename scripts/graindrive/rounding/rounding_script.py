"""A scene of elastic disks in one build of YADE with any number type; reads scene.json, prints one line per sample.

This is a plain YADE script. It is copied into a separate folder and run there (`number_types.run`), because the builds with long
numbers cannot load Graindrive's engines. In yade-double the scene's `loop`, "double" or "single", selects GrainLoop in that
precision. YADE must hold all numbers of the scene to the last bit; otherwise the script ends.
"""

import decimal
import json
import os
import shutil
import sys

import mpmath

mpmath.mp.dps = 170  # more than any build of YADE has

with open("scene.json") as file:
    SCENE = json.load(file)
if SCENE["loop"] != "yade":
    from graindrive.loops import grain_loop
from yade import O, utils  # noqa: E402
from yade.minieigenHP import Vector3  # noqa: E402
from yade.wrapper import (  # noqa: E402
    Bo1_Sphere_Aabb,
    ForceResetter,
    FrictMat,
    Ig2_Sphere_Sphere_ScGeom,
    InsertionSortCollider,
    InteractionLoop,
    Ip2_FrictMat_FrictMat_FrictPhys,
    Law2_ScGeom_FrictPhys_CundallStrack,
    NewtonIntegrator,
    PyRunner,
)

FOLDER = os.path.dirname(O.tmpFilename())  # YADE's own, which a killed YADE leaves behind
PARENT = os.getppid()
MOVING = []
TYPE = float if isinstance(O.dt, float) else mpmath.mpf  # the builds with long numbers round a float to 17 digits


def given(number):
    """Return a double, or a list of doubles, in the form that YADE stores to the last bit."""
    return [TYPE(n) for n in number] if isinstance(number, list) else TYPE(number)


def same(got, asked):
    """End the script unless YADE holds the number that it was given."""
    if mpmath.mpf(got) != mpmath.mpf(asked):
        raise SystemExit(f"YADE holds {got}, but {asked!r} was given")


def build():
    """Make bodies of mass and diameter 1 and YADE's engines."""
    O.dt = given(SCENE["dt"])
    same(O.dt, SCENE["dt"])
    O.materials.append(FrictMat(density=1, young=given(SCENE["young"]), poisson=0.25, frictionAngle=0))
    same(O.materials[0].young, SCENE["young"])
    if SCENE["side"]:
        O.periodic = True
        O.cell.setBox(*given([SCENE["side"]] * 3))
    for x, y, vx, vy, frozen in SCENE["disks"]:
        disk(x, y, vx, vy, frozen)
    newton = NewtonIntegrator(damping=0, gravity=Vector3(*given([0, -SCENE["gravity"], 0])))
    contacts = InteractionLoop(
        [Ig2_Sphere_Sphere_ScGeom()], [Ip2_FrictMat_FrictMat_FrictPhys()], [Law2_ScGeom_FrictPhys_CundallStrack()]
    )
    collider = InsertionSortCollider([Bo1_Sphere_Aabb()], verletDist=0.125)
    runner = PyRunner(iterPeriod=SCENE["every"], initRun=False, command="sample()")
    O.engines = [ForceResetter(), collider, contacts, newton, runner]
    if SCENE["loop"] != "yade":
        grain_loop.use_grain_loop(precision=SCENE["loop"], largestOverlap=1)


def disk(x, y, vx, vy, frozen):
    """Add a disk that does not rotate: without friction there is no torque."""
    body = utils.sphere((0, 0, 0), 0.5, color=(1, 1, 1))
    state = body.state
    state.mass, state.inertia = 1, Vector3(1, 1, 1) / 8
    state.pos, state.vel = Vector3(*given([x, y, SCENE["side"] / 2])), Vector3(*given([vx, vy, 0]))
    state.blockedDOFs = "xyzXYZ" if frozen else "zXYZ" if SCENE["loop"] == "yade" else "zXY"
    for got, asked in zip((*state.pos, *state.vel), (x, y, SCENE["side"] / 2, vx, vy, 0)):
        same(got, asked)
    ident = O.bodies.append(body)
    if not frozen:
        MOVING.append(ident)


def exact(number):
    """Return a number of YADE in decimal digits, with the full precision of its type."""
    return str(decimal.Decimal(number)) if isinstance(number, float) else mpmath.nstr(number, mpmath.mp.dps)


def sample():
    """Print steps, positions and velocities of the moving disks, first in full precision, later as doubles."""
    if os.getppid() != PARENT:  # the process that started this one was killed
        shutil.rmtree(FOLDER, ignore_errors=True)
        os._exit(1)
    steps, states = O.iter + 1, [O.bodies[i].state for i in MOVING]
    write = exact if steps <= SCENE["exact_until"] else lambda number: repr(float(number))
    row = dict(
        steps=steps,
        place=[write(number) for state in states for number in tuple(state.pos)[:2]],
        velocity=[float(number) for state in states for number in tuple(state.vel)[:2]],
    )
    print(json.dumps(row), flush=True)


print(json.dumps(dict(folder=FOLDER)), flush=True)
build()
O.run(SCENE["steps"], True)
complete = O.iter == SCENE["steps"]
print(json.dumps(dict(complete=complete)), flush=True)
shutil.rmtree(FOLDER, ignore_errors=True)
sys.stdout.flush()
os._exit(0 if complete else 1)  # YADE's own exit is slow, and some builds print messages
