"""The figure of the wiggle study: height over time, rise rate as it converges and by phase, the bed, fields if measured."""

from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.colors import PowerNorm

from ..drift import drift, phase_rates
from ..figures import BLACK, BLUE, COLUMN_WIDTH, GREY, PURPLE, STYLE, VERMILLION, colour_bar, draw_body, draw_chains
from ..figures import draw_disk, draw_grains, save, set_title
from ..measured import Measured
from ..reader import BASE, GRAIN, INTRUDER, Run
from ..running import draw_convergence, running_mean
from . import around

VIEW = np.array([80.0, 60.0])  # d, width and height; of a larger bed the part around the intruder is shown
NAMES = {"disk": "disk", "square": "square", "tall": "tall rectangle", "wide": "wide rectangle", "triangle": "triangle"}
TURNS = {
    "displacement": (0.25, 0.75),
    "velocity": (0.0, 0.5),
}  # phases t/T at which the body turns, by the drive's form


def draw(path, frame=-1):
    """Draw figure.png and figure.pdf of the run folder `path` from its data alone; `frame` chooses the picture."""
    run = Run(path)
    with plt.rc_context(STYLE):
        bed, seen = run.frame(frame) if run.frame_names else None, around.fields_of(run)
        box = view(run, bed) if bed else None
        heights = [1.7, 1.1, 1.2] + ([0.6 + 2.55 * box[1, 1] / box[1, 0]] if bed else [])
        columns = [COLUMN_WIDTH] + ([around.WIDTH] if seen else [])
        figure = plt.figure(figsize=(sum(columns), 0.2 + sum(heights)), layout="constrained")
        set_title(figure, title(run))
        parts = np.atleast_1d(figure.subfigures(1, len(columns), width_ratios=columns))
        panels = list(parts[0].subplots(len(heights), 1, height_ratios=heights))
        draw_height(panels[0], run)
        draw_rates(panels[1], run)
        draw_phases(panels[2], run)
        if bed:
            colour_bar(panels[3], draw_bed(panels[3], run, bed, box), r"speed  [$\sqrt{gd}$]", extend="max")
        if seen:
            panels.append(around.draw(parts[1], run, seen))
        for letter, panel in zip("abcde", panels):
            panel.set_title(f"({letter})", loc="left")
        save(figure, path)


def draw_height(axes, run):
    """Height over its start against time, cycle means, the line of the fitted rise rate, and the drive's period."""
    t, y = run.series["t"], run.series["y"] - run.series["y"][:1]
    period = float(run.parameters["period"])
    axes.plot(t, y, color="#888888", linewidth=0.6, label="intruder")
    found = drift(t, y, period)
    axes.plot(found.cycle_t, found.cycle_y, color=BLUE, label="mean of a cycle")
    if np.isfinite(found.rate):
        draw_rate(axes, found)
    axes.margins(x=0)
    axes.set(xlabel=r"$t$  [$\sqrt{d/g}$]", ylabel=r"$y - y_0$  [$d$]")
    axes.legend()
    draw_period(axes, period)


def draw_rates(axes, run):
    """The rise rate over the first cycles that count, against how many they are: is it converged?"""
    period = float(run.parameters["period"])
    found = drift(run.series["t"], run.series["y"], period)
    steps = np.diff(found.cycle_y[averaged(found)]) / period
    axes.set(xlabel=r"averaged to $t$  [$\sqrt{d/g}$]", ylabel=r"mean $V_y$  [$\sqrt{gd}$]")
    if not np.isfinite(found.rate):
        say_too_short(axes)
        return
    rates = running_mean(steps, fewest=2)
    ends = found.start + period * (1 + rates.ends)
    draw_convergence(
        axes, ends, rates, colour=VERMILLION, marker="." if len(steps) < 20 else None, label=r"$V_y$ = {} $\sqrt{gd}$"
    )
    axes.legend()


def averaged(found):
    """Return which cycles a `Drift` averages, (cycles,)."""
    return (found.cycle_t >= found.start) & (found.cycle_t <= found.end)


