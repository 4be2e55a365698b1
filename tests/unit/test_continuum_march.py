"""The continuum solver as a march, on a box of two fluids: steps, signals, checkpoints; and the means of its fields."""

import numpy as np
import pytest

from graindrive.continuum import continuum
from graindrive.base import signals
from graindrive.continuum.continuum import FieldMeans, FlowMarch, centres
from graindrive.engines import TwoPhaseFlow
from graindrive.base.errors import EngineError, Interrupted

N = 12


def sloshing(dt=0.01):
    """A box whose left side is filled higher, so that the fluid flows."""
    fraction = np.zeros((N, N))
    fraction[: N // 2, : N // 2] = fraction[: N // 4] = 1
    box = dict(cells_x=N, cells_y=N, spacing=1.0, largest_viscosity=10.0)
    return TwoPhaseFlow(fraction, None, gravity_y=-1.0, time_step=dt, viscosity="full", **box)


def test_a_march_counts_cells_time_and_the_processor_s_seconds():
    march = FlowMarch(sloshing())
    march.advance(continuum.CHUNK + 3)  # more than one check for signals
    assert march.size == N * N and march.flow.steps == continuum.CHUNK + 3
    assert march.time == pytest.approx(0.01 * (continuum.CHUNK + 3), rel=1e-12)
    assert march.seconds > 0 and np.abs(march.flow.velocity).max() > 1e-3


def test_a_loaded_march_goes_on_with_the_same_bits(tmp_path):
    whole, first, second = (FlowMarch(sloshing()) for _ in range(3))
    whole.advance(30)
    first.advance(17)
    first.save(tmp_path)
    second.load(tmp_path)
    assert second.seconds == first.seconds and second.flow.steps == 17
    second.advance(13)
    one, other = whole.flow.state(), second.flow.state()
    assert all(np.array_equal(one[name], other[name]) for name in one) and second.seconds > first.seconds


def test_a_signal_ends_an_advance_between_chunks(monkeypatch):
    march, calls = FlowMarch(sloshing()), iter(range(100))

    def check():
        if next(calls) == 2:
            raise Interrupted(15)

    monkeypatch.setattr(signals, "check", check)
    with pytest.raises(Interrupted):
        march.advance(10 * continuum.CHUNK)
    assert march.flow.steps == 2 * continuum.CHUNK


def test_a_flow_too_fast_for_its_step_is_an_error_of_the_engine_in_one_line():
    with pytest.raises(EngineError, match="step") as raised:
        FlowMarch(sloshing(dt=3.0)).advance(200)
    assert "\n" not in str(raised.value)


@pytest.mark.parametrize("harm", ["missing", "damaged", "other_grid", "without_an_array"])
def test_a_checkpoint_that_is_not_of_this_flow_is_said_to_be_none(tmp_path, harm):
    FlowMarch(sloshing()).save(tmp_path)
    file = tmp_path / continuum.STATE
    with np.load(file) as stored:
        arrays = dict(stored)
    if harm == "missing":
        file.unlink()
    elif harm == "damaged":
        file.write_bytes(file.read_bytes()[:200])
    elif harm == "other_grid":
        np.savez(file, **{**arrays, "fraction": arrays["fraction"][:-1]})
    else:
        np.savez(file, **{name: array for name, array in arrays.items() if name != "pressure"})
    with pytest.raises(RuntimeError, match=f"{continuum.STATE} does not hold this flow"):
        FlowMarch(sloshing()).load(tmp_path)


def test_centres_are_half_a_cell_from_the_edge():
    assert np.array_equal(centres(-1.0, 0.5, 4), [-0.75, -0.25, 0.25, 0.75])


class Seen:
    """Fields of a flow of two cells at one moment."""

    def __init__(self, fraction, velocity):
        self.fraction, self.pressure = np.array([fraction]), np.array([[2.0, 4.0]])
        self.ill_posed, self.velocity = np.array([[1.0, 0.0]]), np.array([velocity], dtype=float)


def seen_twice():
    """Means over three blocks, the last without a sample; cell 0 fills up, cell 1 stays empty."""
    means = FieldMeans(3, (1, 2))
    means.add(0, Seen([0.25, 0.0], [[4, 0], [9, 9]]))
    means.add(0, Seen([0.75, 0.0], [[0, 8], [9, 9]]))
    means.add(1, Seen([1.0, 0.0], [[3, 1], [9, 9]]))
    return means


def test_means_are_those_of_each_block_and_velocities_are_weighted_with_the_fraction():
    means = seen_twice()
    assert np.array_equal(means.mean("fraction"), [[[0.5, 0]], [[1, 0]], [[np.nan] * 2]], equal_nan=True)
    assert np.array_equal(means.mean("pressure")[:2], [[[2, 4]], [[2, 4]]])
    assert np.array_equal(means.mean("ill_posed")[:2], [[[1, 0]], [[1, 0]]])
    # (0.25 (4, 0) + 0.75 (0, 8))/(0.25 + 0.75) = (1, 6); no velocity in an empty cell
    assert np.array_equal(means.velocity[:2, 0, 0], [[1, 6], [3, 1]])
    assert np.isnan(means.velocity[:, 0, 1]).all() and np.isnan(means.velocity[2]).all()


def test_means_come_back_from_a_checkpoint_and_go_on(tmp_path):
    whole, first, second = seen_twice(), seen_twice(), FieldMeans(3, (1, 2))
    first.save(tmp_path)
    second.load(tmp_path)
    for means in (whole, second):
        means.add(2, Seen([0.5, 0.5], [[1, 1], [2, 2]]))
    assert np.array_equal(second.samples, [2, 1, 1])
    assert all(np.array_equal(second.sums[name], whole.sums[name]) for name in whole.sums)
    assert np.array_equal(second.velocity, whole.velocity, equal_nan=True)
