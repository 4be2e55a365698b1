"""Fields of a run folder in a plane (area or solid fraction, velocity, temperature, stress), and their maps and streamlines."""

from dataclasses import dataclass
from functools import reduce

import numpy as np

from .reader import RunError

LABELS = {
    "area_fraction": r"$\Phi$",
    "solid_fraction": r"$\Phi$",
    "density": r"$\rho$",
    "temperature": r"$T_g$",
    "pressure": r"$P$",
    "contact_pressure": r"$P_\mathrm{c}$",
    "speed": r"$|\mathbf{v}|$",
}
UNITS = {
    "d": "$d$",
    "sqrt(g d)": r"$\sqrt{g d}$",
    "g d": "$g d$",
    "rho": r"$\rho$",
    "rho g d": r"$\rho g d$",
    "m^2/s^2": "m$^2$/s$^2$",
    "kg/m^2": "kg/m$^2$",
    "kg/m^3": "kg/m$^3$",
    "N/m^2": "N/m$^2$",
}


@dataclass(frozen=True)
class Fields:
    """What a FieldAverager saw: `arrays` maps names to arrays (phases, ny, nx), vectors (…, 2), stresses (…, 2, 2).

    `x` (nx,) and `y` (ny,) are the middles of the bins from the window's origin, `samples` (phases,) counts frames,
    `units` maps names to units, `settings` are the averager's (kernel, spacing, width, phases …). Of spheres, averaged along
    an axis, `axes` names the two that are left: `x` and `y` are then places along these, ny and nx their numbers, and
    vectors and stresses have three components.
    """

    x: np.ndarray
    y: np.ndarray
    samples: np.ndarray
    arrays: dict
    units: dict
    settings: dict
    axes: str = "xy"

    def map(self, name, phase=None):
        """Return one scalar field as (ny, nx): of a phase, or the mean over phases weighted by their samples.

        `name` is that of an array, "speed" or "pressure" …; nan where it is unknown. Raises RunError for other names.
        """
        known = self.scalars()
        if name not in known:
            raise RunError(f"these fields hold {', '.join(sorted(known))}; there is no {name}")
        return self.of_phase(known[name], phase)

    def scalars(self):
        """Return {name: (phases, ny, nx)} of all scalar fields.

        Among them are the speed of the mean velocity, and the contact pressure, the mean of the diagonal of the contacts' stress.
        """
        found = {name: array for name, array in self.arrays.items() if array.ndim == 3}
        if "velocity" in self.arrays:
            found["speed"] = reduce(np.hypot, np.moveaxis(self.arrays["velocity"], -1, 0))
        if "contact_stress" in self.arrays:
            stress = self.arrays["contact_stress"]
            found["contact_pressure"] = np.trace(stress, axis1=-2, axis2=-1) / stress.shape[-1]
        return found

    def velocity(self, phase=None):
        """Return the velocity along `axes`, (v_x, v_y), each (ny, nx).

        Of a phase, or the mean over phases weighted by the grains that were there.
        """
        components = np.moveaxis(self.arrays["velocity"], -1, 0)
        weight = self.arrays[self.fraction]
        return tuple(self.of_phase(components["xyz".index(axis)], phase, weight) for axis in self.axes)

    @property
    def fraction(self):
        """Name of the fraction that grains fill: of area, or of volume."""
        return "solid_fraction" if "solid_fraction" in self.arrays else "area_fraction"

    def of_phase(self, array, phase, weight=1.0):
        """Return a phase of (phases, ny, nx), or the mean over phases by samples and `weight`; nan where nothing is."""
        if phase is not None:
            return array[phase]
        weights = self.samples[:, None, None] * weight * np.isfinite(array)
        total = np.nansum(weights, axis=0)
        with np.errstate(invalid="ignore"):
            return np.nansum(weights * array, axis=0) / np.where(total > 0, total, np.nan)


def read(run, name):
    """Return the `Fields` that a run (reader.Run) stored under `fields/NAME`; RunError if there are none in a plane."""
    arrays, units, settings = run.group(f"fields/{name}"), *run.labels(f"fields/{name}")
    axes = settings.pop("axes", "xy")
    if not {*axes, "samples"} <= arrays.keys():
        raise RunError(f"{run.path} holds no fields of the name {name}")
    if len(axes) != 2:
        raise RunError(
            f"the fields {name} of {run.path} lie on a grid along {axes}; maps and exports show planes: give the averager"
            " averageAlong, or read run.h5"
        )
    x, y, samples = (arrays.pop(key) for key in (*axes, "samples"))
    return Fields(x, y, samples, arrays, units, settings, axes)


def draw_map(axes, fields, name, phase=None, **options):
    """Draw a scalar field as squares of the averager's bins with a colour bar; return the mesh.

    `options` go to pcolormesh: cmap, norm, vmin, vmax. Bins in which no grain was stay white. Figures of several maps want
    layout="compressed".
    """
    from .figures import colour_bar  # it needs pyplot, which analysis alone does not

    options = {"cmap": "YlGnBu", "rasterized": True, "shading": "nearest", **options}
    values = np.ma.masked_invalid(fields.map(name, phase))
    mesh = axes.pcolormesh(fields.x, fields.y, values, **options)
    beyond = "max" if values.count() and values.max() > mesh.norm.vmax else "neither"
    label = labelled(LABELS.get(name, name), fields.units.get("velocity" if name == "speed" else name))
    colour_bar(axes, mesh, label, extend=beyond)
    across, up = (labelled(f"${axis}$", fields.units[axis]) for axis in fields.axes)
    axes.set(aspect="equal", xlabel=across, ylabel=up)
    return mesh


def labelled(symbol, unit):
    """Return an axis label, the unit in brackets as the house sets it."""
    return symbol if unit in (None, "-") else f"{symbol}  [{UNITS.get(unit, unit)}]"


def draw_streamlines(axes, fields, phase=None, least_fraction=0.02, **options):
    """Draw lines along the mean velocity; they end where the fraction that grains fill is below `least_fraction`.

    Wide kernels reach into what holds no grains; velocities there are those of the grains beside it. `options` go to
    streamplot: density, color.
    """
    empty = ~(fields.map(fields.fraction, phase) >= least_fraction)
    v_x, v_y = (np.ma.masked_where(empty, component) for component in fields.velocity(phase))
    options = {"color": "black", "linewidth": 0.5, "arrowsize": 0.5, "density": 1.2, **options}
    lines = axes.streamplot(fields.x, fields.y, v_x, v_y, **options)
    half = (fields.x[1] - fields.x[0]) / 2 if len(fields.x) > 1 else 0.5
    axes.set(xlim=(fields.x[0] - half, fields.x[-1] + half), ylim=(fields.y[0] - half, fields.y[-1] + half))
    return lines
