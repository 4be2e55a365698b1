"""The figure of one Magnus run: forces and L/D as they converge, distributions by angle, fields around it if measured."""

from dataclasses import replace

import matplotlib.pyplot as plt
import numpy as np

from .. import fields
from ..figures import BLACK, BLUE, COLUMN_WIDTH, GREEN, GREY, PURPLE, STYLE, VERMILLION, save, set_title
from ..reader import Run, RunError
from ..running import draw_convergence, draw_running, running_mean, running_ratio
from . import body
from .forces import drag_and_lift


def draw(path, frame=-1):
    """Draw figure.png and figure.pdf of the run folder `path` from its data alone; `frame` says how the body is turned."""
    run = Run(path)
    around = fields_of(run)
    with plt.rc_context(STYLE):
        columns = [1.0, 0.85] if around else [1.0]
        figure = plt.figure(figsize=(COLUMN_WIDTH * sum(columns), 7.2), layout="constrained")
        set_title(figure, title(run))
        parts = np.atleast_1d(figure.subfigures(1, len(columns), width_ratios=columns))
        panels = list(parts[0].subplots(5, 1, height_ratios=[1.6, 1.1, 1, 1, 1]))
        draw_forces(panels[0], run)
        draw_ratio(panels[1], run)
        draw_angles(panels[2:], run)
        if around:
            panels += draw_fields(parts[1], run, around, run.frame(frame) if run.frame_names else None)
        for letter, panel in zip("abcdefgh", panels):
            panel.set_title(f"({letter})", loc="left")
        save(figure, path)


def title(run):
    """Return in words what was driven how, and by which seed: the parts of a title."""
    p = run.parameters
    return [
        rf"{body.name_of(run)} of {p['intruder_diameter']:g} $d$",
        rf"$\Phi$ = {run.summary.get('phi', p['phi']):.3f}",
        rf"$\Omega$ = {p['spin_ratio']:g}",
        rf"$V_0$ = {p['v0']:g} m/s",
        rf"$\mu$ = {p['mu']:g}",
        rf"channel {p['width']:g} $d$ × {p['height']:g} $d$",
        f"seed {p['seed']}",
    ]


def draw_forces(axes, run):
    """Drag and lift against travel, with their running means over the steady state, which is shaded."""
    travel, steady = run.series["travel"], steady_rows(run)
    forces = drag_and_lift(run.series, run.parameters["spin_ratio"])
    for name, force, colour in zip(("drag", "lift"), forces, (BLUE, VERMILLION)):
        axes.plot(*coarse(travel, force), color=colour, linewidth=0.4, alpha=0.4)
        found = running_mean(force[steady])
        draw_running(axes, travel[steady][found.ends - 1], found, colour=colour, label=f"{name} {{}} N")
    axes.axvspan(run.summary["steady_from"], travel[-1], color=GREY, alpha=0.3, linewidth=0)
    axes.set(xlabel=r"travel  [$d$]", ylabel="force, means over 1 $d$  [N]", xlim=(0, travel[-1]))
    axes.legend()


def steady_rows(run):
    """Return which rows of the series the averages of the steady state rest on, (n,)."""
    return run.series["travel"] >= run.summary["steady_from"]


def draw_ratio(axes, run):
    """L/D over the first part of the steady state, against how long that part is: is it converged?"""
    steady = steady_rows(run)
    drag, lift = (force[steady] for force in drag_and_lift(run.series, run.parameters["spin_ratio"]))
    found = running_ratio(lift, drag)
    ends = run.series["travel"][steady][found.ends - 1]
    draw_convergence(axes, ends, found, colour=PURPLE, label="$L/D$ = {}")
    axes.set(xlabel=r"averaged to a travel of  [$d$]", ylabel="$L/D$", xlim=(0, run.series["travel"][-1]))
    axes.legend()


def coarse(travel, force):
    """Return (travel, force) as means over about 1 d: single contacts are spikes many times the mean."""
    step = max(1, int(round(1 / travel[0]))) if len(travel) else 1
    rows = len(force) // step
    return tuple(column[: rows * step].reshape(rows, step).mean(axis=1) for column in (travel, force))


def draw_angles(axes, run):
    """Normal force, mobilised friction and contacts by angle from the velocity, with standard errors (Fig. 6)."""
    found, drag, contacts = run.group("angular"), run.summary["drag"], run.summary["contacts"]
    rows = (("normal", drag, BLUE), ("mobilised", -1, VERMILLION), ("contacts_by_angle", contacts, GREEN))
    for panel, (name, scale, colour) in zip(axes, rows):
        error = found[f"{name}_err"] / abs(scale)
        panel.errorbar(found["theta"] / np.pi, found[name] / scale, error, color=colour, marker="o", markersize=2)
        panel.set_xlim(-1, 1)
        panel.axvspan(-0.5, 0.5, color=GREY, alpha=0.2, linewidth=0)
        panel.axvline(0, color=BLACK, linewidth=0.4)
    axes[0].set_ylabel(r"$F_{N,\theta}/D$")
    axes[1].axhline(0, color=BLACK, linewidth=0.4)
    axes[1].set(ylabel=r"$-F_{T,\theta}/\mu F_{N,\theta}$", ylim=(-1.2, 1.2))
    axes[2].set(ylabel=r"$N_\theta/N$", xlabel=r"$\theta/\pi$, from the velocity, counter-clockwise")


def fields_of(run):
    """Return the run's fields with lengths in d, velocity over V0, temperature over V0^2(1 + Omega^2); None without."""
    try:
        found = fields.read(run, "around")
    except RunError:
        return None
    v0, spin_ratio = run.parameters["v0"], run.parameters["spin_ratio"]
    arrays = dict(found.arrays, velocity=found.arrays["velocity"] / v0)
    arrays["temperature"] = found.arrays["temperature"] / (v0**2 * (1 + spin_ratio**2))
    units = dict(found.units, x="d", y="d", velocity="$V_0$", temperature=r"$V_0^2(1 + \Omega^2)$")
    d = grain_diameter(run)
    return replace(found, x=found.x / d, y=found.y / d, arrays=arrays, units=units)


def grain_diameter(run):
    """Return d [m] of a Magnus run; of folders that hold no constants by the body's way in m and in d."""
    if "d" in run.constants:
        return run.constants["d"]
    if not len(run.series.get("travel", ())):
        raise RunError(f"{run.path} holds neither the constant d nor a row of travel")
    return float(run.parameters["v0"] * run.series["t"][-1] / run.series["travel"][-1])


def draw_fields(figure, run, around, bed):
    """Speed with streamlines, area fraction and granular temperature in the body's frame (Fig. 7); return the panels.

    The body is drawn as it is turned in the frame `bed`, at the end of the run without one.
    """
    panels = list(figure.subplots(3, 1))
    angle = body.turned(run, bed)
    warm = np.nanquantile(around.map("temperature"), 0.99)
    fields.draw_map(panels[0], around, "speed", vmin=0, vmax=1.5)
    fields.draw_streamlines(panels[0], around)
    fields.draw_map(panels[1], around, "area_fraction", vmin=0, vmax=0.9)
    fields.draw_map(panels[2], around, "temperature", vmin=0, vmax=warm)
    for panel in panels:
        body.draw(panel, run, angle, unit=grain_diameter(run), swept=True)
        panel.set(xlim=(around.x[0], around.x[-1]), ylim=(around.y[0], around.y[-1]))
    return panels
