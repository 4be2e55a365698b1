"""Stores the fields of a FieldAverager in a run folder, with units, for graindrive.postproc.fields to read."""

from typing import NamedTuple

from .errors import UsageError
from .postproc.quantities import DIMENSIONS


class FieldUnits(NamedTuple):
    """Names of the units that a study counts in, as the run folder keeps them."""

    length: str
    velocity: str
    temperature: str
    density: str
    stress: str


SI, GRAIN = (FieldUnits(*(DIMENSIONS[name][system] for name in FieldUnits._fields)) for system in (0, 1))

SETTINGS = ("kernel", "spacing", "width", "cutoff", "every", "relative", "phases", "period", "phaseStart")


def check_spacing(spacing):
    """Raise UsageError for bins whose edge [d] does not divide 1 d."""
    if abs(1 / spacing - round(1 / spacing)) > 1e-9:
        raise UsageError(f"field_spacing={spacing:g} d must divide 1 d; take 1/{max(1, round(1 / spacing))}")


def write_fields(folder, name, averager, units=SI):
    """Store all fields that `averager` has as the group `fields/NAME` of a RunFolder; its settings become attributes.

    Datasets: x (nx,), y (ny,), samples (phases,), area_fraction, density, temperature and pressure (phases, ny, nx),
    velocity (phases, ny, nx, 2), contact_stress and kinetic_stress (phases, ny, nx, 2, 2); pressure and stresses only
    where the averager has them. Velocity and temperature are nan where no grain was.
    """
    arrays = dict(
        x=(averager.x, units.length),
        y=(averager.y, units.length),
        samples=(averager.samples, "-"),
        area_fraction=(averager.areaFraction, "-"),
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
    folder.write(f"fields/{name}", arrays, **{key: getattr(averager, key) for key in SETTINGS})
