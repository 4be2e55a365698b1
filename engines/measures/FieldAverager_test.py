"""FieldAverager: the same fields on both loops, which bodies count as grains, moving windows, periodic images."""

import math

import numpy as np
import pytest
from disks import clump, disk, engine, hertz, loop, new_scene, run
from field_scenes import FIELDS, LENGTH, averager, crowd, fields_of
from graindrive.loops import grain_loop
from yade import O, utils


@pytest.fixture(autouse=True)
def scene():
    new_scene(dt=1e-4)
    yield
    O.reset()


# ---- both loops ----


@pytest.mark.parametrize("steps", [1, 5])
@pytest.mark.parametrize("body", ["disk", "clump"])
@pytest.mark.parametrize("kernel", ["diskBin", "gaussian", "sphere"])
def test_both_loops_show_the_same_fields(kernel, body, steps):
    seen = []
    for switch in (False, True):
        crowd(body=body, kernel=kernel, relative=True)
        if switch:
            grain_loop.use_grain_loop(periods=(LENGTH, LENGTH))
        run(steps)
        seen.append(fields_of(engine("fields")))
        assert engine("fields").samples.tolist() == [steps]
    for name in FIELDS:
        expected, found = seen[0][name], seen[1][name]
        assert np.isnan(found).sum() == np.isnan(expected).sum()
        scale = np.nanmax(np.abs(expected))
        assert scale > 0
        # Overlaps are 0.02 of a diameter, differences of positions up to 9: forces are round-off to 1e-13.
        np.testing.assert_allclose(found, expected, rtol=0, atol=1e-12 * scale, err_msg=name)


def test_looking_at_the_contacts_changes_nothing():
    ends = []
    for stress in (False, True):
        crowd(stress=stress, origin=(4, 4, 0))
        grain = grain_loop.use_grain_loop(periods=(LENGTH, LENGTH))
        run(50)
        ends.append(np.c_[grain.positions, grain.velocities, grain.spins])
    np.testing.assert_array_equal(ends[0], ends[1])


@pytest.mark.parametrize("threads, precision", [(2, "double"), (1, "single"), (2, "single")])
def test_threads_and_precision_of_the_loop(threads, precision):
    def seen(**settings):
        crowd(origin=(4, 4, 0))
        grain_loop.use_grain_loop(periods=(LENGTH, LENGTH), **settings)
        run(3)
        return fields_of(engine("fields"))

    expected, found = seen(), seen(threads=threads, precision=precision)
    for name in FIELDS:
        tolerance = 1e-12 if precision == "double" else 1e-4  # forces in single precision: 1e-7 over overlaps of 0.02
        scale = np.nanmax(np.abs(expected[name]))
        np.testing.assert_allclose(found[name], expected[name], rtol=0, atol=tolerance * scale, err_msg=name)


# ---- what is a grain ----


def test_the_window_holds_the_mass_of_its_free_grains():
    crowd(low=(0, 0, 0), high=(LENGTH, LENGTH, 0), kernel="diskBin", spacing=0.1)
    O.bodies[17].state.pos += (3 * LENGTH, -2 * LENGTH, 0)  # another image of the same place
    free = [b for b in O.bodies if b.state.blockedDOFs == "zXY" and not b.isClump and not b.isClumpMember]
    assert len(free) == 81 - 2 - 9 - 1
    area, mass = sum(math.pi * b.shape.radius**2 for b in free), sum(b.state.mass for b in free)
    run(1)
    fields = engine("fields")
    assert fields.areaFraction.sum() * 0.1**2 == pytest.approx(area, rel=1e-12)
    assert fields.density.sum() * 0.1**2 == pytest.approx(mass, rel=1e-12)


def test_a_free_disk_is_left_out_of_its_own_fields():
    ids = [disk(0, 0), disk(2, 0)]
    loop(before_newton=[averager(body=ids[0], kernel="diskBin"), averager("fixed", kernel="diskBin")])
    run(1)
    own, fixed = engine("fields").areaFraction.sum() * 0.25**2, engine("fixed").areaFraction.sum() * 0.25**2
    assert own == pytest.approx(math.pi / 4, rel=1e-12)
    assert fixed == pytest.approx(2 * math.pi / 4, rel=1e-12)


