"""Many grains: area fractions from a gas to beyond jamming, and a cell that is sheared to a strain of 100."""

import math

import numpy as np

from ..scenes import scene
from ..beds import shear_cell
from .few_grains import CLOSE, Grain, advance, duration, lattice, mass_of, place, said_by, spring
from .outcome import GUARD, RIGHT, judged, largest

FRACTIONS = {2: (0.01, 0.1, 0.5, 0.8, 0.9), 3: (0.01, 0.1, 0.3, 0.6, 0.73)}
STIFFNESS, GUARDED = 1e6, 0.05  # k_n; overlap at which GrainLoop stops a run [d]


def crowd(setting, dimensions, fraction, speed, **settings):
    """Put a lattice of frictionless grains that never lose energy into YADE, with random speeds; return its grain loop."""
    at, box = lattice(dimensions, fraction)
    rng = np.random.default_rng(1)
    velocity = np.zeros((len(at), 3))
    velocity[:, :dimensions] = rng.normal(0, speed, (len(at), dimensions))
    velocity -= velocity.mean(axis=0)
    law = spring(STIFFNESS)
    dt = duration(law, mass_of(dimensions) / 2) / 50
    place([Grain(tuple(x), tuple(v)) for x, v in zip(at, velocity)], law, setting, dt, dimensions, box=box, **settings)
    return scene.fast_loop()


def fractions(setting, *, dimensions):
    """Grains without friction and dissipation conserve energy, from a gas to a lattice whose grains almost touch."""
    trials = dict(fraction=[], closure=[], searches=[])
    for fraction in FRACTIONS[dimensions]:
        loop = crowd(setting, dimensions, fraction, 1.0, trackEnergy=True)
        advance(20_000 if dimensions == 2 else 5000)
        trials["fraction"].append(fraction)
        trials["closure"].append(loop.energy["closure"])
        trials["searches"].append(loop.searches)
    low, high = FRACTIONS[dimensions][0], FRACTIONS[dimensions][-1]
    sentence = (
        f"grains without dissipation, Φ = {low:g} to {high:g}: largest residual of the ledger over the energy exchanged"
    )
    tolerance = 1e-5 if setting.single else 1e-11
    return judged(RIGHT, max(trials["closure"]), 0.0, tolerance, "conservation of energy", sentence, trials)


def jamming(setting, *, dimensions):
    """The area or solid fraction at which the overlap guard stops a compressed lattice."""
    expected, guards = CLOSE[dimensions] / (1 - GUARDED) ** dimensions, set()

    def goes_on(ratio):
        def run():
            crowd(setting, dimensions, ratio * expected, 0.0)
            advance(1)

        said = said_by(run)
        guards.add("overlap by" in said if said else True)
        return not said

    found = largest(goes_on, 0.9, 1.1, 1e-4)
    sentence = f"Φ at which the overlap guard stops a compressed lattice, over {expected:.4f}"
    source = f"{CLOSE[dimensions]:.4f}/(1 − 0.05)^D: overlap 0.1 R"
    return judged(GUARD, found if all(guards) else math.nan, 1.0, 1e-3, source, sentence)


# Shear ----------------------------------------------------------------------------------------------------------------

PRESSURE, INERTIAL = 25.0, 0.3  # rho g d; I
SHEAR_STEP, SHEARED = 2e-4, 80  # sqrt(d/g); disks


def shear(setting):
    """Disks in a sheared periodic cell, to a large strain: the energy ledger closes, including the work of the cell."""
    rate = INERTIAL * math.sqrt(PRESSURE)
    cell = shear_cell.ShearCell(
        grains=SHEARED,
        stiffness=2e5,
        friction=0.5,
        restitution=0.92,
        shear_rate=rate,
        pressure=PRESSURE,
        area_fraction=0.0,
        every=5,
        seed=1,
    )
    cell.check(SHEAR_STEP, 0.3)
    cell.build(SHEAR_STEP, setting.loop, precision=setting.precision, largest_overlap=0.3)
    loop = scene.fast_loop()
    loop.trackEnergy = True
    blocks = 20
    steps = round(setting.strain / (rate * SHEAR_STEP * blocks))
    trials = dict(strain=[], closure=[], work=[])
    for block in range(1, blocks + 1):
        advance(steps)
        energy = loop.energy
        trials["strain"].append(block * steps * SHEAR_STEP * rate)
        trials["closure"].append(abs(energy["residual"]) / energy["workOfCell"])
        trials["work"].append(energy["workOfCell"])
    sentence = (
        f"sheared cell, I = 0.3, strain {setting.strain:g}: largest residual of the ledger over the work of the shear"
    )
    tolerance = 1e-3 if setting.single else 1e-9
    return judged(
        RIGHT,
        max(trials["closure"]),
        0.0,
        tolerance,
        "conservation of energy; tolerance of the ledger's tests",
        sentence,
        trials,
    )
