"""Handles the remains of runs that ended early: a table of the folders beside NAME and what the next call does with them.

| on disk | origin | what the next call for NAME does |
|---|---|---|
| `NAME`, complete | the last rename of a good run | says so; redo=1 replaces it |
| `NAME`, unreadable | damage | refuses it by name; redo=1 keeps it as `NAME.damaged` and runs again |
| `.NAME.part-PID`, locked | a run is working | refuses |
| part without rows, items, checkpoint | killed before its first row | removes it |
| part with an unfinished `run.h5` | killed at work | combines all data into one `run.h5`, then as the next line |
| part whose `run.h5` is `interrupted` or `failed` | killed while it was kept | keeps it as `NAME.interrupted` |
| part whose `run.h5` is `complete` | killed between its last row and its name | draws what is missing, renames it `NAME` |
| `.NAME.old-PID` | redo, killed between its two renames | renames it `NAME`, or removes it if `NAME` exists |
| `.NAME.gone-PID` | killed while it was removed | removes it |
| `NAME.interrupted`, `NAME.failed` | kept on purpose | resume=1 continues the one of the same parameters with most steps |
| `NAME.failed`, complete | a different, finished run: `out=NAME.failed`, or renamed | does not touch it |

Each transition is one rename of a complete folder or file, so a kill can leave no other state. A resumed part holds a copy of the
remains that it continues: it replaces them once it has more steps, and is discarded if it is killed before that. So the
checkpoint with most steps is never removed before a later one exists. Remains are checked against the checksums in their
checkpoint (`checkpoint.py`) before anything is copied from them.
"""

import re
import shutil
import sys

import h5py

from . import checkpoint, run_data, run_file, run_place
from ..exports import exports
from ..base import whole_files
from ..base.errors import UsageError, one_line
from ..parameters import known_formats

ENDED = ("interrupted", "failed", "complete")  # states of a combined run.h5
WORK_FILES = ("items", ".lock", checkpoint.DATA, "about.h5")


# ---- remains of killed runs ------------------------------------------------------------------------------------------


def settle(run):
    """Settle all remains of killed runs for a `RunFolder`; folders of working runs are not touched."""
    restore_old(run.out)
    for gone in run_place.hidden_ones(run.out, "gone"):
        shutil.rmtree(gone, ignore_errors=True)
    for part in run_place.hidden_ones(run.out, "part"):
        if not run_place.is_alive(part):
            settle_part(run, part)


def restore_old(out):
    """Rename the run that a killed redo had moved away back to `out`, or remove it if the new run is in place."""
    for old in run_place.hidden_ones(out, "old"):
        if out.exists():
            run_place.remove(old, out)
        else:
            old.rename(out)


def settle_part(run, part):
    """Finish, keep or remove the folder of a killed run."""
    state = attribute(part, "state")
    if state == "complete" and finish_killed(run, part):
        return
    if state not in ENDED and not gather(part):
        run_place.remove(part, run.out)
        return
    kept = keep(part, run.out, "failed" if state in ("failed", "complete") else "interrupted")
    if kept:
        say(run, f"a killed run left data of this run; they are kept in {kept}")


def say(run, words):
    """Say something on stderr in the name of the study."""
    print(f"{run.study}: {words}", file=sys.stderr)


def finish_killed(run, part):
    """Finish a part whose data are complete; print the reason and return False if this fails."""
    try:
        digest, study = (run_file.read_attribute(part / run_file.NAME, name) for name in ("digest", "study"))
        formats = formats_of(run_file.parameters_in(part / run_file.NAME))
        draw(part, run.out, run.figure if study == run.study else None, formats)
        take_name(part, run.out, digest)
        say(run, f"a killed run was complete except for its name; it is now in {run.out}")
    except Exception as error:  # a figure may raise any error; the error for a taken place names the folder of the run
        say(run, f"a killed run was complete, but cannot be finished: {type(error).__name__}: {one_line(error, 200)}")
    return not part.exists()


def gather(part):
    """Combine the data that a killed run left in `part` into one `run.h5`; False if there are no data."""
    series = max([part / "run.h5", part / checkpoint.DATA], key=run_data.rows_in)
    own = [item for item in sorted((part / "items").glob("*.h5")) if is_readable(item)]
    measured = own or run_data.rows_in(series) > 0
    if not measured and not checkpoint.folders(part):
        return False
    (part / "summary.json").unlink(missing_ok=True)  # it belongs to a run that was killed before its data were complete
    also = [file for file in (part / checkpoint.DATA, part / "about.h5") if is_readable(file)]
    run_data.merge(
        part / "run.h5",
        series if run_data.rows_in(series) >= 0 else None,
        own + also,
        lambda file: copy_attributes(also, file),
    )
    return True


def is_readable(path):
    """True for an HDF5 file that can be opened."""
    try:
        h5py.File(path, "r").close()
        return True
    except run_data.UNREADABLE:
        return False


def copy_attributes(sources, file):
    """Copy the root attributes of other files to an open HDF5 file, and set the state of an interrupted run."""
    for path in sources:
        with h5py.File(path, "r") as source:
            file.attrs.update(source.attrs)
    file.attrs["state"] = "interrupted"


# ---- how a run ends --------------------------------------------------------------------------------------------------


