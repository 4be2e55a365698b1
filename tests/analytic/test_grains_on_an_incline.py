"""Disks that flow steadily down a rough incline have the velocity profile of Bagnold flow, with mu(I) of the shear study.

A fluid of rheology mu(I) on a slope of angle theta has mu(I) = tan(theta), one I everywhere, p = phi rho g cos(theta) (h - y):

    u(y) = u_0 + 2/3 I sqrt(phi g cos(theta))/d (h^3/2 - (h - y)^3/2)

(GDR MiDi, Eur. Phys. J. E 14, 341 (2004)), with u_0 = 0 at the base. Grains are the disks of drum and shear study: d to
1.2 d, spring and dashpot, friction 0.5, restitution 0.92; units are d, rho, g. The profile is fitted in the middle of the layer:
within some d of the base and of the surface other laws hold, so that u_0 is not 0.

The base has disks at random heights. On a row of equal disks at one height, grains of similar size form rows that slide over each
other, with phi up to 0.87 near the base, and flow twice as fast.
"""

from types import SimpleNamespace

import numpy as np
import pytest

from graindrive.scenes import scene
from graindrive.scenes.material import SpringDashpotMaterial
from graindrive.postproc.shear.rheology import friction_law

SLOPE = 0.38  # tan(theta); grains stop near 0.27, and do not become steady above 0.45
CONSTANTS = dict(
    mu_s=0.2605, mu_2=0.724, i_0=0.312
)  # studies/RESULTS.md: homogeneous shear up to I = 0.2, chi^2/f = 0.8
DILATANCY = 0.818, -0.28  # phi = a + b I, from the same source
WIDTH, LAYERS, PITCH, ROUGHNESS = 20.0, 36, 1.26, 1.2  # d
STIFFNESS = 5e4 * np.pi / 4  # rho g d: 1,600 times the pressure at the base, so that grains are stiff
STEP, EVERY = 6e-4, 250  # sqrt(d/g), a sixteenth of a contact; steps between two samples
SETTLE, MEASURE = 120, 150  # sqrt(d/g): the flow forgets its start in h^2 phi/(mu p/shear rate), some 60
SLOW = 0.7  # initial velocity over that of the closed form
LOW, HIGH = 0.2, 0.8  # heights over that of the layer between which the profile is fitted


def inertial_number(slope):
    """Return I at which mu(I) is the slope."""
    return CONSTANTS["i_0"] * (slope - CONSTANTS["mu_s"]) / (CONSTANTS["mu_2"] - slope)


def base(rng):
    """Put two rows of frozen disks below y = 0, the upper one at random heights."""
    count = int(WIDTH / 1.1)
    x = (np.arange(count) + 0.5) * WIDTH / count
    scene.add_disks(x, rng.uniform(-ROUGHNESS, 0, count), np.full(count, 0.5), 1.0, "xyzXYZ")
    scene.add_base(WIDTH, 1.0, 1.0, y=-ROUGHNESS - 0.9)


def layer(rng):
    """Put a loose lattice of grains above the base, moving with a part of the closed form's velocity; return ids."""
    from yade import O
    from yade.minieigenHP import Vector3

    columns = int(WIDTH / PITCH)
    n = columns * LAYERS
    x = np.tile((np.arange(columns) + 0.5) * WIDTH / columns, LAYERS) + rng.uniform(-0.02, 0.02, n)
    y = np.repeat(1.3 + PITCH * np.arange(LAYERS), columns) + rng.uniform(-0.02, 0.02, n)
    radii = rng.uniform(1, 1.2, n) / 2
    ids = scene.add_disks(x, y, radii, 1.0)
    height = np.pi * np.sum(radii**2) / WIDTH / 0.8
    for id_, u in zip(ids, SLOW * bagnold(y / y.max() * height, height, 0.8)):
        O.bodies[id_].state.vel = Vector3(float(u), 0, 0)
    return ids


def bagnold(y, height, phi, power=1.5):
    """Return u(y) of the closed form with no slip at the base; another `power` gives another fluid's profile, up to a factor."""
    cos = 1 / np.sqrt(1 + SLOPE**2)
    return 2 / 3 * inertial_number(SLOPE) * np.sqrt(phi * cos) * (height**power - (height - y) ** power)


def tilt():
    """Tilt gravity by the angle of the slope."""
    angle = np.arctan(SLOPE)
    scene.fast_loop().gravity = (np.sin(angle), -np.cos(angle), 0)


