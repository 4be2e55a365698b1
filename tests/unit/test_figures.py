"""What all figures share: numbers with errors, running means, legends off the data, titles, colour bars, bodies that spin."""

import numpy as np
import pytest
from free_legends import hidden
from hypothesis import given, strategies as st

from graindrive.base.numbers import with_error
from graindrive.postproc import figures, legends
from graindrive.postproc.figures import plt
from graindrive.postproc.measured import Measured
from graindrive.postproc.running import draw_convergence, running, running_mean, running_ratio
from graindrive.postproc.statistics import block_mean, ratio_mean

# ---- numbers with errors ----


@pytest.mark.parametrize(
    "value, error, words",
    [
        (10.94, 4.04, "10.9 ± 4.0"),
        (0.01234, 0.0005, "0.01234 ± 0.00050"),
        (-3.2, 0.4, "−3.20 ± 0.40"),
        (10.0, 9.96, "10 ± 10"),  # the error is rounded up to another digit
        (1234.0, 123.0, "1230 ± 120"),
        (-0.001, 0.2, "0.00 ± 0.20"),  # no minus sign before zero
        (1.23e-6, 4.5e-7, "(1.23 ± 0.45) × 10⁻⁶"),
        (2.5e8, 1e7, "(2.50 ± 0.10) × 10⁸"),
        (0.0, 0.0123, "0.000 ± 0.012"),
        (1.5, 0, "1.5"),
        (1.0, 1e-15, "1"),
        (1.5, float("nan"), "1.5 (error unknown)"),
        (1.5, None, "1.5 (error unknown)"),
        (float("nan"), 1.0, "no data"),
    ],
)
def test_a_number_is_rounded_as_its_error(value, error, words):
    assert with_error(value, error) == words


@given(st.floats(-1e5, 1e5), st.floats(1e-2, 1e5))
def test_no_number_loses_more_than_half_of_its_errors_last_digit(value, error):
    words = with_error(value, error).replace("−", "-")
    if "±" not in words:
        assert error <= 1e-9 * abs(value)
        return
    shown, of_error = (float(part) for part in words.split(" ± "))
    assert of_error == pytest.approx(error, rel=0.05)  # two digits: at most half of the last of 1.0
    assert abs(shown - value) <= 0.05 * of_error * (1 + 1e-9)
    decimals = [len(part.partition(".")[2]) for part in words.split(" ± ")]
    assert decimals[0] == decimals[1]


def test_a_measured_number_is_written_the_same_way():
    assert str(Measured(10.94, 4.04)) == with_error(10.94, 4.04)


# ---- running means ----


def test_a_running_mean_of_white_noise_has_its_mean_and_its_error():
    """The mean of n independent samples of unit variance has the error 1/√n; blocking of white noise finds it within 1/√(2n)."""
    samples = np.random.default_rng(5).normal(3.0, 1.0, 4096)
    found = running_mean(samples)
    assert found.ends[0] == 16 and found.ends[-1] == 4096 and np.all(np.diff(found.ends) > 0)
    assert found.values == pytest.approx([samples[:n].mean() for n in found.ends], rel=1e-12)
    late = found.ends > 400  # 1/√(2n) is 4 %; five of these, because blocking chooses some levels by chance
    assert found.errors[late] * np.sqrt(found.ends[late]) == pytest.approx(np.ones(late.sum()), rel=0.3)
    assert np.all(np.abs(found.values - 3) < 5 / np.sqrt(found.ends)) and found.resolved


def test_a_running_mean_ends_at_the_mean_and_a_drift_is_seen():
    ramp = np.arange(1000.0)
    found = running_mean(ramp)
    assert found.values == pytest.approx((found.ends - 1) / 2)  # of 0 … n − 1
    assert (found.values[-1], found.errors[-1]) == (block_mean(ramp).value, block_mean(ramp).error)
    assert not found.resolved and found.named("V = {}").endswith("(error unresolved)")


def test_a_running_ratio_is_that_of_the_means():
    rng = np.random.default_rng(6)
    drag = rng.uniform(1, 3, 500)
    lift = 0.3 * drag + rng.normal(0, 0.1, 500)
    found = running_ratio(lift, drag)
    exact = ratio_mean(lift, drag)
    assert (found.values[-1], found.errors[-1]) == (exact.value, exact.error)
    assert found.values[3] == pytest.approx(lift[: found.ends[3]].mean() / drag[: found.ends[3]].mean(), rel=1e-12)
    assert running_ratio(0.5 * drag, drag).errors == pytest.approx(0, abs=0)


def test_too_short_a_series_has_what_there_is():
    assert len(running_mean(np.zeros(0)).values) == 0 and str(running_mean(np.zeros(0))) == "no data"
    assert list(running(lambda n: Measured(n, 1.0), 3, fewest=2).values) == [2, 3]
    figure, axes = plt.subplots()
    draw_convergence(axes, [], running_mean(np.zeros(0)), colour="k", label="V = {}")
    assert axes.lines[0].get_label() == "V = no data"
    plt.close(figure)