def draw(part, out, figure, formats):
    """Add the figure and the frames in these formats to the folder of a run with complete `run.h5` and `summary.json`.

    All of them can be made again, so a kill meanwhile does no harm. Messages call the folder `out`, its name when complete.
    """
    if figure is not None:
        figure(part)
    exports.write_what_is_there(part, formats, out)


def formats_of(stored):
    """Return the formats of `exports` that the parameters in a `run.h5`, {key: Described}, ask for."""
    asked = stored["export"].value if "export" in stored else ""
    return known_formats(asked + ",vtk" * bool(stored["vtk"].value))


def take_name(part, out, digest):
    """Rename a complete part with its figure to `out`; a run with resume=1 also replaces the remains of earlier runs.

    UsageError names the folder that keeps it if the place cannot be taken.
    """
    for remains in replaced_by(part, out):
        run_place.remove(remains, out)
    clear_work_files(part)
    run_place.take_place(part, out, digest)


def keep(part, out, ending):
    """Rename a part with a combined `run.h5` to NAME.`ending` and return that; None if kept remains have as many steps.

    Of several runs with resume=1 only the remains with most steps are kept, so repeated failures leave one folder.
    """
    others = {remains: reach(remains) for remains in replaced_by(part, out)}
    own, source = reach(part), attribute(part, checkpoint.SOURCE)
    if any(own <= its for remains, its in others.items() if remains.name == source or own[0] < 0):
        run_place.remove(part, out)
        return None
    clear_work_files(part, keep_checkpoint=True)
    whole_files.sync_tree(part)
    for remains in [remains for remains, its in others.items() if its <= own]:
        run_place.remove(remains, out)
    kept = run_place.free_name(out, ending)
    part.rename(kept)
    whole_files.sync(out.parent)
    return kept


def replaced_by(part, out):
    """Return the remains of the same parameters that a run with resume=1, in `part`, replaces; an empty list for other runs."""
    digest = attribute(part, "digest")
    return [remains for remains in remains_of(out) if was_to_resume(part) and attribute(remains, "digest") == digest]


def was_to_resume(part):
    """True if the run whose combined `run.h5` is in `part` was started with resume=1."""
    resume = run_file.parameters_in(part / run_file.NAME).get("resume")
    return resume is not None and bool(resume.value)


def attribute(folder, name):
    """Return an attribute of the `run.h5` in a folder as text; None if there is none."""
    return run_file.attribute(folder / run_file.NAME, name)


def reach(folder):
    """Return the progress of the data in a folder, for comparisons: (step of its checkpoint, rows of series)."""
    steps = [int(name.name.partition("-")[2]) for name in checkpoint.folders(folder)]
    return max(steps, default=-1), run_data.rows_in(folder / "run.h5")


def clear_work_files(path, keep_checkpoint=False):
    """Remove files that `run.h5` now contains, the lock, unfinished files and, unless kept, checkpoints from a run's folder."""
    unneeded = [path / name for name in WORK_FILES] + [*path.glob("*.tmp"), *path.glob(".*.tmp")]
    for file in unneeded + ([] if keep_checkpoint else list(path.glob("checkpoint-*"))):
        if file.is_dir():
            shutil.rmtree(file)
        else:
            file.unlink(missing_ok=True)


# ---- resume ----------------------------------------------------------------------------------------------------------


def adopt(path, out, digest):
    """Copy the latest intact checkpoint of the same parameters, with its data, into `path`; return its facts or None.

    The facts then include the checkpoint's `folder` and the name of the `remains`. Damaged remains are named on stderr if
    others can be used; if none can, UsageError says what is damaged and how to proceed.
    """
    found, damaged = candidates(out, digest)
    for facts, folder in sorted(found, key=lambda pair: -pair[0]["step"]):
        try:
            copied = checkpoint.take_over(folder.parent, facts, folder.name, path)
        except checkpoint.Damaged as error:
            damaged.append((str(error), folder.parent))
        else:
            for words, _ in damaged:
                print(f"graindrive: {words}; it is not used", file=sys.stderr)
            return {**facts, "folder": copied, "remains": folder.parent}
    if damaged:
        words, remains = damaged[0]
        raise UsageError(f"{words}; remove {remains.name} or move it away to start anew")
    return None


def candidates(out, digest):
    """Return two lists on earlier runs: (facts, folder) of checkpoints with this digest, (message, remains) of damaged ones."""
    found, damaged = [], []
    for remains in remains_of(out):
        for folder in checkpoint.folders(remains):
            try:
                facts = checkpoint.read(folder)
                found += [(facts, folder)] if facts["digest"] == digest else []
            except checkpoint.Damaged as error:
                damaged.append((str(error), remains))
    return found, damaged


def remains_of(out):
    """Return the folders NAME.interrupted, NAME.failed-2 … beside `out` that hold remains and no finished run."""
    name = re.compile(re.escape(out.name) + r"\.(interrupted|failed)(-\d+)?")
    named = (path for path in out.parent.iterdir() if name.fullmatch(path.name) and path.is_dir())
    return sorted(path for path in named if not is_finished(path))


def is_finished(folder):
    """True for a run that ended successfully.

    Remains with complete data come from a run that was killed while its figure was drawn; they still have their checkpoint.
    """
    return attribute(folder, "state") == "complete" and not checkpoint.folders(folder)
