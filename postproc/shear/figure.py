"""The figure of one shear run: friction, pressure and area fraction against strain, and the velocity profile."""

import numpy as np

from ..figures import BLACK, BLUE, COLUMN_WIDTH, GREEN, GREY, STYLE, VERMILLION, plt, save, set_title
from ..measured import Measured
from ..reader import Run
from ..running import draw_convergence, draw_running, running_mean, running_ratio


def draw(path, frame=-1):
    """Draw figure.png and figure.pdf of the run folder `path` from its data alone."""
    run = Run(path)
    series, summary = run.series, run.summary
    with plt.rc_context(STYLE):
        figure, axes = plt.subplots(5, 1, figsize=(COLUMN_WIDTH, 7.4), layout="constrained")
        set_title(figure, title(run))
        strain, tau, p = series["strain"], series["shear_stress"], series["mean_pressure"]
        steady = strain >= summary["steady_from_strain"]
        friction = running_ratio(tau[steady], p[steady])
        ratio = tau / np.where(p > 0, p, np.nan)
        for panel, values, found, symbol, unit, colour in (
            (axes[0], ratio, friction, r"$\mu = \tau/p$", "", BLUE),
            (axes[2], p, running_mean(p[steady]), "$p$", r"  [$\rho g d$]", VERMILLION),
            (axes[3], series["phi"], running_mean(series["phi"][steady]), r"$\phi$", "", GREEN),
        ):
            panel.plot(strain, values, color=colour, linewidth=0.4, alpha=0.5)
            draw_running(panel, strain[steady][found.ends - 1], found, colour=colour, label=f"{symbol} = {{}}")
            panel.axvspan(summary["steady_from_strain"], strain[-1], color=GREY, alpha=0.3, linewidth=0)
            panel.set(xlabel="strain", ylabel=symbol + unit, xlim=(0, strain[-1]))
            panel.legend()
        draw_convergence(axes[1], strain[steady][friction.ends - 1], friction, colour=BLUE)
        axes[1].set(xlabel="averaged to a strain of", ylabel=r"mean $\mu$", xlim=(0, strain[-1]))
        draw_profile(axes[4], run)
        for letter, panel in zip("abcde", axes):
            panel.set_title(f"({letter})", loc="left")
        save(figure, path)


def title(run):
    """Return in words what flowed how, and by which seed: the parts of a title."""
    p = run.parameters
    inertial = Measured(*(run.summary[f"flow_inertial_number{end}"] for end in ("", "_err")))
    return [f"{p['grains']} disks", f"$I$ = {inertial}", rf"friction $\mu$ = {p['friction']:g}", f"seed {p['seed']}"]


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
