"""The continuum in a drum, model=continuum of the drum study: what the study asks of it. It is not built yet.

`run` solves the flow and stores it as the group `fields/continuum` of the run folder, under the names of `fields.write_fields`:
x (nx,), y (ny,) [d], centres of cells with the drum's axis at 0; samples (blocks,); area_fraction (blocks, ny, nx), the volume
fraction alpha of the granular phase; velocity (blocks, ny, nx, 2) [sqrt(g d)] at the centres of cells. A block is a mean over
a part of the steady state; one is enough, and then there are no errors. The study does all else from there, by
`postproc.drum.blocks`. With model=both the grains have run before, in the same folder.
"""

from .errors import UsageError

NOT_BUILT = "model={} is not built yet; take model=dem"


def check(p):
    """UsageError for parameters of which no continuum can be made."""
    raise UsageError(NOT_BUILT.format(p.model))


def run(p, folder):
    """Solve the flow with the parameters `p` of the drum study and store it in an open RunFolder; resumes as grains do."""
    raise UsageError(NOT_BUILT.format(p.model))


def seconds(p):
    """Return the seconds that `run` takes one core."""
    return 0.0
