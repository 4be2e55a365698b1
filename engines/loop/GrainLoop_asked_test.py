"""GrainLoop's state can be read at any time: while O.run works in the background, after a pause, between steps and within one."""

import disks
import numpy as np
import pytest
from graindrive import engines
from graindrive.loops import grain_loop
from yade import O


def crowd(side=12):
    """Moving disks between frozen ones."""
    disks.new_scene(dt=2e-4)
    rng = np.random.default_rng(4)
    for k in range(side):
        disks.disk(1.1 * k, 0, frozen=True)
    ids = [
        disks.disk(1.1 * (k % side) + 0.02 * rng.normal(), 1.1 + 1.1 * (k // side), velocity=0.2 * rng.normal(size=2))
        for k in range(side * side)
    ]
    disks.loop(disks.hertz(gamma_n=5, gamma_t=5), friction=0.3)
    return ids


def wait_for_steps(until):
    while O.iter < until and O.running:
        pass


def test_asking_while_a_run_goes_on_in_the_background_finds_it_between_two_steps():
    crowd()
    loop = grain_loop.use_grain_loop(threads=2)
    O.run()
    for k in range(150):
        table = loop.presentContacts()
        assert np.all(table["overlap"] > 0)
        assert len(loop.positions) == len(loop.ids)
        loop.contacts(), loop.springs, loop.kineticEnergy
        wait_for_steps(O.iter + 3)
    O.pause()
    O.wait()


def test_after_a_pause_bodies_are_true_and_what_is_written_into_them_is_heard():
    ids = crowd()
    loop = grain_loop.use_grain_loop()
    free = ids[-1]
    for k in range(25):
        begun = O.iter
        O.run()
        wait_for_steps(begun + 50)
        O.pause()
        O.wait()
        row = list(loop.ids).index(free)
        np.testing.assert_array_equal(tuple(O.bodies[free].state.pos)[:2], loop.positions[row])
        O.bodies[free].state.pos = (5.0, 40.0 + k, 0)
        O.bodies[free].state.vel = (0, 0, 0)
        O.step()
        assert loop.positions[row][1] == 40 + k


def test_overlap_and_force_of_a_contact_are_of_the_same_moment():
    """Two disks meet without damping: F_n = K_n sqrt(R_eff overlap) overlap at every moment."""
    k_n = 2e5
    for moving in ("free", "large"):
        disks.new_scene(dt=1e-3)
        disks.disk(0, 0, velocity=(3, 1), radius=0.5)
        if moving == "large":
            disks.disk(2.48, 0.1, velocity=(-2, 0), radius=2.0)
        else:
            disks.disk(0.98, 0.1, velocity=(-2, 0))
        for k in range(4):
            disks.disk(20 + 2 * k, 0)
        disks.loop(disks.hertz(k_n=k_n), friction=0.0)
        loop = grain_loop.use_grain_loop()
        seen = 0
        for _ in range(40):
            O.step()
            table = loop.contacts()
            present = loop.presentContacts()
            again = loop.contacts()
            for name in table:
                np.testing.assert_array_equal(table[name], again[name])  # reading does not change the state
            for each in (table, present):
                for overlap, force in zip(each["overlap"], np.linalg.norm(each["normal_force"], axis=1)):
                    r_eff = 0.25 if moving == "free" else 0.4
                    assert force == pytest.approx(k_n * np.sqrt(r_eff * overlap) * overlap, rel=1e-9)
                    seen += 1
        assert seen > 10


def test_a_loop_that_stands_no_more_in_the_scene_says_so():
    crowd(4)
    old = grain_loop.use_grain_loop()
    O.engines = O.engines[:-1] + [engines.GrainLoop()]
    with pytest.raises(RuntimeError, match="this GrainLoop does not stand in O.engines"):
        old.positions
