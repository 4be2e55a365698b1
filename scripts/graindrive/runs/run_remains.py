"""What runs leave when they end early, and what the next call makes of it: a state machine over folders beside NAME.

| on disk | how it came there | what the next call for NAME does |
|---|---|---|
| `NAME`, complete | the last rename of a good run | says so; redo=1 replaces it |
| `NAME`, unreadable | damage | refuses it by name; redo=1 keeps it as `NAME.damaged` and runs again |
| `.NAME.part-PID`, locked | a run at work | refuses |
| part without rows, items, checkpoint | killed before its first row | removes it |
| part with a growing `run.h5` | killed at work | gathers all into one `run.h5`, then as the next line |
| part whose `run.h5` is `interrupted` or `failed` | killed while it was kept | keeps it as `NAME.interrupted` |
| part whose `run.h5` is `complete` | killed between its last row and its name | draws what is missing, renames it `NAME` |
| `.NAME.old-PID` | redo, killed between its two renames | gives it back its name, or removes it if `NAME` is there |
| `.NAME.gone-PID` | killed while it was removed | removes it |
| `NAME.interrupted`, `NAME.failed` | kept on purpose | resume=1 goes on from the furthest of the same parameters |
| `NAME.failed`, complete | a finished run of its own, by `out=NAME.failed` or renamed | leaves it alone |

Each step between them is one rename of something whole, so a kill can leave nothing else. A part that was resumed holds a copy
of what it goes on from: it takes the place of those remains once it is further than they are, and counts for nothing before.
So the furthest checkpoint is never removed before a further one stands. Remains are checked against the checksums in their
checkpoint (`checkpoint.py`) before anything is taken from them.
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

ENDED = ("interrupted", "failed", "complete")  # states of a gathered run.h5
WORK_FILES = ("items", ".lock", checkpoint.DATA, "about.h5")


# ---- what killed runs left -------------------------------------------------------------------------------------------


def settle(run):
    """Bring all that killed runs left for a `RunFolder` into a lasting state; folders at work stay."""
    restore_old(run.out)
    for gone in run_place.hidden_ones(run.out, "gone"):
        shutil.rmtree(gone, ignore_errors=True)
    for part in run_place.hidden_ones(run.out, "part"):
        if not run_place.is_alive(part):
            settle_part(run, part)


def restore_old(out):
    """Give the run that a killed redo had moved away its name again; remove it if the new one had taken the place."""
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
        say(run, f"a killed run left data for this folder; they are kept in {kept}")


def say(run, words):
    """Say something on stderr in the name of the study."""
    print(f"{run.study}: {words}", file=sys.stderr)


def finish_killed(run, part):
    """Finish a part that was complete; False after a line that says why it cannot be."""
    try:
        digest, study = (run_file.read_attribute(part / run_file.NAME, name) for name in ("digest", "study"))
        formats = formats_of(run_file.parameters_in(part / run_file.NAME))
        draw(part, run.figure if study == run.study else None, formats)
        take_name(part, run.out, digest)
        say(run, f"a killed run was complete but for its name; it is in {run.out} now")
    except (
        Exception
    ) as error:  # what a study's figure raises is its own; a place that is taken says where the run is kept
        say(run, f"a killed run was complete, but cannot be finished: {type(error).__name__}: {one_line(error, 200)}")
    return not part.exists()


def gather(part):
    """Make the one `run.h5` of what a killed run left in `part`; False if it had measured nothing."""
    series = max([part / "run.h5", part / checkpoint.DATA], key=run_data.rows_in)
    own = [item for item in sorted((part / "items").glob("*.h5")) if is_readable(item)]
    measured = own or run_data.rows_in(series) > 0
    if not measured and not checkpoint.folders(part):
        return False
    (part / "summary.json").unlink(missing_ok=True)  # of a run that was killed before its data were complete
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
    """Give an open HDF5 file the root attributes of other files, and the state of a run that did not end."""
    for path in sources:
        with h5py.File(path, "r") as source:
            file.attrs.update(source.attrs)
    file.attrs["state"] = "interrupted"


# ---- how a run ends --------------------------------------------------------------------------------------------------


def draw(part, figure, formats):
    """Give the folder of a run whose `run.h5` and `summary.json` are complete its figure and its frames in these formats.

    All can be made again, so a kill in between costs nothing.
    """
    if figure is not None:
        figure(part)
    exports.write_what_is_there(part, formats)


def formats_of(stored):
    """Return the formats of `exports` that the parameters in a `run.h5`, {key: Described}, ask for."""
    asked = stored["export"].value if "export" in stored else ""
    return known_formats(asked + ",vtk" * bool(stored["vtk"].value))


def take_name(part, out, digest):
    """Give a complete and drawn part its name; a run with resume=1 takes the place of what earlier ones left, too.

    UsageError says where it is kept if the place cannot be taken.
    """
    for remains in replaced_by(part, out):
        run_place.remove(remains, out)
    clear_work_files(part)
    run_place.take_place(part, out, digest)


def keep(part, out, ending):
    """Name a part whose `run.h5` is gathered NAME.`ending` and return that; None if it is no further than what is kept already.

    Of runs with resume=1 only the furthest remains stay, so that those which fail again and again leave one folder.
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
    """Return the remains of the same parameters of which a run with resume=1, in `part`, takes the place; none for others."""
    digest = attribute(part, "digest")
    return [remains for remains in remains_of(out) if was_to_resume(part) and attribute(remains, "digest") == digest]


