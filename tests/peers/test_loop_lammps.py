"""GrainLoop against LAMMPS: the energy of a bed that comes to rest, and a collision of two disks."""

import numpy as np
import pytest
from graindrive import engines  # noqa: F401  first: it finds YADE
from graindrive.benchmark import lammps, ours, scenes
from yade import O

pytestmark = pytest.mark.skipif(lammps.available() is None, reason="LAMMPS is not installed (Debian's package lammps)")


def falling_bed():
    """Return 600 disks on a loose lattice above a base: they fall, bounce and come to rest."""
    grains = scenes.lattice(20, 34, (0.9, 1.1), seed=1)
    return scenes.together(
        [grains, scenes.base(20)], **scenes.WIGGLE, friction=0.1, gravity=1.0, dt=1e-4, period=20.0, drive=(0, 0, 0)
    )


def settling_bed():
    """Return the falling bed after it has landed, at rest, so that both programs begin without springs."""
    landed = ours.move_on(falling_bed(), lambda loop, steps: steps >= 60_000, dt=2e-4)
    return dict(landed, **{key: np.zeros(len(landed["x"])) for key in ("vx", "vy", "spin")})


def on_grain_loop(a_scene, steps, **settings):
    """Return the loop after some steps of a scene whose velocities are given at full steps."""
    ours.bodies(a_scene)
    loop = ours.grain_loop(a_scene, **settings)
    loop.beginOnStep()
    O.run(steps - 1, True)
    return loop


def test_kinetic_energy_of_a_settling_bed(tmp_path):
    bed = settling_bed()
    lammps.write(bed, tmp_path)
    theirs = lammps.run(bed, 10_000, tmp_path, 1)["energy"]
    # The same arithmetic in another order: 1e-16 a step, amplified over 10,000 steps of grains that come to rest.
    assert on_grain_loop(bed, 10_000).kineticEnergyOnStep() == pytest.approx(theirs, rel=1e-6)


def test_a_collision_of_two_disks(tmp_path):
    pair = scenes.together(
        [dict(x=[5.0, 6.05], y=[5.0, 5.3], r=[0.5, 0.55], kind=scenes.FREE)],
        **scenes.WIGGLE,
        friction=0.1,
        gravity=0.0,
        dt=1e-5,
        period=20.0,
        drive=(0, 0, 0),
    )
    pair.update(vx=np.array([1.0, -1.0]), vy=np.array([0.2, 0.0]), spin=np.array([3.0, 1.0]))
    lammps.write(pair, tmp_path)
    for steps in (3000, 8000):  # during and after the collision
        theirs = lammps.run(pair, steps, tmp_path, 1)["energy"]
        # Round-off of 8,000 steps; LAMMPS writes 15 digits.
        assert on_grain_loop(pair, steps).kineticEnergyOnStep() == pytest.approx(theirs, rel=1e-9)