def test_a_panel_of_convergence_shows_its_late_part():
    """The first values, from few samples, do not determine the range: it follows from the others with their errors."""
    samples = np.r_[np.full(40, 100.0), np.random.default_rng(7).normal(0, 1, 20000)]
    found = running_mean(samples)
    figure, axes = plt.subplots()
    draw_convergence(axes, found.ends, found, colour="k")
    assert axes.get_ylim()[1] < 10 < found.values[0]
    plt.close(figure)


# ---- legends ----


def lines(axes):
    for k in range(3):
        axes.plot(np.linspace(0, 1, 300), np.sin(40 * np.linspace(0, 1, 300) + k), label=f"line {k}")


def bars(axes):
    axes.errorbar(np.linspace(0.01, 1, 30), np.exp(np.linspace(0, 5, 30)), 0.5, fmt="o", label="points")
    axes.set(xscale="log", yscale="log")


def band(axes):
    axes.fill_between([0, 1, 2, 3], [0, 1, 0, 1], [3, 4, 3, 4], label="a band that fills the panel")
    axes.axhline(2)


def many(axes):
    for k in range(9):
        axes.plot([0, 1], [k, 9 - k], label=f"line {k} of nine that cross each other")


def long_way(axes):
    axes.plot([-5, 5], [-50, 50], label="its ends lie outside of the panel")
    axes.set(xlim=(0, 1), ylim=(0, 10))


def holes(axes):
    y = np.where(np.arange(300) % 7 == 3, np.nan, np.sin(np.arange(300)))
    axes.plot(np.arange(300), y, label="numbers that are none")


def small(axes):
    axes.plot([0, 1], [0, 0], label="a label so long that no panel of this size has room for it " * 2)


@pytest.mark.parametrize("draw", [lines, bars, band, many, long_way, holes, small])
@pytest.mark.parametrize("place", ["best", "lower right"])
def test_no_legend_lies_over_data(draw, place):
    with plt.rc_context(figures.STYLE):
        figure, axes = plt.subplots(1, 2, figsize=(6.8, 2.2), layout="constrained")
        draw(axes[0])
        axes[0].legend(loc=place)
        legends.settle(figure)
        assert draw is small or hidden(figure) == []
        assert axes[0].get_window_extent().width > (0 if draw in (many, small) else 200)
    plt.close(figure)


def test_the_pixels_see_a_legend_over_data():
    """The check of legends detects one that was not moved off the curve."""
    figure, axes = plt.subplots()
    lines(axes)
    axes.legend(loc="upper right")
    assert len(hidden(figure)) == 1
    plt.close(figure)


def test_a_range_that_panels_share_stays_one():
    figure, (left, right) = plt.subplots(1, 2, sharey=True, layout="constrained")
    lines(left)
    right.plot([0, 1], [0, 1])
    left.legend()
    legends.settle(figure)
    assert left.get_ylim() == right.get_ylim() and left.get_ylim()[1] > 1.1
    plt.close(figure)


# ---- titles, colour bars, bodies ----


def test_a_long_title_has_lines_that_fit():
    figure = plt.figure(figsize=(3.4, 2))
    parts = ["tall rectangle", "$A$ = 3 $d$", "", "$T$ = 4", "friction 0.5", "a channel of 300 d × 200 d", "seed 7"]
    figures.set_title(figure, parts)
    text = figure._suptitle.get_text()
    assert text.replace("\n", " ") == ", ".join(filter(None, parts)) and text.count("\n") == 1
    assert figure._suptitle.get_window_extent().width <= figure.bbox.width
    plt.close(figure)


@pytest.mark.parametrize("aspect", ["auto", "equal"])
def test_a_colour_bar_is_as_tall_as_its_panel(aspect):
    figure, axes = plt.subplots(figsize=(4, 4), layout="constrained")
    bar = figures.colour_bar(axes, axes.pcolormesh(np.arange(200.0).reshape(5, 40)), "values")
    axes.set_aspect(aspect)
    figure.canvas.draw()
    panel, beside = axes.get_window_extent(), bar.ax.get_window_extent()
    assert (beside.y0, beside.y1) == pytest.approx((panel.y0, panel.y1)) and beside.x0 > panel.x1
    assert bar.ax.get_tightbbox(figure.canvas.get_renderer()).x1 <= figure.bbox.width
    plt.close(figure)


@pytest.mark.parametrize("spin", [2.0, -2.0, 0.0])
def test_a_disk_has_a_mark_at_its_angle_and_an_arrow_the_way_it_spins(spin):
    figure, axes = plt.subplots()
    figures.draw_disk(axes, (1.0, 2.0), 3.0, angle=0.5, spin=spin)
    mark, *arrow = axes.lines
    assert mark.get_xydata()[-1] == pytest.approx([1 + 3 * np.cos(0.5), 2 + 3 * np.sin(0.5)])
    assert len(arrow) == (spin != 0)
    if spin:
        x, y = (arrow[0].get_xydata() - [1.0, 2.0]).T
        assert np.all((x[:-1] * np.diff(y) - y[:-1] * np.diff(x)) * spin > 0)
    plt.close(figure)
