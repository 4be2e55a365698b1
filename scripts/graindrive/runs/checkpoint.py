"""Checkpoints: a folder with all that a run needs to continue from a step, with a checksum of it and of the data so far.

`checkpoint-STEP/` holds what the study saves (`scene.checkpoint`, `track.npz`) and `checkpoint.json`: the study's facts, `step`,
`digest` of the parameters, `rows` and `series` (number and checksum of the rows of the time series), `items` (name and
checksum of each frame), `files` (checksum of each file beside it), `format`, `code_version`, and `sum`, which covers all of
these. It is written under a temporary name, synced and renamed, so a kill leaves the older one or the new one, or both.
"""

import json
import shutil
from pathlib import Path

import h5py

from . import run_data
from ..base import whole_files
from ..base.errors import is_full, one_line

FORMAT = 2  # of checkpoint.json and of what its checksums cover
FACTS = "checkpoint.json"
DATA = "resumed.h5"  # in the folder of a resumed run: rows and items up to its checkpoint
SOURCE = "resumed_from"  # attribute of a resumed run's data: the name of the remains that it continues
TEMPORARY = "checkpoint.tmp"


class Damaged(Exception):
    """Remains of a run are damaged or inconsistent; the message names the file and says what is wrong with it."""


def write(path, save, facts):
    """Write a checkpoint below `path` with `save(folder)`; it replaces the older one once it is complete.

    `facts` are plain values with `step`, `digest`, `rows`, `series` and `items`. A checkpoint of the same step is kept.
    """
    name, older, temporary = path / f"checkpoint-{facts['step']:012d}", folders(path), path / TEMPORARY
    if name in older:
        return
    shutil.rmtree(temporary, ignore_errors=True)
    temporary.mkdir()
    save(temporary)
    facts = {**facts, "format": FORMAT, "files": {file.name: file_sum(file) for file in sorted(temporary.iterdir())}}
    (temporary / FACTS).write_text(json.dumps({**facts, "sum": facts_sum(facts)}))
    whole_files.rename_folder(temporary, name)
    for folder in older:
        discard(folder)


def folders(path):
    """Return the folders of the checkpoints below `path`, the one with the most steps last."""
    return sorted(file.parent for file in Path(path).glob(f"checkpoint-*/{FACTS}"))


def discard(folder):
    """Remove a checkpoint; a kill meanwhile leaves no incomplete checkpoint under its name."""
    whole_files.discard(folder, whole_files.beside(folder))


def file_sum(path):
    """Return the checksum of a file's content."""
    return run_data.new_sum(Path(path).read_bytes()).hexdigest()


def facts_sum(facts):
    """Return the checksum of a dict of plain values without its key `sum`."""
    plain = {key: value for key, value in facts.items() if key != "sum"}
    return run_data.new_sum(json.dumps(plain, sort_keys=True).encode()).hexdigest()


def read(folder):
    """Return the facts of a checkpoint; raises Damaged unless it is complete and of this format. Its data are not checked."""
    file = folder / FACTS
    try:
        facts = json.loads(file.read_text(encoding="utf-8"))
        format_ = facts.get("format", 1)
    except (OSError, ValueError, AttributeError) as error:
        raise Damaged(f"{file} cannot be read ({one_line(error)})") from None
    if format_ != FORMAT:
        raise Damaged(
            f"{file} has format {one_line(format_)}, this version of Graindrive reads {FORMAT}: use the version that wrote it"
        )
    if facts.get("sum") != facts_sum(facts):
        raise Damaged(f"{file} differs from its checksum")
    for name, sum_ in facts["files"].items():
        check_file(folder / name, sum_)
    return facts


def check_file(file, sum_):
    """Raise Damaged for a file of a checkpoint that is missing or differs."""
    try:
        found = file_sum(file)
    except OSError as error:
        raise Damaged(f"{file} cannot be read ({one_line(error)})") from None
    if found != sum_:
        raise Damaged(f"{file} differs from its checksum")


def take_over(remains, facts, name, path):
    """Copy the checkpoint `name` of the folder `remains`, with the given `facts`, and its data into `path`.

    The data go to `resumed.h5`: the checkpoint's number of rows and the items that it names, each checked against its
    checksum. Raises Damaged if one differs; `path` is then unchanged. The checkpoint is copied last.
    """
    source = remains / "run.h5"
    try:
        run_data.write_file(path / DATA, lambda file: copy_data(source, file, facts))
    except run_data.UNREADABLE as error:
        if is_full(error):
            raise
        raise Damaged(f"{source} cannot be read ({one_line(error)})") from None
    temporary = path / TEMPORARY
    shutil.rmtree(temporary, ignore_errors=True)
    shutil.copytree(remains / name, temporary)
    whole_files.rename_folder(temporary, path / name)
    return path / name


def copy_data(source, file, facts):
    """Copy the rows and items that a checkpoint's `facts` name from `source` into an open HDF5 file; raises Damaged."""
    file.attrs[SOURCE] = source.parent.name
    rows = run_data.rows_in(source)
    if rows < facts["rows"]:
        raise Damaged(f"{source} holds {max(rows, 0)} of the {facts['rows']} rows that its checkpoint needs")
    series, units = run_data.read_series(source, facts["rows"])
    if run_data.series_sum(series, units) != facts["series"]:
        raise Damaged(f"{source} holds other series than its checkpoint needs")
    run_data.write_series(file.create_group("series"), series, units)
    with h5py.File(source, "r") as stored:
        for name, sum_ in facts["items"].items():
            if name not in stored or run_data.item_sum(stored[name]) != sum_:
                raise Damaged(f"{source} holds another {name} than its checkpoint needs, or none")
            stored.copy(name, file, name)
