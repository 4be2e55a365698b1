"""The figure of one drum run: grains with their free surface, velocities, u(z), angle over turn, running means."""

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.patches import Circle

from ..figures import (
    BLACK,
    BLUE,
    COLUMN_WIDTH,
    GREEN,
    GREY,
    STYLE,
    VERMILLION,
    colour_bar,
    draw_grains,
    save,
    set_title,
)
from ..measured import Measured
from ..reader import BEAD, Run
from ..running import draw_running, running
from .blocks import models_in, read, steady_flow
from .flow import analysed

ARROWS = 4.8  # d, edge of the squares of the paper's Fig. 2
NAMES = {"dem": "grains", "continuum": "continuum"}
AVERAGES = (("surface_angle_deg", "angle of the surface\n[degrees]"), ("thickness_over_diameter", "thickness $h/D$"))
RUNNING_POINTS = 8  # of a running mean: every one is the whole analysis, as often as it has blocks
LOOKS = {"dem": dict(color=BLUE, marker="o"), "continuum": dict(color=VERMILLION, marker="s")}


def draw(path, frame=-1):
    """Draw figure.png and figure.pdf of the run folder `path` from its data alone."""
    run = Run(path)
    p = run.parameters
    blocks = {model: read(run, model) for model in models_in(run)}
    fields = {model: some.mean().within(p["drum_diameter"]) for model, some in blocks.items()}
    found = {model: analysed(field, p["drum_diameter"], p["angular_velocity"]) for model, field in fields.items()}
    with plt.rc_context(STYLE):
        figure, axes = plt.subplots(
            3, 2, figsize=(2 * COLUMN_WIDTH, 7.4), height_ratios=[1.25, 1, 0.75], layout="constrained"
        )
        set_title(figure, title(run))
        draw_bed(axes[0, 0], run, frame, fields, found)
        draw_maps(axes[0, 1], run, fields, found)
        draw_profiles(axes[1, 0], run, found)
        draw_history(axes[1, 1], run, found)
        draw_averages(axes[2], p, blocks)
        for letter, panel in zip("abcdef", axes.flat):
            panel.set_title(f"({letter})", loc="left")
        save(figure, path)


def title(run):
    """Return in words which drum turned how fast, by which seed, and what came out: the parts of a title."""
    p, found = run.parameters, run.summary
    parts = [
        rf"$D$ = {p['drum_diameter']:g} $d$",
        rf"$\Omega$ = {p['angular_velocity']:.3g} $\sqrt{{g/d}}$",
        f"Fr = {p['froude']:.3g}",
        f"seed {p['seed']}" if "seed" in p and p.get("model") != "continuum" else "",
    ]
    for name, symbol, scale in (
        ("surface_angle_deg", r"$\theta$ = {} °", 1),
        ("thickness_over_diameter", "$h/D$ = {}", 1),
        ("dem_continuum_difference", "difference {} %", 100),
    ):
        if found.get(name) is not None:
            parts.append(symbol.format(Measured(scale * found[name], scale * (found.get(f"{name}_err") or 0.0))))
    return parts


def draw_bed(axes, run, frame, fields, found):
    """Grains of a frame by their speed, or the speed of the field where there are no frames, with the free surface."""
    p = run.parameters
    scale, radius = p["angular_velocity"] * p["drum_diameter"], p["drum_diameter"] / 2
    limits = dict(cmap="viridis", clim=(0, speed_limit(found, scale)))
    if run.frame_names:
        seen = run.frame(frame)
        mesh = draw_grains(axes, *(seen.grains[name] for name in "xyr"), values=seen.speed / scale, **limits)
        disks = seen.disks()
        wall = disks["role"] == BEAD
        draw_grains(axes, *(disks[name][wall] for name in "xyr"), colour=BLACK)
    else:
        field = next(iter(fields.values()))
        speed = np.hypot(field.velocity_x, field.velocity_y) / scale
        shown = np.ma.masked_where(~(field.fraction > field.surface_level / 2), speed)
        mesh = axes.pcolormesh(field.x, field.y, shown, shading="nearest", rasterized=True, **limits)
        axes.add_patch(Circle((0, 0), radius, facecolor="none", edgecolor=BLACK, linewidth=0.8))
    colour_bar(axes, mesh, r"$|\mathbf{v}|/\Omega D$", extend="max")
    for model, one in found.items():
        draw_surface(axes, one.surface, fields[model], radius, LOOKS[model]["color"])
    frame_drum(axes, radius)


