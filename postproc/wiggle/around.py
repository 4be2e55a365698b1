"""The fields around a shaken body by phase of the cycle, beside the rest of its figure: fraction, speed and pressure."""

import numpy as np

from .. import fields
from ..figures import draw_body, draw_disk
from ..reader import RunError

WIDTH = 4.6  # inches of the maps
PHASES = (0.0, 0.25, 0.5, 0.75)  # t/T of the rows of maps
MAPS = (  # name, words, colours
    ("area_fraction", r"area fraction $\Phi$", "Greys"),
    ("speed", r"$|\langle\mathbf{v}\rangle|$  [$\sqrt{gd}$]", "YlGnBu"),
    ("contact_pressure", r"$P_\mathrm{c}$  [$\rho g d$]", "inferno"),
)
STREAMS = dict(density=0.5, linewidth=0.4)


def fields_of(run):
    """Return the run's fields around the body, lengths in d; None without."""
    try:
        return fields.read(run, "around") if run.frame_names or run.state != "running" else None
    except RunError:
        return None


def draw(figure, run, seen):
    """Draw a row of maps for each of `PHASES`, with one scale a column and its bar below; return the first panel."""
    panels = figure.subplots(len(PHASES), len(MAPS), sharex=True, sharey=True)
    phases = [int(phase * len(seen.samples)) for phase in PHASES]
    for column, (name, words, colours) in zip(panels.T, MAPS):
        known = np.array([seen.map(name, k) for k in phases])
        top = float(np.nanquantile(known, 0.995)) if np.isfinite(known).any() else 1.0
        for panel, k in zip(column, phases):
            values = np.ma.masked_invalid(seen.map(name, k))
            mesh = panel.pcolormesh(
                seen.x, seen.y, values, cmap=colours, vmin=0, vmax=top, rasterized=True, shading="nearest"
            )
            if name == "speed":
                fields.draw_streamlines(panel, seen, k, **STREAMS)
            draw_held(panel, run)
            panel.set(aspect="equal", xlim=seen.x[[0, -1]], ylim=seen.y[[0, -1]])
        below = column[-1].inset_axes([0, -0.42, 1, 0.06])
        figure.colorbar(mesh, cax=below, orientation="horizontal", label=words, extend="max")
        below.minorticks_off()
        column[-1].set_xlabel("$x$  [$d$]")
    for line, k in zip(panels, phases):
        middle = (k + 0.5) / len(seen.samples)
        line[0].set_ylabel(f"$t/T$ = {middle:.3g}\n$y$  [$d$]")
    return panels[0, 0]


def draw_held(axes, run):
    """The body about the origin; it is shaken without turning."""
    body = run.group("intruder")
    if "outline" in body and len(body["outline"]) > 2:
        draw_body(axes, body["outline"])
    elif "beads" in body:
        draw_disk(axes, body["beads"].mean(axis=0), float(np.atleast_1d(body["bead_radius"])[0]))
