"""The figure of one shear run: friction, pressure and area fraction against strain, and the velocity profile."""

import numpy as np

from ..figures import BLACK, BLUE, COLUMN_WIDTH, GREEN, GREY, STYLE, VERMILLION, plt, save
from ..measured import in_words
from ..reader import Run


def draw(path, frame=-1):
    """Draw figure.png and figure.pdf of the run folder `path` from its data alone."""
    run = Run(path)
    series, summary = run.series, run.summary
    with plt.rc_context(STYLE):
        figure, axes = plt.subplots(4, 1, figsize=(COLUMN_WIDTH, 6.0), layout="constrained")
        figure.suptitle(title(run), fontsize=8)
        strain = series["strain"]
        pressed = np.where(series["mean_pressure"] > 0, series["mean_pressure"], np.nan)
        ratio = series["shear_stress"] / pressed
        for panel, values, name, label, colour in (
            (axes[0], ratio, "stress_ratio", r"$\mu = \tau/p$", BLUE),
            (axes[1], series["mean_pressure"], "mean_pressure", r"$p$  [$\rho g d$]", VERMILLION),
            (axes[2], series["phi"], "phi", r"$\phi$", GREEN),
        ):
            panel.plot(strain, values, color=colour, linewidth=0.6)
            panel.axhline(summary[name], color=BLACK, linewidth=0.7)
            panel.axvspan(summary["steady_from_strain"], strain[-1], color=GREY, alpha=0.3, linewidth=0)
            panel.set(xlabel="strain", ylabel=label, xlim=(0, strain[-1]))
        draw_profile(axes[3], run)
        for letter, panel in zip("abcd", axes):
            panel.set_title(f"({letter})", loc="left")
        save(figure, path)


def title(run):
    """Return in words what flowed how."""
    found = run.summary
    return (
        rf"$I$ = {found['flow_inertial_number']:.3g}, $\mu$ = {in_words(found['stress_ratio'], found['stress_ratio_err'])},"
        rf" $\phi$ = {found['phi']:.4f}, {run.parameters['grains']} disks"
    )


def draw_profile(axes, run):
    """Draw what the mean velocity by height has on top of the straight line, over the difference of the two sides."""
    flow = run.group("flow")
    across = run.summary["shear_rate"] * float(np.mean(run.series["height"]))
    axes.errorbar(
        flow["height"],
        flow["vx"] / across,
        flow["vx_err"] / across,
        color=BLACK,
        marker="o",
        markersize=2.5,
        linewidth=0.6,
    )
    axes.axhline(0, color=GREY, linewidth=0.6)
    axes.set(xlabel="height over the cell's", ylabel=r"$(v_x - \dot\gamma y)/\dot\gamma L$", xlim=(0, 1))