def speed_limit(found, scale):
    """Return the end of the scale of speeds: the fastest profile's largest u, over Omega D; at least the wall's 1/2."""
    fastest = [np.nanmax(one.profile.u) / scale for one in found.values() if np.isfinite(one.profile.u).any()]
    return max([0.5, *fastest])


def draw_surface(axes, surface, field, radius, colour):
    """Where the fraction falls to the surface's level, and the line that gives its angle."""
    draw_level(axes, field, radius, colour)
    if len(surface.x):
        x = np.array([surface.x.min(), surface.x.max()])
        axes.plot(x, surface.height + np.tan(surface.angle) * x, color=BLACK, linewidth=1.2)


def draw_level(axes, field, radius, colour):
    """Where the fraction falls to the surface's level."""
    cell = field.x[1] - field.x[0]  # of a continuum the last two before the wall belong to it
    beside_the_wall = np.hypot(field.x[None, :], field.y[:, None]) > 0.97 * radius - 1 - 2 * cell
    fraction = np.ma.masked_where(beside_the_wall, field.fraction)
    if fraction.count() and fraction.min() < field.surface_level < fraction.max():
        axes.contour(field.x, field.y, fraction, [field.surface_level], colors=[colour], linewidths=0.8)


def frame_drum(axes, radius):
    """Show the whole drum, true to scale."""
    axes.set(aspect="equal", xlim=(-1.04 * radius, 1.04 * radius), ylim=(-1.04 * radius, 0.75 * radius))
    axes.set(xlabel="$X$  [$d$]", ylabel="$Y$  [$d$]")


def draw_maps(axes, run, fields, found):
    """Mean velocities in squares of 4.8 d, or of a thirtieth of a larger drum, as arrows (Fig. 2); ill-posed parts in grey."""
    p = run.parameters
    radius = p["drum_diameter"] / 2
    edge = max(ARROWS * min(1, radius / 40), radius / 16)
    axes.add_patch(Circle((0, 0), radius, facecolor="none", edgecolor=BLACK, linewidth=0.8))
    if "continuum" in fields and "ill_posed" in run.group("fields/continuum"):
        draw_ill_posed(axes, run)
    for model, field in fields.items():
        x, y, v_x, v_y = in_squares(field, edge)
        colour = LOOKS[model]["color"]
        scale = 0.25 * p["angular_velocity"] * p["drum_diameter"] / edge
        style = dict(angles="xy", scale_units="xy", scale=scale, color=colour, width=0.0035, pivot="tail")
        axes.quiver(x, y, v_x, v_y, **style)
        draw_surface(axes, found[model].surface, field, radius, colour)
    frame_drum(axes, radius)


def draw_ill_posed(axes, run):
    """Shade in grey where the continuum's equations were ill-posed, the darker the larger a share of the time."""
    x, y, share = ill_posed_map(run)
    shown = np.ma.masked_invalid(np.where(share > 0, share, np.nan))
    axes.pcolormesh(x, y, shown, shading="nearest", rasterized=True, cmap="Greys", vmin=0, vmax=2, zorder=0)
    told = run.summary.get("ill_posed_share")
    if told is not None:
        text = f"grey: equations ill-posed, {100 * told:.0f} % of the grains' area"
        axes.set_title(text, loc="right", fontsize=6)


def ill_posed_map(run):
    """Return x, y, and the share of the time (ny, nx) in which the continuum was ill-posed, nan outside of its bed."""
    stored = run.group("fields/continuum")
    share = np.average(np.nan_to_num(stored["ill_posed"]), axis=0, weights=stored["samples"])
    bed = read(run, "continuum").mean().fraction > 0
    return stored["x"], stored["y"], np.where(bed, share, np.nan)