@pytest.mark.parametrize("grain_first", [True, False])
@pytest.mark.parametrize("other", ["grain", "frozen", "clump", "body"])
def test_a_bound_grain_counts_to_the_contact_point(other, grain_first):
    overlap, centre = 0.02, 0.98
    if grain_first:
        disk(0, 0)
    bound = {"frozen": dict(frozen=True)}.get(other, {})
    second = clump([(0, 0)], at=(centre, 0), radius=0.5)[0] if other == "clump" else disk(centre, 0, **bound)
    if not grain_first:
        disk(0, 0)
    options = dict(body=second, low=(-3 - centre, -3, 0), high=(3 - centre, 3, 0)) if other == "body" else {}
    loop(hertz(), before_newton=[averager(kernel="diskBin", **options)])
    run(1)
    force = 2e5 * math.sqrt(0.25 * overlap) * overlap
    length = centre if other == "grain" else 0.5 - overlap / 2
    total = engine("fields").contactStress[0].sum(axis=(0, 1)) * 0.25**2
    np.testing.assert_allclose(total, [[force * length, 0], [0, 0]], rtol=1e-12, atol=1e-12 * force)


def test_flat_walls_bound_the_grains():
    disk(0, 0.49)
    loop(hertz(), before_newton=[averager(kernel="diskBin")])
    grain = grain_loop.use_grain_loop()
    grain.setWall("y_low", position=0)
    run(1)
    force = 2e5 * math.sqrt(0.5 * 0.01) * 0.01  # R_eff = R
    total = engine("fields").contactStress[0].sum(axis=(0, 1)) * 0.25**2
    np.testing.assert_allclose(total, [[0, 0], [0, force * 0.49]], rtol=1e-12, atol=1e-15)


def test_yades_own_wall_bounds_the_grains_too():
    from yade.wrapper import (
        Bo1_Sphere_Aabb,
        Bo1_Wall_Aabb,
        ForceResetter,
        Ig2_Sphere_Sphere_ScGeom,
        Ig2_Wall_Sphere_ScGeom,
        InsertionSortCollider,
        InteractionLoop,
        Ip2_FrictMat_FrictMat_FrictPhys,
        Law2_ScGeom_FrictPhys_CundallStrack,
        NewtonIntegrator,
    )

    O.bodies.append(utils.wall((0, 0, 0), 1))
    ball = disk(0, 0.49)
    O.engines = [
        ForceResetter(),
        InsertionSortCollider([Bo1_Sphere_Aabb(), Bo1_Wall_Aabb()]),
        InteractionLoop(
            [Ig2_Sphere_Sphere_ScGeom(), Ig2_Wall_Sphere_ScGeom()],
            [Ip2_FrictMat_FrictMat_FrictPhys()],
            [Law2_ScGeom_FrictPhys_CundallStrack()],
        ),
        averager(kernel="diskBin"),
        NewtonIntegrator(damping=0),
    ]
    run(1)
    force = O.forces.f(ball)[1]
    assert force > 0
    assert engine("fields").contactStress[0, :, :, 1, 1].sum() * 0.25**2 == pytest.approx(force * 0.49, rel=1e-12)


# ---- frames ----


@pytest.mark.parametrize("loops", ["yade", "grain"])
def test_the_window_goes_with_its_body_and_its_velocity(loops):
    body = disk(5, 1, velocity=(3, -1), frozen=False)
    disk(6.5, 1.25, velocity=(3, 1))
    loop(before_newton=[averager(body=body, kernel="gaussian", relative=True), averager("still", body=body)])
    if loops == "grain":  # which writes a free disk to YADE at the end only
        grain_loop.use_grain_loop()
    run(200)
    fields = engine("fields")
    row, column = np.argwhere(np.isclose(fields.y, 0.375))[0, 0], np.argwhere(np.isclose(fields.x, 1.375))[0, 0]
    # 200 steps of 1e-4 at a relative velocity of (0, 2): 0.02 further up on average.
    np.testing.assert_allclose(fields.velocity[0, row, column], (0, 2), atol=1e-12)
    np.testing.assert_allclose(engine("still").velocity[0, row, column], (3, 1), atol=1e-12)
    moment = (fields.areaFraction[0] * fields.x).sum() / fields.areaFraction[0].sum()
    assert moment == pytest.approx(1.5, abs=2e-3)  # the middle of a Gaussian of width 0.6 on a grid of 0.25


@pytest.mark.parametrize("loops", ["yade", "grain"])
def test_a_window_over_the_periodic_side_sees_the_other_side(loops):
    def seen(shift):
        new_scene(period=(10, 40, 10))
        for x, y in ((0.3, 0.2), (1.28, 0.2), (0.8, 1.05), (-1.1, -0.7)):
            disk((x + shift) % 10, 20 + y, velocity=(x, y))
        loop(hertz(), before_newton=[averager(kernel="diskBin", origin=(shift, 20, 0))])
        if loops == "grain":
            grain_loop.use_grain_loop()
        run(1)
        return fields_of(engine("fields"))

    inside, across = seen(5.0), seen(10.0)
    assert inside["contactStress"].max() > 0
    for name in FIELDS:
        np.testing.assert_allclose(across[name], inside[name], rtol=0, atol=1e-11 * np.nanmax(np.abs(inside[name])))