def was_to_resume(part):
    """True if the run whose gathered `run.h5` is in `part` was given resume=1."""
    resume = run_file.parameters_in(part / run_file.NAME).get("resume")
    return resume is not None and bool(resume.value)


def attribute(folder, name):
    """Return an attribute of the `run.h5` in a folder as text; None where there is none."""
    return run_file.attribute(folder / run_file.NAME, name)


def reach(folder):
    """Return how far the data in a folder go: (step of its checkpoint, rows of series), to be compared."""
    steps = [int(name.name.partition("-")[2]) for name in checkpoint.folders(folder)]
    return max(steps, default=-1), run_data.rows_in(folder / "run.h5")


def clear_work_files(path, keep_checkpoint=False):
    """Remove from a run's folder what its `run.h5` now holds, the lock, what is half written and, if not kept, checkpoints."""
    unneeded = [path / name for name in WORK_FILES] + [*path.glob("*.tmp"), *path.glob(".*.tmp")]
    for file in unneeded + ([] if keep_checkpoint else list(path.glob("checkpoint-*"))):
        if file.is_dir():
            shutil.rmtree(file)
        else:
            file.unlink(missing_ok=True)


# ---- going on --------------------------------------------------------------------------------------------------------


def adopt(path, out, digest):
    """Copy the furthest checkpoint of the same parameters that is whole, with its data, into `path`; return its facts or None.

    The facts then have the checkpoint's `folder` and the name of the `remains`. Damaged remains are named on stderr where
    others serve; where none do, UsageError says what is damaged and how to go on.
    """
    found, damaged = candidates(out, digest)
    for facts, folder in sorted(found, key=lambda pair: -pair[0]["step"]):
        try:
            copied = checkpoint.take_over(folder.parent, facts, folder.name, path)
        except checkpoint.Damaged as error:
            damaged.append((str(error), folder.parent))
        else:
            for words, _ in damaged:
                print(f"graindrive: {words}; it is passed over", file=sys.stderr)
            return {**facts, "folder": copied, "remains": folder.parent}
    if damaged:
        words, remains = damaged[0]
        raise UsageError(f"{words}; remove {remains.name} or move it away to start anew")
    return None


def candidates(out, digest):
    """Return what remains of earlier runs: a list of (facts, folder) of checkpoints of this digest, one of (words, remains)."""
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
    """Return the folders NAME.interrupted, NAME.failed-2 … beside `out` that hold remains; a finished run may be called so."""
    name = re.compile(re.escape(out.name) + r"\.(interrupted|failed)(-\d+)?")
    named = (path for path in out.parent.iterdir() if name.fullmatch(path.name) and path.is_dir())
    return sorted(path for path in named if not is_finished(path))


def is_finished(folder):
    """True for a run that came to its end.

    Remains whose data are complete are those of a run that was killed while it was drawn; they keep their checkpoint.
    """
    return attribute(folder, "state") == "complete" and not checkpoint.folders(folder)
