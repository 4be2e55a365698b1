"""The table of cases: a name, a description, the function that runs it, and the loops and precisions that apply to it."""

from functools import partial

from . import crowds, far_and_long, fluids, impacts, steps
from .outcome import Case

GRAIN, DOUBLE = ("grain",), ("double",)
IN_PLANE = ("cundall_strack", "hertz_mindlin")  # laws for disks only


def in_both(name, meaning, function, **limits):
    """Return {name_2d: Case, name_3d: Case} of a function that takes `dimensions`."""
    grains = {2: "disks", 3: "spheres"}
    return {f"{name}_{d}d": Case(f"{meaning}, {grains[d]}", partial(function, dimensions=d), **limits) for d in (2, 3)}


def step_cases():
    """Return the cases of the largest stable step of every law, in the dimensions in which the law exists."""
    made = {}
    for law in steps.LAWS:
        meaning = f"largest stable step, law {law.replace('_', ' ')}"
        cases = in_both(f"step_{law}", meaning, partial(steps.stable_step, law=law), precisions=DOUBLE)
        made.update({name: case for name, case in cases.items() if not (law in IN_PLANE and name.endswith("3d"))})
    return made


CASES = {
    **step_cases(),
    **in_both("step_deep", "stable step of deep contacts", steps.deep_step, loops=GRAIN, precisions=DOUBLE),
    **in_both("step_crystal", "largest stable step of a crystal", steps.stable_crystal, loops=GRAIN),
    "step_sticking_crystal_2d": Case(
        "largest stable step of a crystal with sticking contacts", steps.stable_crystal_that_sticks, GRAIN
    ),
    **in_both("restitution", "restitution 0.01 to 1", impacts.restitution),
    **in_both("friction", "friction coefficient 0 to 10", impacts.friction),
    **in_both("spin", "spin ratio up to 1000", impacts.spin),
    **in_both("angular_momentum", "angular momentum of a deep slipping contact", impacts.angular_momentum),
    **in_both("speed", "drive speed up to the overlap limit", impacts.speed_limit, loops=GRAIN),
    **in_both("passing", "drive speed at which grains pass through each other", impacts.passing, loops=GRAIN),
    **in_both("radius_ratio", "radius ratio 1:50", impacts.radius_ratio),
    **in_both("mass_ratio", "mass ratio 1e6", impacts.mass_ratio),
    "ring_2d": Case("sixty small disks hit a large one at once", impacts.ring),
    **in_both("stiffness", "stiffest and softest springs", impacts.stiffness),
    **in_both("softest", "grains too soft for their speed", impacts.softest, loops=GRAIN),
    **in_both("far", "an impact 1e6 d from the origin", far_and_long.far),
    **in_both("no_gravity", "free flight without gravity", far_and_long.no_gravity),
    **in_both("bound_pair", "very many steps of a grain oscillating on another", far_and_long.bound_pair),
    "oscillation": Case("amplitude and period of the wiggle's drive", far_and_long.oscillation, precisions=DOUBLE),
    "wiggle_ends": Case(
        "periods that are too short or too long for the wiggle study", far_and_long.wiggle_ends, GRAIN, DOUBLE
    ),
    **in_both("fraction", "energy from a gas to a dense lattice", crowds.fractions, loops=GRAIN),
    **in_both("jamming", "a lattice compressed beyond jamming", crowds.jamming, loops=GRAIN),
    "shear_strains": Case("energy of a cell sheared to a strain of 100", crowds.shear, GRAIN),
    "drum_full": Case(
        "rigid rotation in a full continuum drum",
        fluids.full,
        GRAIN,
        DOUBLE,
    ),
    "drum_empty": Case(
        "spin-up in a continuum drum with gas only",
        fluids.gas,
        GRAIN,
        DOUBLE,
    ),
    "drum_area": Case("area of the bed in a half full continuum drum", fluids.area, GRAIN, DOUBLE),
    "drum_fillings": Case("fillings that the continuum drum refuses", fluids.fillings, GRAIN, DOUBLE),
}
