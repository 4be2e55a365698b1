"""The drum's continuum at extreme values of its largest viscosity: full, without a bed, half full; and refused keys."""

from types import SimpleNamespace

import numpy as np

from ..continuum import drum_continuum
from .. import study
from ..continuum.continuum import FlowMarch
from .few_grains import said_by
from .outcome import BOUND, GUARD, RIGHT, judged

VISCOSITIES = (1e2, 1e3, 1e4, 1e5, 1e6)  # m sqrt(g/d)
KEYS = dict(model="continuum", drum_diameter=40, froude=0.02, cells=24, continuum_dt=0.05)
SPUN_UP = 30.0  # sqrt(d/g): the fluid follows the walls within R^2 rho/(5.8 eta), 0.7 at the least viscosity
DRAGGED = 0.05  # R^2/nu: after this time the gas has a boundary layer of some cells
HALF_A_LAYER = 60.0  # sqrt(d/g), a turn of 108 degrees


def drum():
    """Return the drum study."""
    return study.loaded(study.house()["drum"])


def flow_of(viscosity, filling):
    """Return the parameters and the `TwoPhaseFlow` of a small drum, filled to any part of it."""
    p = drum().parameters(**KEYS, largest_viscosity=viscosity)
    keys = SimpleNamespace(**{**p.taken(), "omega": p.omega, "filling": filling})
    return keys, drum_continuum.flow_of(keys)


def marched(flow, time, dt):
    """Advance a flow by some time."""
    FlowMarch(flow, "lower continuum_dt").advance(round(time / dt))
    return flow


def off_rigid_rotation(p, flow):
    """Return the largest difference from a rigid rotation inside of the drum, over the wall's speed."""
    x, y = drum_continuum.grid_of(p)
    inside = flow.openness >= 1
    vx, vy = flow.velocity[..., 0] + p.omega * y[:, None], flow.velocity[..., 1] - p.omega * x
    return float(np.hypot(vx, vy)[inside].max() / (p.omega * p.drum_diameter / 2))


def full(_setting):
    """The fluid in a completely full drum finally rotates like a rigid body, for every largest viscosity."""
    trials = dict(viscosity=[], error=[])
    for viscosity in VISCOSITIES:
        p, flow = flow_of(viscosity, 1.0)
        marched(flow, SPUN_UP, p.continuum_dt)
        trials["viscosity"].append(viscosity)
        trials["error"].append(off_rigid_rotation(p, flow))
    worst = max(trials["error"])
    sentence = (
        "full drum, η_max 1e2 to 1e6 m√(g/d), 24 cells: largest deviation from rigid rotation over the wall's velocity"
    )
    return judged(BOUND, worst, 0.0, 1e-3, "v = Ω × r", sentence, trials)


def spun_up(part, time):
    """Return the velocity over the wall's at a radius [R] and a time [R^2/nu] after the wall began to turn; any shape."""
    from scipy import special

    roots = special.jn_zeros(1, 60)
    at = np.asarray(part)[..., None] * roots
    terms = special.j1(at) / (roots * special.j0(roots)) * np.exp(-(roots**2) * time)
    return part + 2 * terms.sum(axis=-1)


def gas(_setting):
    """A drum with gas only: the spin-up of a viscous fluid, for every largest viscosity (the gas has 1e-6 of it)."""
    trials = dict(viscosity=[], error=[])
    for viscosity in VISCOSITIES:
        p, flow = flow_of(viscosity, 0.0)
        x, y = drum_continuum.grid_of(p)
        far, radius = np.hypot(x, y[:, None]), p.drum_diameter / 2
        kinematic = drum_continuum.GAS_VISCOSITY / drum_continuum.GAS_DENSITY * viscosity * drum_continuum.GRAIN_MASS
        kinematic /= drum_continuum.BED_FRACTION
        marched(flow, max(SPUN_UP, DRAGGED * radius**2 / kinematic), p.continuum_dt)
        around = (flow.velocity[..., 1] * x - flow.velocity[..., 0] * y[:, None]) / far / (p.omega * radius)
        inside = flow.openness >= 1
        error = np.abs(around - spun_up(np.minimum(far / radius, 1), kinematic * flow.time / radius**2))[inside].max()
        trials["viscosity"].append(viscosity)
        trials["error"].append(float(error))
    worst = max(trials["error"])
    sentence = (
        "drum with gas only, η_max 1e2 to 1e6 m√(g/d), 24 cells: velocity during the spin-up, largest error over the wall's"
        " velocity"
    )
    # The transition between fluid and wall is two cells thick, of twelve along the radius, and the wall acts from within it.
    return judged(BOUND, worst, 0.0, 0.2, "spin-up of a fluid in a cylinder, by Bessel functions", sentence, trials)


def area(_setting):
    """A half full drum conserves the area of its bed, for every largest viscosity."""
    trials = dict(viscosity=[], error=[], fastest=[])
    for viscosity in VISCOSITIES:
        p, flow = flow_of(viscosity, 0.5)
        before = flow.area
        marched(flow, HALF_A_LAYER, p.continuum_dt)
        trials["viscosity"].append(viscosity)
        trials["error"].append(flow.area / before - 1)
        trials["fastest"].append(float(np.hypot(*np.moveaxis(flow.velocity, -1, 0)).max()))
    worst = max(trials["error"], key=abs)
    sentence = "half full drum, η_max 1e2 to 1e6 m√(g/d), a turn of 108°: largest relative change of the bed's area"
    return judged(RIGHT, worst, 0.0, 1e-3, "∇·v = 0", sentence, trials)


def fillings(_setting):
    """The study refuses a drum that is almost full or almost empty, and a step in which the wall crosses cells."""
    made = drum()
    asked = (
        (dict(filling=0.95), "gives the continuum no free surface"),
        (dict(filling=0.02), "cells deep"),
        (dict(continuum_dt=5.0), "lets the wall cross"),
    )
    said = [said_by(lambda keys=keys: made.check(made.parameters(**{**KEYS, **keys}))) for keys, _ in asked]
    found = sum(words in told for told, (_, words) in zip(said, asked))
    sentence = (
        "drum, filling 0.95 and 0.02, and a step in which the wall crosses cells: number of refusals that name the key"
    )
    return judged(GUARD, found, len(asked), 0.5, "a bed needs a surface and six cells", sentence)
