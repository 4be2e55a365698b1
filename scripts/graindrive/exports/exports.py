"""Writes a run's frames for ParaView (`vtk/`), OVITO and ASE (`frames.xyz`), LAMMPS and OVITO (`frames.lammpstrj`).

A format whose name ends in `.gz` writes the same text compressed, some three times smaller; OVITO and ASE can read it directly.
"""

import gzip
import os
import shutil
import sys

from . import text_exports, vtk_export
from ..postproc.reader import Run, RunError


class Frames:
    """The frames of a run in the order of time; each iteration reads them from the file again."""

    def __init__(self, run):
        self.run = run

    def __iter__(self):
        return (self.run.frame(k) for k in range(len(self.run.frame_names)))


def check(formats):
    """Raise UsageError if a format needs a package that is not installed."""
    if "vtk" in formats:
        vtk_export.modules()


def write(path, formats):
    """Write the frames, and for vtk the fields, of the run folder `path` in each of `formats`, each in one step.

    Raises RunError for a run without the box's period in its frames (from an older version), and for one without data to write.
    """
    check(formats)
    for name in formats:
        run = Run(path)
        if lacking := nothing_for(name, run, path):
            raise RunError(lacking)
        if run.frame_names and "period" not in run.labels(f"frames/{run.frame_names[0]}")[1]:
            raise RunError(
                f"{path} holds frames of an older version, without the box's period; make the run again to export them"
            )
        WRITERS[name](run, units_of(run))


def nothing_for(name, run, out):
    """Return a message if a run, whose folder the user knows as `out`, holds no data for the format `name`; "" if it does."""
    if run.frame_names or name == "vtk" and run.names("fields"):
        return ""
    return (
        f"{out} holds no frames{' and no fields' if name == 'vtk' else ''}: there is nothing for export={name}; leave it out,"
        " or have the study keep pictures of its grains (folder.frame)"
    )


def write_what_is_there(path, formats, out):
    """Do the same as `write`, but print a message instead of an error if a run holds no data for a format.

    The run folder may still have another name, `path`, than the one that the user knows, `out`.
    """
    run = Run(path)
    lacking = {name: nothing_for(name, run, out) for name in formats}
    for words in filter(None, lacking.values()):
        print(f"graindrive: {words}", file=sys.stderr)
    write(path, [name for name in formats if not lacking[name]])


def write_missing(out, formats):
    """Write those of `formats` that the finished run folder `out` does not hold yet; return the names of their files."""
    missing = [name for name in formats if not (out / FILES[name]).exists()]
    check(missing)
    write_what_is_there(out, missing, out)
    return [FILES[name] for name in missing if (out / FILES[name]).exists()]


def units_of(run):
    """Return {name: unit} of the columns of a run's frames and contacts, and of their time `t`."""
    if not run.frame_names:
        return {}
    first = f"frames/{run.frame_names[0]}"
    disks, attributes = run.labels(first)
    said = {"t": attributes["t_unit"]} if "t_unit" in attributes else {}
    return {**run.labels(f"{first}/contacts")[0], **disks, **said}


def write_vtk(run, units):
    """Write the folder `vtk`; it replaces an older one when it is complete."""
    from ..postproc import fields  # this imports matplotlib, which other exports do not need
    from ..postproc.drum.flow_frames import FlowFrames

    target, temporary = run.path / "vtk", run.path / ".vtk"
    shutil.rmtree(temporary, ignore_errors=True)
    vtk_export.export(Frames(run), temporary, run.group("intruder"), units)
    if len(flow := FlowFrames(run)):
        vtk_export.export_flow(flow, flow.units, temporary)
    for name in run.names("fields"):
        vtk_export.export_fields(fields.read(run, name), name, temporary)
    shutil.rmtree(target, ignore_errors=True)
    os.rename(temporary, target)


def write_text(run, units, name, writer):
    """Write the file `name` in one step."""
    target = run.path / name
    temporary = target.with_name(f".{name}")
    with opened(temporary) as file:
        if run.frame_names:
            writer(Frames(run), file, units, run.provenance.get("dt", 1.0))
    os.replace(temporary, target)


def opened(path):
    """Open a file for text, compressed where its name ends in .gz."""
    return (gzip.open if path.suffix == ".gz" else open)(path, "wt", encoding="utf-8")


def text_of(name, writer):
    """Return the function that writes the file `name` of a run."""
    return lambda run, units: write_text(run, units, name, writer)


FILES = {
    "vtk": "vtk/",
    "xyz": "frames.xyz",
    "lammps": "frames.lammpstrj",
    "xyz.gz": "frames.xyz.gz",
    "lammps.gz": "frames.lammpstrj.gz",
}
WRITERS = {
    "vtk": write_vtk,
    **{name: text_of(FILES[name], text_exports.write_xyz) for name in ("xyz", "xyz.gz")},
    **{name: text_of(FILES[name], text_exports.write_lammps) for name in ("lammps", "lammps.gz")},
}
