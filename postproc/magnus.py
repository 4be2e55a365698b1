"""The figure of one Magnus run: forces over travel, distributions by angle, and the fields around the body if measured."""

import matplotlib.pyplot as plt
import numpy as np

from .figures import BLACK, BLUE, COLUMN_WIDTH, GREEN, GREY, STYLE, VERMILLION, save
from .magnus_forces import drag_and_lift
from .reader import Run


def draw(path, frame=-1):
    """Draw figure.png and figure.pdf of the run folder `path` from its data alone."""
    run = Run(path)
    with plt.rc_context(STYLE):
        figure, axes = plt.subplots(4, 1, figsize=(COLUMN_WIDTH, 6.4), height_ratios=[1.6, 1, 1, 1], layout="constrained")
        figure.suptitle(title(run), fontsize=8)
        draw_forces(axes[0], run)
        draw_angles(axes[1:], run)
        for letter, panel in zip("abcd", axes):
            panel.set_title(f"({letter})", loc="left")
        save(figure, path)


def title(run):
    """Return in words what was driven how."""
    p = run.parameters
    return (
        rf"$\Phi$ = {run.summary.get('phi', p['phi']):.3f}, $\Omega$ = {p['spin_ratio']:g}, $V_0$ = {p['v0']:g} m/s,"
        rf" $\mu$ = {p['mu']:g}, {p['width']:g} $d$ × {p['height']:g} $d$"
    )


def draw_forces(axes, run):
    """Drag and lift against travel, with their means over the steady state, which is shaded."""
    travel, forces = run.series["travel"], drag_and_lift(run.series, run.parameters["spin_ratio"])
    for name, force, colour in zip(("drag", "lift"), forces, (BLUE, VERMILLION)):
        axes.plot(travel, force, color=colour, linewidth=0.3, alpha=0.5)
        if name in run.summary:
            draw_mean(axes, run.summary, name, colour)
    if "steady_from" in run.summary:
        axes.axvspan(run.summary["steady_from"], travel[-1], color=GREY, alpha=0.3, linewidth=0)
    shown = np.quantile(np.concatenate(forces), [0.002, 0.998])
    axes.set(xlabel=r"travel  [$d$]", ylabel="force on the body  [N]", xlim=(0, travel[-1]), ylim=shown)
    axes.legend(loc="upper right", framealpha=0.8, edgecolor="none", handlelength=1.4)


def draw_mean(axes, summary, name, colour):
    """Line of a mean over the steady state, named with its standard error."""
    start = summary["steady_from"]
    label = f"{name} {summary[name]:.3g} ± {summary[name + '_err']:.1g} N"
    axes.plot([start, start + summary["steady_travel"]], 2 * [summary[name]], color=colour, linewidth=1.5, label=label)


def draw_angles(axes, run):
    """Normal force, mobilised friction and contacts by angle from the velocity, with standard errors (Fig. 6)."""
    found = run.group("angular")
    theta, normal = found["theta"] / np.pi, found["normal"]
    drag = run.summary["drag"]
    axes[0].errorbar(theta, normal / drag, found["normal_err"] / drag, color=BLUE, marker="o", markersize=2)
    axes[0].set_ylabel(r"$F_{N,\theta}/D$")
    axes[1].errorbar(theta, -found["mobilised"], found["mobilised_err"], color=VERMILLION, marker="o", markersize=2)
    axes[1].axhline(0, color=GREY, linewidth=0.6)
    axes[1].set(ylabel=r"$-F_{T,\theta}/\mu F_{N,\theta}$", ylim=(-1.1, 1.1))
    contacts = run.summary["contacts"]
    axes[2].errorbar(
        theta, found["contacts_by_angle"] / contacts, found["contacts_by_angle_err"] / contacts, color=GREEN, marker="o", markersize=2
    )
    axes[2].set(ylabel=r"$N_\theta/N$", xlabel=r"$\theta/\pi$, from the velocity, counter-clockwise")
    for panel in axes:
        panel.set_xlim(-1, 1)
        panel.axvspan(-0.5, 0.5, color=GREY, alpha=0.2, linewidth=0)
        panel.axvline(0, color=BLACK, linewidth=0.4)
