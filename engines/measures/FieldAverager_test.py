"""FieldAverager: the same fields on both loops, phases, periodic images, what bounds the grains, save and load, bad input."""

import math

import numpy as np
import pytest
from disks import EPS, clump, disk, engine, engines, hertz, loop, new_scene, run
from graindrive import grain_loop
from yade import O, utils

KERNELS = ["diskBin", "gaussian", "sphere"]
FIELDS = ["areaFraction", "density", "velocity", "temperature", "contactStress", "kineticStress", "totalStress", "pressure"]
LENGTH = 9.0  # of the crowd's periodic box


@pytest.fixture(autouse=True)
def scene():
    new_scene(dt=1e-4)
    yield
    O.reset()


def averager(label="fields", **options):
    options = {"low": (-3, -3, 0), "high": (3, 3, 0), "spacing": 0.25, "width": 0.6, **options}
    return engines.FieldAverager(label=label, **options)


def crowd(*measures, friction=0.4, seed=4):
    """A periodic crowd of overlapping, spinning disks around a spinning one that is driven, a shaken clump and frozen disks."""
    new_scene(dt=1e-4, period=(LENGTH, LENGTH, LENGTH))
    rng = np.random.default_rng(seed)
    places = [(x + 0.5, y + 0.5) for x in range(9) for y in range(9)]
    middle, beads = (4.5, 4.5), [(7.5, 4.5), (8.5, 4.5)]
    for at in places:
        if at in beads:
            continue
        radius, velocity = rng.uniform(0.505, 0.52), rng.uniform(-1, 1, 2)
        body = disk(*at, radius, velocity=velocity, spin=rng.uniform(-2, 2), frozen=False)
        if at == middle or at[1] == 0.5:
            O.bodies[body].state.blockedDOFs = "xyzXYZ"
        if at[1] == 0.5:
            O.bodies[body].state.vel = O.bodies[body].state.angVel = (0, 0, 0)
    clump([(-0.5, 0), (0.5, 0)], at=(8, 4.5), radius=0.51)
    loop(hertz(gamma_n=100, gamma_t=100), friction=friction, before_newton=measures)
    return places.index(middle)


def fields_of(measure):
    return {name: getattr(measure, name) for name in FIELDS}


# ---- both loops ----


@pytest.mark.parametrize("precise_time", [1, 5])
@pytest.mark.parametrize("kernel", KERNELS)
def test_both_loops_show_the_same_fields(kernel, precise_time):
    seen = []
    for switch in (False, True):
        body = crowd(averager(body=40, kernel=kernel, relative=True))
        assert body == 40
        if switch:
            grain_loop.use_grain_loop(periods=(LENGTH, LENGTH))
        run(precise_time)
        seen.append(fields_of(engine("fields")))
        assert engine("fields").samples.tolist() == [precise_time]
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
        crowd(averager(stress=stress, origin=(4, 4, 0)))
        grain = grain_loop.use_grain_loop(periods=(LENGTH, LENGTH))
        run(50)
        ends.append(np.c_[grain.positions, grain.velocities, grain.spins])
    np.testing.assert_array_equal(ends[0], ends[1])


@pytest.mark.parametrize("threads, precision", [(2, "double"), (1, "single"), (2, "single")])
def test_threads_and_precision_of_the_loop(threads, precision):
    def seen(**settings):
        crowd(averager(origin=(4, 4, 0)))
        grain_loop.use_grain_loop(periods=(LENGTH, LENGTH), **settings)
        run(3)
        return fields_of(engine("fields"))

    expected, found = seen(), seen(threads=threads, precision=precision)
    for name in FIELDS:
        tolerance = 1e-12 if precision == "double" else 1e-4  # forces in float: 1e-7 over overlaps of 0.02
        scale = np.nanmax(np.abs(expected[name]))
        np.testing.assert_allclose(found[name], expected[name], rtol=0, atol=tolerance * scale, err_msg=name)


# ---- what is a grain ----


