"""The figure of one lift run: forces over travel, stress by angle, profile of the bed, and the fields around the body."""

from dataclasses import replace

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.patches import Polygon

from .. import fields
from ..figures import BLACK, BLUE, COLUMN_WIDTH, GREY, STYLE, VERMILLION, save
from ..measured import Measured
from ..reader import Run, RunError


def draw(path, frame=-1):
    """Draw figure.png and figure.pdf of the run folder `path` from its data alone."""
    run = Run(path)
    around = fields_of(run)
    with plt.rc_context(STYLE):
        columns = [1.0, 0.62] if around else [1.0]  # maps are square
        figure = plt.figure(figsize=(COLUMN_WIDTH * sum(columns), 5.4), layout="constrained")
        figure.suptitle(title(run), fontsize=8)
        parts = np.atleast_1d(figure.subfigures(1, len(columns), width_ratios=columns))
        panels = list(parts[0].subplots(3, 1, height_ratios=[1.3, 1.3, 0.8]))
        draw_forces(panels[0], run)
        draw_stress(panels[1], run)
        draw_profile(panels[2], run)
        if around:
            panels += draw_fields(parts[1], run, around)
        for letter, panel in zip("abcdefg", panels):
            panel.set_title(f"({letter})", loc="left")
        save(figure, path)


def title(run):
    """Return in words what was dragged how."""
    p, found = run.parameters, run.summary
    lid = f", lid of {p['lid_density']:g} $\\rho_g$" if p["lid_density"] else ""
    bulk = "" if p["bulk_gravity"] else ", no gravity in the bulk"
    return (
        f"{p['shape']}, $D$ = {found['body_height']:.3g} $d$, $\\tilde h/D$ = {found['depth_over_d']:.3g}, "
        f"$U_0$ = {p['speed']:g} m/s{lid}{bulk}"
    )


def draw_forces(axes, run):
    """C_d and a tenth of the lift over the buoyancy against travel, with their means over the steady state."""
    found, travel = run.summary, run.series["travel"]
    drag = -run.series["fx"] * found["drag_coefficient"] / found["drag"]
    lift = run.series["fz"] / found["buoyancy"] / 10
    names = ("drag_coefficient", 1, "$C_d$ {}"), ("lift_over_buoyancy", 10, "lift {} buoyancies")
    for force, (name, scale, words), colour in zip((drag, lift), names, (BLUE, VERMILLION)):
        axes.plot(travel, force, color=colour, linewidth=0.4, alpha=0.5)
        start, mean = found["steady_from"], Measured(found[name], found[f"{name}_err"] or 0.0)
        ends, height = [start, start + found["steady_travel"]], 2 * [mean.value / scale]
        axes.plot(ends, height, color=colour, linewidth=1.5, label=words.format(mean))
    axes.axvspan(found["steady_from"], travel[-1], color=GREY, alpha=0.3, linewidth=0)
    axes.axhline(0, color=BLACK, linewidth=0.4)
    axes.set(xlabel="travel  [$d$]", ylabel="$C_d$,  lift over 10 buoyancies", xlim=(0, travel[-1]))
    low, high = axes.get_ylim()
    axes.set_ylim(low, high + 0.2 * (high - low))  # room for the legend
    axes.legend(loc="upper left", ncols=2, frameon=False, handlelength=1, columnspacing=1, fontsize=6)


def draw_stress(axes, run):
    """Normal and tangential stress over P_0 by angle from the direction of travel, > 0 below (Fig. 11a)."""
    found, pressure = run.group("angular"), run.summary["pressure"]
    for name, colour, label in (("normal", BLACK, r"$\sigma_n$"), ("tangential", GREY, r"$\sigma_t$")):
        axes.errorbar(
            found["theta"] / np.pi,
            found[f"{name}_stress"] / pressure,
            found[f"{name}_stress_err"] / pressure,
            color=colour,
            label=label,
        )
    axes.set(
        xlabel=r"$\theta/\pi$, from the direction of travel, $> 0$ below", ylabel=r"stress over $P_0$", xlim=(-1, 1)
    )
    axes.set_xticks(np.linspace(-1, 1, 5))
    axes.axvline(0, color=BLACK, linewidth=0.4)
    axes.legend(loc="upper right")


def draw_profile(axes, run):
    """Packing fraction by height, before and after."""
    found = run.group("profile")
    for name, colour, label in (("fraction", BLUE, "before"), ("fraction_after", VERMILLION, "after")):
        axes.plot(found["z"] / run.summary["grain_diameter"], found[name], color=colour, linewidth=0.7, label=label)
    axes.set(xlabel="$z$  [$d$]", ylabel=r"$\phi$")
    axes.legend(loc="lower center")


def fields_of(run):
    """Return the run's fields with lengths in d, velocities over U_0 and stresses over P_0; None without."""
    try:
        found = fields.read(run, "around")
    except RunError:
        return None
    d, speed, pressure = run.summary["grain_diameter"], run.parameters["speed"], run.summary["pressure"]
    arrays = dict(found.arrays, velocity=found.arrays["velocity"] / speed)
    for name in ("pressure", "contact_stress", "kinetic_stress"):
        arrays[name] = arrays[name] / pressure
    units = dict(found.units, x="d", z="d", velocity="$U_0$", pressure="$P_0$")
    return replace(found, x=found.x / d, y=found.y / d, arrays=arrays, units=units)


def in_the_beds_frame(around):
    """Return the fields with velocities relative to the bed far away: those around the body are relative to the body."""
    velocity = around.arrays["velocity"].copy()
    velocity[..., 0] += 1
    return replace(around, arrays=dict(around.arrays, velocity=velocity))


def draw_fields(figure, run, around):
    """Pressure, and speed with streamlines in the body's frame and in the bed's (Fig. 9); return the panels."""
    panels = list(figure.subplots(3, 1))
    most = np.nanquantile(around.map("pressure"), 0.995)
    fields.draw_map(panels[0], around, "pressure", vmin=0, vmax=most)
    for panel, seen, fastest in ((panels[1], around, 2), (panels[2], in_the_beds_frame(around), 1)):
        fields.draw_map(panel, seen, "speed", vmin=0, vmax=fastest)
        fields.draw_streamlines(panel, seen)
    for panel in panels:
        draw_body(panel, run)
        panel.set(xlim=(around.x[0], around.x[-1]), ylim=(around.y[0], around.y[-1]))
    return panels


def draw_body(axes, run):
    """The section of an endless body about the origin; others are seen by the grains that they lack."""
    outline = run.group("intruder")["outline"] / run.summary["grain_diameter"]
    if len(outline):
        axes.add_patch(Polygon(outline, facecolor="white", edgecolor=BLACK, linewidth=0.8, zorder=3))
