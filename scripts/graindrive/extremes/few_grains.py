"""Scenes of a few grains under any law, in two or three dimensions, on either loop; lengths in d, masses in rho d^D."""

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ..lazily import engines
from ..loops import grain_loop
from ..scenes import yade_march
from ..scenes import scene
from ..base.errors import EngineError, UsageError

R = 0.5  # radius of a usual grain [d]
OWN = ("cundallStrack", "hertzMindlin")  # YADE's own laws, for disks
CLOSE = {
    2: math.pi / (2 * math.sqrt(3)),
    3: math.pi / (3 * math.sqrt(2)),
}  # area fraction of a triangular, solid fraction of a face-centred cubic lattice


@dataclass(frozen=True)
class Law:
    """A law by its name in GrainLoop, its constants, and the friction; a material for `scene.yade_loop`."""

    LAW: str
    numbers: dict
    friction: float = 0.0

    def given(self):
        """Return the law's constants, under the names of GrainLoop and of the Law2_ functor."""
        return dict(self.numbers)

    def terms(self, overlap, radius=R / 2, mass=1.0):
        """Return `engines.terms_of_law` at an overlap, for a reduced radius and mass."""
        return engines.terms_of_law(self.LAW, self.given(), overlap, radius, mass)


class Grain(NamedTuple):
    """Initial state of a grain: position and velocity (x, y) or (x, y, z), radius, mass over that of density 1, spin about z.

    A `held` grain keeps its velocity.
    """

    at: tuple
    velocity: tuple = (0, 0, 0)
    radius: float = R
    weight: float = 1.0
    spin: float = 0.0
    held: bool = False


def mass_of(dimensions, radius=R):
    """Return the mass of a grain of density 1."""
    return math.pi * radius**2 if dimensions == 2 else 4 / 3 * math.pi * radius**3


def spring(k_n=1e6, restitution=1.0, friction=0.0, ratio=1 / 3):
    """Return a linear spring and dashpot with k_t = ratio k_n."""
    given = dict(normalStiffness=k_n, tangentialStiffness=ratio * k_n, restitution=restitution)
    return Law("springDashpot", given, friction)


def duration(law, mass, overlap=None):
    """Return pi sqrt(m/k): the duration of a linear contact; for another law k is its stiffness at an overlap."""
    return math.pi * math.sqrt(mass / law.terms(overlap or 1e-3, mass=mass)["stiffness"])


def body_of(grain, dimensions):
    """Return YADE's body of a `Grain`."""
    from yade.minieigenHP import Vector3

    at, velocity = (tuple(map(float, (*v, 0, 0)))[:3] for v in (grain.at, grain.velocity))
    if dimensions == 2:
        body = scene.disk(at[0], at[1], grain.radius, grain.weight)
        body.state.pos = Vector3(*at)
    else:
        body = scene.sphere(at, grain.radius, grain.weight)
    if grain.held:
        body.state.blockedDOFs = "xyzXYZ"
    body.state.vel, body.state.angVel = Vector3(*velocity), Vector3(0, 0, float(grain.spin))
    body.state.angMom = body.state.angVel * body.state.inertia[2]
    return body


def place(grains, law, setting, dt, dimensions=2, *, gravity=0.0, before=(), box=None, **settings):
    """Put grains and the loop of `setting` into YADE; return their ids. Errors come from GrainLoop's own checks.

    `before` are drives, which precede the integrator; `box` is the size of a periodic cell; `settings` go to GrainLoop.
    """
    from yade import O
    from yade.wrapper import FrictMat

    O.reset()
    O.dt = dt
    if box is not None:
        O.periodic = True
        O.cell.setBox(*map(float, box))
    numbers = law.given()
    material = FrictMat(
        density=1,
        young=numbers.get("young", 1e6),
        poisson=numbers.get("poisson", 0.3),
        frictionAngle=math.atan(law.friction),
    )
    O.materials.append(material)
    ids = O.bodies.append([body_of(grain, dimensions) for grain in grains])
    if law.LAW in OWN:
        yades_own(law, gravity, before)
    else:
        scene.yade_loop(law, gravity, before)
    if setting.loop == "grain":
        grain_loop.use_grain_loop(dimensions=dimensions, precision=setting.precision, label="loop", **settings)
    return ids


def yades_own(law, gravity, before):
    """Put YADE's loop with one of its own laws into O.engines."""
    from yade import O
    from yade import wrapper as w

    numbers = law.given()
    if law.LAW == "cundallStrack":
        pair = [w.Ip2_FrictMat_FrictMat_FrictPhys()], [w.Law2_ScGeom_FrictPhys_CundallStrack()]
    else:
        ratios = dict(betan=numbers["normalDampingRatio"], betas=numbers["tangentialDampingRatio"])
        pair = [w.Ip2_FrictMat_FrictMat_MindlinPhys(**ratios)], [w.Law2_ScGeom_MindlinPhys_Mindlin()]
    O.engines = [
        w.ForceResetter(),
        w.InsertionSortCollider([w.Bo1_Sphere_Aabb()]),
        w.InteractionLoop([w.Ig2_Sphere_Sphere_ScGeom()], *pair),
        *before,
        w.NewtonIntegrator(damping=0, gravity=(0, -gravity, 0)),
    ]


def advance(steps):
    """Run some steps; raises the error of a guard."""
    yade_march.advance(int(steps))


def said_by(action):
    """Return the message of a guard during `action()`, "" if there is none."""
    try:
        action()
    except (EngineError, RuntimeError, ValueError, UsageError) as error:
        return " ".join(str(error).split())
    return ""


def state_of(ident):
    """Return (place, velocity, spin about z) of a body, arrays (3,) and a number."""
    from yade import O

    state = O.bodies[ident].state
    return np.array(state.pos), np.array(state.vel), float(state.angVel[2])


def lattice(dimensions, fraction):
    """Return positions (n, 3) and box of a close-packed lattice, scaled to an area or solid fraction."""
    spacing = (CLOSE[dimensions] / fraction) ** (1 / dimensions)
    if dimensions == 2:
        column, row = (axis.ravel() for axis in np.meshgrid(np.arange(8), np.arange(8)))
        at = np.c_[column + 0.5 * (row % 2) + 0.25, (row + 0.5) * math.sqrt(3) / 2, np.zeros(len(row))]
        box = np.array([8, 8 * math.sqrt(3) / 2, 10 / spacing])
    else:
        corners = np.array([(0, 0, 0), (0, 1, 1), (1, 0, 1), (1, 1, 0)]) / math.sqrt(2)
        cells = np.array([(i, j, k) for i in range(4) for j in range(4) for k in range(4)]) * math.sqrt(2)
        at = (cells[:, None] + corners).reshape(-1, 3) + 0.3
        box = np.full(3, 4 * math.sqrt(2))
    return at * spacing, box * spacing