def say_too_short(axes):
    """Say in a panel that the run holds too few cycles for a mean."""
    words = "fewer than two whole cycles\nafter the first tenth of the run"
    axes.text(0.5, 0.5, words, transform=axes.transAxes, ha="center", va="center")
    axes.set_yticks([])


def draw_phases(axes, run):
    """Rise rate by phase of the cycle with its standard error; dashed, where the body turns."""
    t, y, period = run.series["t"], run.series["y"], float(run.parameters["period"])
    found = drift(t, y, period)
    phases, rates, errors = phase_rates(t, y, period, found.start, found.end)
    if np.isfinite(rates).any():
        axes.errorbar(phases, rates, np.nan_to_num(errors), fmt="o-", color=BLUE, markersize=2, elinewidth=0.6)
    else:
        say_too_short(axes)
    axes.axhline(0, color=GREY, linewidth=0.5, zorder=0)
    for turn in TURNS[run.parameters.get("drive", "displacement")] if np.isfinite(rates).any() else ():
        axes.axvline(turn, color=GREY, linewidth=0.5, linestyle=(0, (4, 2)), zorder=0)
    axes.set(xlim=(0, 1), xlabel=r"phase $t/T$", ylabel=r"$V_y$  [$\sqrt{gd}$]")


def title(run):
    """Return in words what shape is driven how, and by which seed: the parts of a title."""
    p = run.parameters
    shape = str(p.get("shape", "intruder"))
    unit = "$d$" if p.get("drive", "displacement") == "displacement" else r"$\sqrt{gd}$, of the velocity"
    return [
        NAMES.get(shape, Path(shape).stem).replace("$", r"\$"),
        rf"$A$ = {p['amplitude']:g} {unit}",
        rf"$T$ = {p['period']:g} $\sqrt{{d/g}}$",
        rf"$\mu$ = {p['mu']:g}" if "mu" in p else "",
        f"seed {p['seed']}" if "seed" in p else "",
    ]


def draw_rate(axes, found):
    """Line between the middles of the average's first and last cycle, whose slope is the rise rate, named with its error."""
    inside = averaged(found)
    label = rf"$V_y$ = {Measured(found.rate, found.error)} $\sqrt{{gd}}$"
    middles, means = (column[inside][[0, -1]] for column in (found.cycle_t, found.cycle_y))
    axes.plot(middles, means, color=VERMILLION, linestyle=(0, (4, 2)), linewidth=1.2, label=label)


def draw_period(axes, period):
    """Mark the drive's period, or ten or more of them where one is too short to see, as a bar above the panel."""
    left, right = axes.get_xlim()
    periods = next((n for n in (1, 10, 100) if n * period > 0.05 * (right - left)), 1000)
    above = axes.get_xaxis_transform()
    axes.plot(
        [right - periods * period, right], [1.06, 1.06], color=BLACK, linewidth=1.5, transform=above, clip_on=False
    )
    text = r"$T$" if periods == 1 else rf"{periods} $T$"
    axes.text(
        right - periods * period - 0.01 * (right - left),
        1.06,
        text,
        transform=above,
        ha="right",
        va="center",
        fontsize=7,
    )


def view(run, bed):
    """Return [[left, bottom], [width, height]] of the picture: the whole bed, or `VIEW` around the intruder."""
    x, y = run.at(bed.t, "x", "y")
    bottom = np.min(bed.grains["y"] - bed.grains["r"]) - 0.5
    top = np.quantile(bed.grains["y"] + bed.grains["r"], 0.98) + 3  # a few grains may fly
    width = min(VIEW[0], float(run.parameters["width"]))
    size = np.array([width, min(VIEW[1], top - bottom, 1.3 * width)])
    left = x - size[0] / 2 if size[0] < float(run.parameters["width"]) else 0.0
    return np.array([[left, np.clip(y - size[1] / 2, bottom, top - size[1])], size])


