"""Stores the fields of a FieldAverager in a run folder, with units, for graindrive.postproc.fields to read."""

from typing import NamedTuple

from ..base.errors import UsageError
from ..postproc.quantities import DIMENSIONS


class FieldUnits(NamedTuple):
    """Names of the units of a study, in the form in which the run folder stores them."""

    length: str
    velocity: str
    temperature: str
    density: str
    stress: str


SI, GRAIN = (FieldUnits(*(DIMENSIONS[name][system] for name in FieldUnits._fields)) for system in (0, 1))
SI_IN_SPACE = SI._replace(density="kg/m^3", stress="N/m^2")

SETTINGS = ("kernel", "spacing", "width", "cutoff", "every", "relative", "phases", "period", "phaseStart")


def check_spacing(spacing):
    """Raise UsageError for bins whose side [d] does not divide 1 d."""
    if abs(1 / spacing - round(1 / spacing)) > 1e-9:
        raise UsageError(f"field_spacing={spacing:g} d must divide 1 d; take 1/{max(1, round(1 / spacing))}")


def write_fields(folder, name, averager, units=None):
    """Store all fields that `averager` has as the group `fields/NAME` of a RunFolder; its settings become attributes.

    Datasets: x (nx,), y (ny,), samples (phases,), area_fraction, density, temperature and pressure (phases, ny, nx),
    velocity (phases, ny, nx, 2), contact_stress and kinetic_stress (phases, ny, nx, 2, 2); pressure and stresses only
    where the averager has them. Velocity and temperature are nan where no grain was. In three dimensions the shapes are those
    of the averager, solid_fraction replaces area_fraction, and the attribute `axes` names the grid's axes: `xz` with
    averageAlong="y". `units` are SI unless given.
    """
    in_space = averager.dimensions == 3
    units = units or (SI_IN_SPACE if in_space else SI)
    arrays = {axis: (getattr(averager, axis), units.length) for axis in averager.axes}
    fraction = dict(solid_fraction=averager.solidFraction) if in_space else dict(area_fraction=averager.areaFraction)
    arrays.update(
        samples=(averager.samples, "-"),
        **{name: (array, "-") for name, array in fraction.items()},
        density=(averager.density, units.density),
        velocity=(averager.velocity, units.velocity),
        temperature=(averager.temperature, units.temperature),
    )
    if averager.stress:
        arrays.update(
            pressure=(averager.pressure, units.stress),
            contact_stress=(averager.contactStress, units.stress),
            kinetic_stress=(averager.kineticStress, units.stress),
        )
    settings = {key: getattr(averager, key) for key in SETTINGS + (("axes",) if in_space else ())}
    folder.write(f"fields/{name}", arrays, **settings)
