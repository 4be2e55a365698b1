"""The figure of one lift run: forces over travel, stress by angle, profile of the bed, and the fields around the body."""

from dataclasses import replace
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

from .. import fields, figures
from ..figures import BLACK, BLUE, COLUMN_WIDTH, GREY, STYLE, VERMILLION, save, set_title
from ..reader import Run, RunError
from ..running import draw_convergence, draw_running, running_mean


def draw(path, frame=-1):
    """Draw figure.png and figure.pdf of the run folder `path` from its data alone."""
    run = Run(path)
    around = fields_of(run)
    with plt.rc_context(STYLE):
        columns = [1.0, 0.62] if around else [1.0]  # maps are square
        figure = plt.figure(figsize=(COLUMN_WIDTH * sum(columns), 6.6), layout="constrained")
        set_title(figure, title(run))
        parts = np.atleast_1d(figure.subfigures(1, len(columns), width_ratios=columns))
        panels = list(parts[0].subplots(4, 1, height_ratios=[1.4, 1, 1.3, 0.8]))
        draw_forces(panels[0], run)
        draw_lift(panels[1], run)
        draw_stress(panels[2], run)
        draw_profile(panels[3], run)
        if around:
            panels += draw_fields(parts[1], run, around)
        for letter, panel in zip("abcdefgh", panels):
            panel.set_title(f"({letter})", loc="left")
        save(figure, path)


def title(run):
    """Return in words what was dragged how, and by which seed: the parts of a title."""
    p, found = run.parameters, run.summary
    return [
        Path(str(p["shape"])).stem.replace("$", r"\$"),
        f"$D$ = {found['body_height']:.3g} $d$",
        rf"$\tilde h/D$ = {found['depth_over_d']:.3g}",
        f"$U_0$ = {p['speed']:g} m/s",
        rf"lid of {p['lid_density']:g} $\rho_g$" if p["lid_density"] else "",
        "" if p["bulk_gravity"] else "no gravity in the bulk",
        f"seed {p['seed']}",
    ]


def draw_forces(axes, run):
    """C_d and a tenth of the lift over the buoyancy against travel, with their running means over the steady state."""
    travel, steady = run.series["travel"], steady_rows(run)
    words = "$C_d$ = {}", "lift {} buoyancies"
    for force, scale, label, colour in zip(over_units(run), (1, 10), words, (BLUE, VERMILLION)):
        axes.plot(travel, force / scale, color=colour, linewidth=0.4, alpha=0.4)
        mean = running_mean(force[steady])
        draw_running(axes, travel[steady][mean.ends - 1], mean, colour=colour, scale=scale, label=label)
    axes.axvspan(run.summary["steady_from"], travel[-1], color=GREY, alpha=0.3, linewidth=0)
    axes.axhline(0, color=BLACK, linewidth=0.4)
    axes.set(xlabel="travel  [$d$]", ylabel="$C_d$,  lift over\n10 buoyancies", xlim=(0, travel[-1]))
    axes.legend()


def over_units(run):
    """Return C_d and the lift over the buoyancy as series, each (n,)."""
    found = run.summary
    return -run.series["fx"] * found["drag_coefficient"] / found["drag"], run.series["fz"] / found["buoyancy"]


def steady_rows(run):
    """Return which rows of the series the averages of the steady state rest on, (n,)."""
    return run.series["travel"] >= run.summary["steady_from"]


def draw_lift(axes, run):
    """The lift over the first part of the steady state, against how long that part is: is it converged?"""
    travel, steady = run.series["travel"], steady_rows(run)
    found = running_mean(over_units(run)[1][steady])
    draw_convergence(axes, travel[steady][found.ends - 1], found, colour=VERMILLION, label="lift {} buoyancies")
    axes.set(xlabel="averaged to a travel of  [$d$]", ylabel="lift over\nbuoyancy", xlim=(0, travel[-1]))
    axes.legend()


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
    axes.legend()


def draw_profile(axes, run):
    """Packing fraction by height, before and after."""
    found = run.group("profile")
    for name, colour, label in (("fraction", BLUE, "before"), ("fraction_after", VERMILLION, "after")):
        axes.plot(found["z"] / run.summary["grain_diameter"], found[name], color=colour, linewidth=0.7, label=label)
    axes.set(xlabel="$z$  [$d$]", ylabel=r"$\phi$")
    axes.legend()


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
        figures.draw_body(axes, outline)