def draw_bed(axes, run, bed, box, norm=None):
    """Grains coloured by speed, force chains as lines as wide as their normal force, base in grey, intruder outlined.

    `box` is from `view`, `norm` the scale of colours if not this frame's own; returns the circles, for a colour bar.
    """
    x, y, r = (np.asarray(bed.grains[name], dtype=float) for name in ("x", "y", "r"))
    (left, bottom), (width, height) = box
    period_x = float(run.parameters["width"])
    x = left + np.mod(x - left, period_x)
    shown = (x < left + width + 1) & (np.abs(y - bottom - height / 2) < height / 2 + 1)
    grains, base = shown & (bed.role == GRAIN), shown & (bed.role == BASE)
    speeds = bed.speed
    norm = norm or speed_scale([speeds[grains]])
    circles = draw_grains(axes, x[grains], y[grains], r[grains], values=speeds[grains], cmap="YlGnBu", norm=norm)
    draw_grains(axes, x[base], y[base], r[base], colour=GREY)
    draw_forces(axes, bed, x, y, period_x, shown, widest=0.35 * 72 * 2.55 / width)
    draw_intruder(axes, *body_now(run, bed, left, period_x))
    axes.set(xlim=(left, left + width), ylim=(bottom, bottom + height), aspect="equal")
    axes.set(xlabel=r"$x$  [$d$]", ylabel=r"$y$  [$d$]")
    axes.set_title(rf"$t$ = {bed.t:.4g} $\sqrt{{d/g}}$")
    return circles


def speed_scale(speeds):
    """Return the scale of colours for speeds, arrays of one or many frames; a few fast grains do not spoil it."""
    fast = np.quantile(np.concatenate(speeds), 0.995) if sum(map(len, speeds)) else 0
    return PowerNorm(0.5, 0, fast if fast > 1e-12 else 1)  # a bed at rest has no scale of its own


def draw_forces(axes, bed, x, y, period_x, shown, widest):
    """Lines between the centres of touching disks, those that pull each other in another colour.

    `x`, `y` are the grains' places in the picture. A line begins at the grain that is in it, at the other side's the body.
    """
    c = bed.contacts
    if not c or len(c["fn"]) == 0:
        return
    i, j = (np.asarray(c[name], dtype=int) for name in ("i", "j"))
    first = i != INTRUDER  # the side that is a grain
    start, end = (np.where(first[:, None], *ends) for ends in zip(bed.contact_ends(), bed.contact_ends()[::-1]))
    grain = np.where(first, i, j)
    reach = end - start
    reach[:, 0] -= period_x * np.round(reach[:, 0] / period_x)
    start, end = np.column_stack([x, y])[grain], np.column_stack([x, y])[grain] + reach
    near = shown[grain]
    draw_chains(axes, start[near], end[near], c["fn"][near], colour=VERMILLION, pulling=PURPLE, widest=widest)


def body_now(run, bed, left, period_x):
    """Return the intruder's arrays with beads and outline where they are in the picture, and its centre (2,)."""
    body = run.group("intruder")
    centre = np.array(bed.intruder.get("centre", run.at(bed.t, "x", "y")))
    winds = np.array([np.floor((centre[0] - left) / period_x) * period_x, 0])
    parts = {name: body[name] for name in ("beads", "outline") if name in body}
    if len(bed.intruder.get("x", ())):
        places = {name: bed.place(points, body["beads"]) for name, points in parts.items()}
    else:
        places = {name: points + centre for name, points in parts.items()}
    return {**body, **{name: points - winds for name, points in places.items()}}, centre - winds


def draw_intruder(axes, intruder, centre):
    """The intruder as a white body with its beads and a bold outline, a disk as one; a cross where its shape was not stored."""
    if "beads" in intruder:
        beads, radius = intruder["beads"], float(np.atleast_1d(intruder["bead_radius"])[0])
        if len(beads) == 1:
            draw_disk(axes, beads[0], radius)
        else:
            draw_body(axes, intruder.get("outline", beads))
            draw_grains(axes, beads[:, 0], beads[:, 1], np.full(len(beads), radius), colour=BLACK, zorder=4)
    axes.plot(*centre, "+", zorder=5, color=BLACK, markersize=4, markeredgewidth=0.8)