def test_the_window_holds_the_mass_of_its_free_grains():
    crowd(averager(low=(0, 0, 0), high=(LENGTH, LENGTH, 0), kernel="diskBin", spacing=0.1))
    O.bodies[17].state.pos += (3 * LENGTH, -2 * LENGTH, 0)  # another winding of the same place
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
    # 200 steps of 1e-4 at a relative velocity of (0, 2): 0.02 of the way up on average.
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


# ---- phases and statistics ----


def test_samples_go_to_their_phase():
    body = disk(0, 0)
    O.bodies[body].state.blockedDOFs = "zXY"
    period, phases, steps = 0.02, 4, 1000  # 200 steps a period, 50 a phase
    fields = averager(kernel="diskBin", spacing=6, phases=phases, period=period, phaseStart=0.005)
    loop(before_newton=[fields])
    for step in range(steps):
        # The velocity tells the time of the sample.
        O.bodies[body].state.vel = (1e-9 * step, 0, 0)
        O.step()
    assert fields.samples.tolist() == [250] * 4
    step = np.arange(steps)
    phase = ((step - 50) % 200) // 50
    for k in range(phases):
        mine = 1e-9 * step[phase == k]
        assert fields.velocity[k, 0, 0, 0] == pytest.approx(mine.mean(), rel=1e-12)
        assert fields.temperature[k, 0, 0] == pytest.approx(mine.var() / 2, rel=1e-10)


def test_every_and_clear():
    disk(0, 0)
    fields = averager(every=3, kernel="diskBin")
    loop(before_newton=[fields])
    run(20)
    assert fields.samples.tolist() == [7]  # steps 0, 3, ... 18
    fields.clear()
    assert fields.samples.tolist() == [0] and np.isnan(fields.areaFraction).all()
    run(10)
    assert fields.samples.tolist() == [3] and fields.areaFraction.sum() * 0.25**2 == pytest.approx(math.pi / 4)


def test_shapes_are_as_documented():
    disk(0, 0)
    fields = averager(low=(-2, -1, 0), high=(3, 1, 0), spacing=0.5, phases=3)
    loop(before_newton=[fields])
    run(2)
    np.testing.assert_allclose(fields.x, np.arange(-1.75, 3, 0.5))
    np.testing.assert_allclose(fields.y, [-0.75, -0.25, 0.25, 0.75])
    for name in ("areaFraction", "density", "temperature", "pressure"):
        assert getattr(fields, name).shape == (3, 4, 10)
    assert fields.velocity.shape == (3, 4, 10, 2)
    for name in ("totalStress", "contactStress", "kineticStress"):
        assert getattr(fields, name).shape == (3, 4, 10, 2, 2)
    assert np.isnan(fields.areaFraction[2]).all() and not np.isnan(fields.areaFraction[0]).any()


def test_pressure_is_half_the_trace_of_both_stresses():
    crowd(averager(origin=(4, 4, 0)))
    run(3)
    fields = engine("fields")
    both = fields.contactStress + fields.kineticStress
    np.testing.assert_array_equal(fields.totalStress, both)
    np.testing.assert_allclose(fields.pressure, np.trace(both, axis1=-2, axis2=-1) / 2, rtol=4 * EPS)
    assert fields.pressure.min() > 0


def test_a_settled_bed_carries_the_weight_above():
    """Poured disks at rest: averaged over the width, sigma_yy is the weight above per width at every height."""
    width = 10
    new_scene(dt=1e-3, period=(width, 100, 10))
    rng = np.random.default_rng(8)
    for x in range(width):
        disk(x + 0.5, 0, frozen=True)
    grains = [
        disk(x + 0.5 + rng.uniform(-0.01, 0.01), float(y), rng.uniform(0.45, 0.495))
        for y in np.arange(1, 17)
        for x in range(width)
    ]
    loop(hertz(gamma_n=100, gamma_t=100), friction=0.3, gravity=(0, -1))
    grain = grain_loop.use_grain_loop()
    grain.normalStiffness = grain.tangentialStiffness = 2e4
    run(60000)
    fields = averager(low=(0, 3, 0), high=(width, 11, 0), spacing=0.5, width=1, every=10)
    O.engines = [fields, *O.engines]
    run(100)
    weight = np.array([O.bodies[i].state.mass for i in grains])
    height = np.array([O.bodies[i].state.pos[1] for i in grains])
    # The field at y is a mean over exp(-(y - y')^2/w^2): so is the weight above.
    above = [(weight * [0.5 + 0.5 * math.erf(h - y) for h in height]).sum() / width for y in fields.y]
    sideways = fields.totalStress[0, :, :, 1, 1].mean(axis=1)
    np.testing.assert_allclose(sideways, above, rtol=0.02)
    assert above[0] > 2 * above[-1]