def in_squares(field, edge):
    """Return x, y, v_x, v_y of the mean velocity in squares of about that edge that are full to half of the surface's level."""
    spacing = field.x[1] - field.x[0]
    n = max(1, round(edge / spacing))
    rows, columns = len(field.y) // n, len(field.x) // n

    def mean(values):
        return values[: rows * n, : columns * n].reshape(rows, n, columns, n).mean(axis=(1, 3))

    fraction, (flux_x, flux_y) = mean(field.fraction), (mean(flux) for flux in field.fluxes)
    x, y = (axis[: k * n].reshape(k, n).mean(axis=1) for axis, k in ((field.x, columns), (field.y, rows)))
    kept = fraction > field.surface_level / 2
    x, y = np.meshgrid(x, y)
    return x[kept], y[kept], flux_x[kept] / fraction[kept], flux_y[kept] / fraction[kept]


def draw_profiles(axes, run, found):
    """u/(Omega D) against z/D of each model, with rigid rotation and h (Fig. 3)."""
    p = run.parameters
    diameter, scale = p["drum_diameter"], p["angular_velocity"] * p["drum_diameter"]
    for model, one in found.items():
        stored = run.group(f"depth/{model}")
        error = stored["u_err"] if "u_err" in stored else np.full(len(one.profile.z), np.nan)
        style = dict(LOOKS[model], markersize=2.2, linewidth=0, elinewidth=0.5, label=NAMES[model])
        kept = np.isfinite(one.profile.u) & (one.profile.z < diameter / 2)
        errors = np.nan_to_num(error[kept]) / scale
        axes.errorbar(one.profile.z[kept] / diameter, one.profile.u[kept] / scale, errors, **style)
        axes.axvline(one.numbers["thickness_over_diameter"], color=LOOKS[model]["color"], linewidth=0.6, linestyle=":")
    axes.plot([0, 0.5], [0, -0.5], color=BLACK, linewidth=0.8, label=r"rigid rotation, $-\Omega z$")
    axes.axhline(0, color=GREY, linewidth=0.6)
    axes.set(xlabel="$z/D$, depth below the axis", ylabel=r"$u/\Omega D$", xlim=(-0.1, 0.5))
    axes.legend()


def draw_history(axes, run, found):
    """The angle of the grains' centre of mass over the drum's turn; of a continuum alone, its fraction across the layer."""
    if "turn" in run.series:
        turn, start = run.series["turn"], run.summary.get("averaged_from")
        axes.plot(turn, run.series["centre_angle"], color=GREEN, label="centre of mass")
        if start is not None and len(turn):
            axes.axvspan(start, turn[-1], color=GREY, alpha=0.3, linewidth=0)
        for model, one in found.items():
            angle = one.numbers["surface_angle_deg"]
            axes.axhline(angle, color=LOOKS[model]["color"], linewidth=0.8, label=f"surface, {NAMES[model]}")
        axes.set(xlabel="turn of the drum  [degrees]", ylabel="angle  [degrees]", ylim=(0, None))
    else:
        for model, one in found.items():
            z = one.profile.z / run.parameters["drum_diameter"]
            axes.plot(z, one.profile.fraction, color=LOOKS[model]["color"], label=NAMES[model])
        axes.set(xlabel="$z/D$, depth below the axis", ylabel="fraction", xlim=(-0.1, 0.5))
    axes.legend()


def draw_averages(panels, p, blocks):
    """The surface's angle and h/D over the first blocks in time, against how many they are: are they converged?"""
    for model, some in blocks.items():
        flows = {}

        def number(name, n):
            if n not in flows:
                flows[n] = steady_flow(some.first(n), p["drum_diameter"], p["angular_velocity"])
            summary = flows[n].summary
            return Measured(summary[name], summary[f"{name}_err"])

        for panel, (name, _) in zip(panels, AVERAGES):
            found = running(lambda n: number(name, n), len(some), fewest=2, points=RUNNING_POINTS)
            draw_running(panel, found.ends, found, colour=LOOKS[model]["color"], label=f"{NAMES[model]}: {{}}")
    for panel, (_, label) in zip(panels, AVERAGES):
        panel.set(xlabel="blocks in time averaged", ylabel=label)
        panel.xaxis.get_major_locator().set_params(integer=True)
        panel.legend()
