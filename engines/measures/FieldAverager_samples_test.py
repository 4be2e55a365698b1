"""FieldAverager: phases and statistics, a bed at rest, save and load, bad input."""

import math

import numpy as np
import pytest
from disks import EPS, disk, engine, hertz, loop, new_scene, run
from field_scenes import FIELDS, LENGTH, averager, crowd, fields_of
from graindrive.loops import grain_loop
from yade import O


@pytest.fixture(autouse=True)
def scene():
    new_scene(dt=1e-4)
    yield
    O.reset()


# ---- phases and statistics ----


def test_samples_go_to_their_phase():
    body = disk(0, 0)
    O.bodies[body].state.blockedDOFs = "zXY"
    period, phases, steps = 0.02, 4, 1000  # 200 steps a period, 50 a phase
    fields = averager(kernel="diskBin", spacing=6, phases=phases, period=period, phaseStart=0.005)
    loop(before_newton=[fields])
    for step in range(steps):
        # The velocity shows the time of the sample.
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
    crowd(origin=(4, 4, 0))
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
    # The field at y is a mean with the weight exp(-(y - y')^2/w^2); the same mean is taken of the weight above.
    above = [(weight * [0.5 + 0.5 * math.erf(h - y) for h in height]).sum() / width for y in fields.y]
    sideways = fields.totalStress[0, :, :, 1, 1].mean(axis=1)
    np.testing.assert_allclose(sideways, above, rtol=0.02)
    assert above[0] > 2 * above[-1]


# ---- save, load, bad input ----


@pytest.mark.parametrize("loops", ["yade", "grain"])
def test_save_and_load_go_on_averaging(loops, tmp_path):
    crowd(origin=(4, 4, 0), phases=2, period=1e-3)
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


@pytest.mark.parametrize(
    "change, shape",
    [({"spacing": 0.5}, (1, 12, 12)), ({"kernel": "sphere"}, (1, 24, 24)), ({"high": (3.5, 3, 0)}, (1, 24, 26))]
    + [({key: value}, (1, 24, 24)) for key, value in dict(width=0.7, cutoff=2, stress=False).items()],
)
def test_changing_what_decides_the_fields_begins_anew(change, shape):
    disk(0, 0)
    fields = averager()
    loop(before_newton=[fields])
    run(3)
    for name, value in change.items():
        setattr(fields, name, value)
    assert fields.areaFraction.shape == shape and np.isnan(fields.areaFraction).all()
    assert fields.samples.tolist() == [0]
    run(2)
    assert fields.samples.tolist() == [2] and not np.isnan(fields.areaFraction).any()


def test_a_fixed_origin_may_be_moved_while_it_averages():
    disk(1, 0, velocity=(1000, 0))  # 0.1 a step
    fields = averager(kernel="diskBin")
    loop(before_newton=[fields])
    for step in range(10):
        fields.origin = (0.1 * step, 0, 0)
        run(1)
    assert fields.samples.tolist() == [10]
    # The grain is at rest in this window: it fills the same bins, by the same amounts, as in one frame.
    assert (fields.areaFraction * fields.x).sum() / fields.areaFraction.sum() == pytest.approx(1, abs=1e-12)
    assert fields.areaFraction.max() == pytest.approx(1, abs=1e-12)


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
        ({"origin": (math.nan, 0, 0)}, "FieldAverager.origin must be finite, got nan"),
        ({"high": (3, math.inf, 0)}, "FieldAverager.high must be finite, got"),
        ({"kernel": "sphere", "width": 0.17, "spacing": 0.25}, "at least 0.71 spacing"),
        ({"kernel": "gaussian", "width": 1e-3, "spacing": 0.25}, "reach, got 0.00"),
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
    with pytest.raises(ValueError, match="spacing must be positive and finite, got -1"):
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
    assert fields.pressure.shape == (1, 24, 24) and fields.samples.tolist() == [
        1
    ]  # the settings of the sums have changed


def test_a_body_that_does_not_exist_stops_the_run():
    disk(0, 0)
    loop(before_newton=[averager(body=7)])
    with pytest.raises(RuntimeError, match="body 7 does not exist"):
        O.step()