@pytest.fixture(scope="module")
def flow():
    """The steady flow: middles of slabs `y`, `u`, `phi` (n,), and the mean velocity `speed` at each sample."""
    from yade import O

    rng = np.random.default_rng(1)
    scene.start(WIDTH, LAYERS * PITCH + 10)
    O.dt = STEP
    base(rng)
    ids = layer(rng)
    scene.run_on("grain", SpringDashpotMaterial(STIFFNESS, STIFFNESS * 2 / 7, 0.92, 0.5, 1.0), 1.0, largest_overlap=0.3)
    tilt()
    edges = np.arange(0, LAYERS * PITCH)
    area, flux, speed = np.zeros(len(edges) - 1), np.zeros(len(edges) - 1), []
    O.run(int(SETTLE / STEP), True)
    for _ in range(samples := int(MEASURE / STEP / EVERY)):
        O.run(EVERY, True)
        grains = scene.rows_of(ids)
        weight = np.pi * grains["r"] ** 2
        area += np.histogram(grains["y"], edges, weights=weight)[0]
        flux += np.histogram(grains["y"], edges, weights=weight * grains["vx"])[0]
        speed.append(np.average(grains["vx"], weights=weight))
    assert O.iter == int(SETTLE / STEP) + samples * EVERY
    return SimpleNamespace(
        y=(edges[1:] + edges[:-1]) / 2,
        u=flux / np.where(area > 0, area, np.nan),
        phi=area / samples / WIDTH,
        speed=np.array(speed),
    )


@pytest.fixture(scope="module")
def middle(flow):
    """The middle of the layer: `y`, `u` (n,), mean `phi`, and `height`, that of a layer of this phi with the same weight."""
    top = flow.y[np.flatnonzero(flow.phi > 0.4)[-1]]
    chosen = (flow.y > LOW * top) & (flow.y < HIGH * top)
    phi = flow.phi[chosen].mean()
    above = np.sum(flow.phi[flow.y > HIGH * top])
    last = flow.y[chosen][-1]
    return SimpleNamespace(y=flow.y[chosen], u=flow.u[chosen], phi=phi, height=last + 0.5 + above / phi)


def fitted(middle, power):
    """Fit the closed form with a free u_0; return (factor on it, root mean square residual over the range of u)."""
    shape = bagnold(middle.y, middle.height, middle.phi, power)
    design = np.c_[np.ones_like(shape), shape]
    constants, *_ = np.linalg.lstsq(design, middle.u, rcond=None)
    return constants[1], np.sqrt(np.mean((middle.u - design @ constants) ** 2)) / np.ptp(middle.u)


def test_the_flow_is_steady(flow):
    """The mean velocities of the two halves agree; an avalanche or a jam would change them by their own size."""
    early, late = np.array_split(flow.speed, 2)
    assert late.mean() == pytest.approx(early.mean(), rel=0.08)


def test_the_profile_has_the_power_of_bagnold_flow(middle):
    """The residual is 0.2 to 0.9 % of the range (four runs, two seeds); that of a line 1.5 to 2.5 %, a parabola 2.1 to 3.1 %."""
    _, rest = fitted(middle, 1.5)
    assert rest < 0.014
    for power in (1.0, 2.0):
        assert fitted(middle, power)[1] > 1.2 * rest, power


def test_its_amplitude_is_that_of_mu_of_i_of_the_shear_study(middle):
    """Measured: 1.04 to 1.07 (four runs, up to twice as long, of two seeds), each to 3 %.

    The closed form takes the pressure as isotropic. In the shear study at this I the stress across the layers is 1.028 p,
    so that at this slope tau/p is 0.3905 in place of 0.38, and I 11 % larger. The rest of the tolerance are
    2 errors of this run.
    """
    factor, _ = fitted(middle, 1.5)
    assert factor == pytest.approx(1 + 0.11 / 2, abs=0.11 / 2 + 2 * 0.03)
    assert friction_law(factor * inertial_number(SLOPE), **CONSTANTS) == pytest.approx(SLOPE, abs=0.015)


def test_its_area_fraction_is_that_of_the_shear_study(middle):
    """Measured 0.778; the fit gives 0.787 with an error of 0.001. phi is the same at all heights, because I is."""
    at_zero, slope = DILATANCY
    assert middle.phi == pytest.approx(at_zero + slope * inertial_number(SLOPE), abs=0.015)