# ---- save, load, bad input ----


@pytest.mark.parametrize("loops", ["yade", "grain"])
def test_save_and_load_go_on_averaging(loops, tmp_path):
    crowd(averager(origin=(4, 4, 0), phases=2, period=1e-3))
    if loops == "grain":
        grain_loop.use_grain_loop(periods=(LENGTH, LENGTH))
    run(8)
    before = fields_of(engine("fields"))
    O.save(str(tmp_path / "scene.yade.gz"), quiet=True)
    O.load(str(tmp_path / "scene.yade.gz"), quiet=True)
    fields = engine("fields")
    assert fields.samples.tolist() == [5, 3] and fields.phases == 2 and fields.origin == (4, 4, 0)
    for name in FIELDS:
        np.testing.assert_array_equal(getattr(fields, name), before[name])
    run(2)
    assert fields.samples.tolist() == [5, 5]


def test_changing_the_grid_begins_anew():
    disk(0, 0)
    fields = averager()
    loop(before_newton=[fields])
    run(3)
    fields.spacing = 0.5
    assert fields.areaFraction.shape == (1, 12, 12) and np.isnan(fields.areaFraction).all()
    assert fields.samples.tolist() == [0]
    run(2)
    assert fields.samples.tolist() == [2]


@pytest.mark.parametrize(
    "wrong, words",
    [
        ({"kernel": "box"}, "'diskBin', 'gaussian' or 'sphere', got box"),
        ({"spacing": 0}, "spacing must be positive and finite, got 0"),
        ({"spacing": math.nan}, "spacing must be positive"),
        ({"spacing": 0.7}, "whole number of bins"),
        ({"spacing": 1e-7}, "1e6 spacings"),
        ({"spacing": 1e-4}, "at most 2e8 numbers"),
        ({"high": (-3, 3, 0)}, "high must exceed low"),
        ({"low": (math.inf, -3, 0)}, "must be finite"),
        ({"width": -1}, "width must be positive and finite, got -1"),
        ({"cutoff": 0}, "cutoff must be positive and finite"),
        ({"every": 0}, "every must be at least 1, got 0"),
        ({"phases": 0}, "phases must lie in 1..10000, got 0"),
        ({"period": 0}, "period must be positive and finite, got 0"),
        ({"phaseStart": math.inf}, "phaseStart must be finite"),
        ({"body": -2}, "body must be the id"),
        ({"relative": True}, "relative needs a body"),
    ],
)
def test_bad_values_are_refused_with_the_rule(wrong, words):
    with pytest.raises(ValueError, match=words.replace("(", r"\(").replace(".", r"\.")):
        averager(**wrong)


def test_a_bad_value_leaves_the_old_one():
    fields = averager()
    with pytest.raises(ValueError):
        fields.spacing = -1
    assert fields.spacing == 0.25


def test_no_stress_no_pressure():
    disk(0, 0)
    fields = averager(stress=False)
    loop(before_newton=[fields])
    run(1)
    for name in ("totalStress", "contactStress", "kineticStress", "pressure"):
        with pytest.raises(ValueError, match="stress=True"):
            getattr(fields, name)
    assert fields.areaFraction.max() > 0 and fields.stress is False
    fields.stress = True
    run(1)
    assert fields.pressure.shape == (1, 24, 24) and fields.samples.tolist() == [1]  # what is summed has changed


def test_a_body_that_does_not_exist_stops_the_run():
    disk(0, 0)
    loop(before_newton=[averager(body=7)])
    with pytest.raises(RuntimeError, match="body 7 does not exist"):
        O.step()
