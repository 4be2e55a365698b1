"""The files of runs that end early, and how the next call continues from them; in one process, without YADE."""

import json
import os
import shutil

import h5py
import numpy as np
import pytest

from graindrive.runs import checkpoint, provenance, recording, run_place
from graindrive.base import whole_files
from graindrive.base.errors import UsageError
from graindrive.parameters import StudyParameters, quantity
from graindrive.runs.run_folder import RunFolder
from graindrive.runs.run_place import AlreadyComplete

STEPS = 8


class Parameters(StudyParameters):
    phi: float = quantity(0.35, "-", "a number that decides something", gt=0)


@pytest.fixture
def place(tmp_path):
    return Place(tmp_path / "work")


class Place:
    """A folder with runs named `a`; makes runs in it that end as asked."""

    def __init__(self, path):
        self.path = path
        path.mkdir()

    def open(self, *, figure=None, **keys):
        return RunFolder(Parameters(**{"out": str(self.path / "a"), **keys}), study="toy", figure=figure or draw)

    def run(self, *, stop=None, checkpoint_at=4, **keys):
        """Run to the end or until an interruption after step `stop`; each step writes a row, one of them a checkpoint."""
        with self.open(**keys) as folder:
            go_on(folder, stop, checkpoint_at)

    def interrupted(self, **keys):
        with pytest.raises(KeyboardInterrupt):
            self.run(**{"stop": 6, **keys})

    def names(self):
        return sorted(p.name for p in self.path.iterdir())

    def rows(self, name="a"):
        with h5py.File(self.path / name / "run.h5") as file:
            return list(file["series/x"])

    def facts(self, name="a.interrupted"):
        (file,) = (self.path / name).glob("checkpoint-*/checkpoint.json")
        return file

    def change(self, **changes):
        """Change entries in the checkpoint of an interrupted run."""
        file = self.facts()
        file.write_text(json.dumps({**json.loads(file.read_text()), **changes}))


def draw(path):
    (path / "figure.png").write_text("drawn")


def go_on(folder, stop, checkpoint_at):
    first = folder.resumed["step"] if folder.resumed else 0
    track = recording.Track(folder)
    folder.declare_series(x="d")
    for step in range(first + 1, STEPS + 1):
        folder.append(x=step**2)
        track.append(dict(x=step**2))
        if step % 3 == 0:
            folder.frame(step, {"x": np.full(3, step)})
        if step == checkpoint_at:
            folder.checkpoint(track.save, step, note="toy")
        if step == stop:
            raise KeyboardInterrupt
    folder.note(dt=1.0, dt_over_critical=0.1, n_grains=1, steps=STEPS, particle_steps_per_second=1.0)
    folder.summarize(total=float(track.arrays()["x"].sum()))


def killed(folder):
    """Close the files of a run as the system does after a kill; data that were not flushed are lost."""
    if folder.series is not None:
        folder.series.waiting = {name: [] for name in folder.series.waiting}
        folder.series.file.close()
    folder.lock.close()
    return folder.path.rename(folder.path.with_name(".a.part-1"))  # another process


WHOLE = [step**2 for step in range(1, STEPS + 1)]


# ---- kills -----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("rows", [0, 1])
def test_a_resumed_run_that_is_killed_before_its_first_flush_counts_for_nothing(place, rows):
    place.interrupted()
    folder = place.open(resume=True)
    folder.__enter__()
    folder.declare_series(x="d")
    for _ in range(rows):
        folder.append(x=0)
    part = killed(folder)
    assert part.is_dir()
    place.run(resume=True)
    assert place.rows() == WHOLE and place.names() == ["a"]


def test_of_several_remains_the_furthest_counts(place):
    place.interrupted(checkpoint_at=2)
    shutil.copytree(place.path / "a.interrupted", place.path / "a.failed")
    shutil.rmtree(place.path / "a.interrupted")
    place.interrupted(checkpoint_at=5)
    with place.open(resume=True) as folder:
        assert folder.resumed["step"] == 5
        go_on(folder, None, 6)
    assert place.rows() == WHOLE and place.names() == ["a"]


@pytest.mark.parametrize("content", [b"", b"not HDF5", b"\x89HDF\r\n\x1a\n" + bytes(500)], ids=range(3))
def test_unreadable_series_are_no_data(place, content):
    part = place.path / ".a.part-1"
    part.mkdir()
    (part / "run.h5").write_bytes(content)
    place.run()
    assert place.rows() == WHOLE and place.names() == ["a"]


def test_a_killed_removal_is_finished(place):
    gone = place.path / ".a.gone-1"
    (gone / "items").mkdir(parents=True)
    place.run()
    assert place.names() == ["a"]


def test_a_run_that_was_complete_but_for_its_name_gets_it(place, capsys):
    place.run()
    os.rename(place.path / "a", place.path / ".a.part-1")
    (place.path / ".a.part-1/figure.png").unlink()
    with pytest.raises(AlreadyComplete):
        place.run()
    assert place.names() == ["a"] and (place.path / "a/figure.png").read_text() == "drawn"
    assert "a killed run was complete except for its name" in capsys.readouterr().err


def test_a_complete_run_that_cannot_be_drawn_does_not_wedge_its_place(place, capsys):
    place.run()
    os.rename(place.path / "a", place.path / ".a.part-1")
    with pytest.raises(ZeroDivisionError):
        place.run(figure=lambda path: 1 / 0)
    assert "cannot be finished: ZeroDivisionError" in capsys.readouterr().err
    assert place.rows("a.failed") == WHOLE


def test_redo_that_is_killed_between_its_renames_leaves_the_old_result(place):
    place.run()
    os.rename(place.path / "a", place.path / ".a.old-1")
    with pytest.raises(AlreadyComplete):
        place.run()
    assert place.rows() == WHOLE and place.names() == ["a"]


def test_redo_that_fails_leaves_the_old_result(place, monkeypatch):
    place.run()
    rename = os.rename

    def second_fails(source, target):
        if str(target) == str(place.path / "a") and ".part-" in str(source):
            raise OSError(18, "Invalid cross-device link")
        rename(source, target)

    monkeypatch.setattr(os, "rename", second_fails)
    with pytest.raises(UsageError, match="cannot be replaced .*; this run is complete and kept in .*a.complete"):
        place.run(redo=True)
    assert place.rows() == place.rows("a.complete") == WHOLE and place.names() == ["a", "a.complete"]


# ---- damage ----------------------------------------------------------------------------------------------------------


def cut_series(place):
    with h5py.File(place.path / "a.interrupted/run.h5", "r+") as file:
        file["series/x"].resize((3,))


def other_series(place):
    with h5py.File(place.path / "a.interrupted/run.h5", "r+") as file:
        file["series/x"][1] = 5.0


def other_frame(place):
    with h5py.File(place.path / "a.interrupted/run.h5", "r+") as file:
        file["frames/0001/x"][0] = 5


def half_series(place):
    file = place.path / "a.interrupted/run.h5"
    file.write_bytes(file.read_bytes()[:700])


DAMAGE = {
    "step": (lambda place: place.change(step=5), "checkpoint.json differs from its checksum"),
    "stage": (lambda place: place.change(note="other"), "checkpoint.json differs from its checksum"),
    "format": (
        lambda place: place.change(format=1),
        "checkpoint.json has format 1, this version of Graindrive reads 2",
    ),
    "no JSON": (lambda place: place.facts().write_text("{"), "checkpoint.json cannot be read"),
    "a list": (lambda place: place.facts().write_text("[]"), "checkpoint.json cannot be read"),
    "track": (
        lambda place: (place.facts().parent / "track.npz").write_bytes(b"x"),
        "track.npz differs from its checksum",
    ),
    "no track": (lambda place: (place.facts().parent / "track.npz").unlink(), "track.npz cannot be read"),
    "cut series": (cut_series, "run.h5 holds 3 of the 4 rows that its checkpoint needs"),
    "other series": (other_series, "run.h5 holds other series than its checkpoint needs"),
    "other frame": (other_frame, "run.h5 holds another frames/0001 than its checkpoint needs"),
    "half a file": (half_series, "run.h5 holds 0 of the 4 rows"),
    "no series": (lambda place: (place.path / "a.interrupted/run.h5").unlink(), "run.h5 holds 0 of the 4 rows"),
}


@pytest.mark.parametrize("damage, words", DAMAGE.values(), ids=list(DAMAGE))
def test_damaged_remains_are_one_line_with_the_file_and_the_way_out(place, damage, words):
    place.interrupted()
    damage(place)
    for _ in range(2):
        with pytest.raises(
            UsageError, match=f"{words}.*; remove a.interrupted or move it away to start anew"
        ) as caught:
            place.run(resume=True)
        assert "a.interrupted" in str(caught.value) and "\n" not in str(caught.value)
        assert place.names() == ["a.interrupted"]
    os.rename(place.path / "a.interrupted", place.path / "moved")
    place.run(resume=True)
    assert place.rows() == WHOLE


def test_the_series_of_another_run_are_noticed(place):
    place.interrupted()
    place.interrupted(out=str(place.path / "b"), phi=0.8)
    with h5py.File(place.path / "b.interrupted/run.h5", "r+") as file:
        file["series/x"][:] += 1
    shutil.copy(place.path / "b.interrupted/run.h5", place.path / "a.interrupted/run.h5")
    with pytest.raises(UsageError, match="run.h5 holds other series"):
        place.run(resume=True)


def test_whole_remains_serve_where_further_ones_are_damaged(place, capsys):
    place.interrupted(checkpoint_at=5)
    os.rename(place.path / "a.interrupted", place.path / "a.failed")
    place.interrupted(checkpoint_at=2)
    other = place.path / "a.failed/checkpoint-000000000005/track.npz"
    other.write_bytes(b"")
    with place.open(resume=True) as folder:
        assert folder.resumed["step"] == 2
        go_on(folder, None, 6)
    assert place.rows() == WHOLE and "track.npz differs from its checksum; it is not used" in capsys.readouterr().err


def test_remains_of_other_parameters_and_of_other_names_are_left_alone(place):
    place.interrupted(phi=0.5)
    place.interrupted(out=str(place.path / "a.b"))
    place.run(resume=True)
    assert place.names() == ["a", "a.b.interrupted", "a.interrupted"] and place.rows() == WHOLE


def test_runs_that_fail_again_and_again_leave_one_folder(place):
    def fails_at(step, **keys):
        with pytest.raises(RuntimeError, match="^failed in the study$"), place.open(**keys) as folder:
            with pytest.raises(KeyboardInterrupt):
                go_on(folder, step, step - 1)
            raise RuntimeError("failed in the study")

    place.interrupted()
    for step in (6, 7, 7, 7):
        fails_at(step, resume=True)
    assert place.names() == ["a.failed"] and place.rows("a.failed") == WHOLE[:7]
    place.run(resume=True)
    assert place.names() == ["a"] and place.rows() == WHOLE


def test_a_run_that_goes_on_in_another_version_says_so(place, capsys, monkeypatch):
    before = provenance.code_version()
    place.interrupted()
    monkeypatch.setattr("graindrive.runs.provenance.code_version", lambda: "9.9")
    place.run(resume=True)
    assert "this is version 9.9; the result will come from both" in capsys.readouterr().err
    with h5py.File(place.path / "a/run.h5") as file:
        assert file["provenance"].attrs["code_version_before"] == before


@pytest.mark.parametrize("ending", ["failed", "failed-2", "interrupted", "interrupted-7"])
@pytest.mark.parametrize("end", ["good", "interrupted"])
def test_a_finished_run_that_bears_the_name_of_remains_stays(place, ending, end):
    place.run(out=str(place.path / f"a.{ending}"))
    if end == "good":
        place.run(resume=True)
    else:
        place.interrupted(resume=True)
        place.run(resume=True)
    assert place.names() == ["a", f"a.{ending}"]
    assert place.rows() == place.rows(f"a.{ending}") == WHOLE


@pytest.mark.parametrize("file", ["summary.json", "figure.png"])
def test_a_finished_run_with_the_name_of_remains_stays_even_if_a_file_of_it_is_gone(place, file):
    place.run(out=str(place.path / "a.failed"))
    (place.path / "a.failed" / file).unlink()
    place.run(resume=True)
    assert place.names() == ["a", "a.failed"]


def test_remains_that_lack_only_their_figure_still_give_way(place):
    place.interrupted()
    with h5py.File(place.path / "a.interrupted/run.h5", "r+") as file:
        file.attrs["state"] = "complete"  # like a run that was killed during drawing
    place.run(resume=True)
    assert place.names() == ["a"] and place.rows() == WHOLE


# ---- places ----------------------------------------------------------------------------------------------------------


def test_a_link_is_followed_at_the_start(place):
    (place.path / "disk").mkdir()
    (place.path / "disk/empty").mkdir()
    (place.path / "a").symlink_to(place.path / "disk/empty")
    place.run()
    assert place.rows("disk/empty") == WHOLE and (place.path / "a").is_symlink()
    with pytest.raises(AlreadyComplete):
        place.run()
    place.run(redo=True)
    assert sorted(p.name for p in (place.path / "disk").iterdir()) == ["empty"]


def test_a_dangling_link_is_refused_at_the_start(place):
    (place.path / "a").symlink_to(place.path / "nowhere")
    with pytest.raises(
        UsageError, match="is a link to .*nowhere, which does not exist; make that folder or remove the link"
    ):
        place.open()


@pytest.mark.parametrize("kind", ["part-7", "old-1", "gone-123"])
def test_a_name_that_the_next_run_would_clear_away_is_refused_at_the_start(place, kind):
    with pytest.raises(
        UsageError, match=f"out=.*/.a.{kind} is a name of the hidden folders of unfinished runs.*dot out"
    ):
        place.open(out=str(place.path / f".a.{kind}"))
    place.open(out=str(place.path / f"a.{kind}"))


def test_a_mount_point_is_refused_at_the_start(place, monkeypatch):
    with pytest.raises(UsageError, match="out=/proc is a mount point, .*; give one below it, out=/proc/run"):
        place.open(out="/proc")
    (place.path / "a").mkdir()
    monkeypatch.setattr(os.path, "ismount", lambda path: str(path).endswith("/a"))
    with pytest.raises(UsageError, match="is a mount point"):
        place.open()


@pytest.mark.parametrize(
    "out, words",
    [("/", "is not the name of a run folder"), ("~nosuchuser/x", "names a home"), ("n" * 240, "240|bytes")],
)
def test_a_name_that_no_run_folder_can_take_at_the_end_is_refused_at_the_start(place, out, words):
    with pytest.raises(UsageError, match=words):
        place.open(out=out)


@pytest.mark.parametrize("file", ["run.h5", "summary.json"])
def test_a_damaged_finished_run_is_named_and_made_again_with_redo(place, file):
    place.run()
    target = place.path / "a" / file
    target.write_bytes(target.read_bytes()[:-20])
    with pytest.raises(UsageError, match=f"holds a damaged run: .*{file} cannot be read .*redo=1 makes the run again"):
        place.run()
    place.run(redo=True)
    assert place.names() == ["a", "a.damaged"] and place.rows() == WHOLE


def test_damage_in_any_dataset_of_a_finished_run_is_found(place):
    """The series are compressed, so that a changed byte does not pass for a number."""
    place.run()
    with h5py.File(place.path / "a" / "run.h5") as file:
        names = []
        file.visit(lambda name: names.append(name) if isinstance(file[name], h5py.Dataset) else None)
        chunks = {name: file[name].id.get_chunk_info(0) for name in names if file[name].chunks}
    name, chunk = max(chunks.items())  # not the first that is read
    content = bytearray((place.path / "a" / "run.h5").read_bytes())
    for k in range(chunk.byte_offset, chunk.byte_offset + chunk.size):
        content[k] ^= 0x5A
    (place.path / "a" / "run.h5").write_bytes(content)
    assert name != min(names)
    with pytest.raises(UsageError, match="holds a damaged run: .*run.h5 cannot be read"):
        place.run()


def test_a_run_of_another_study_with_the_same_keys_is_refused_by_name(place):
    place.run()
    other = RunFolder(Parameters(out=str(place.path / "a")), study="toy2", figure=draw)
    with pytest.raises(UsageError, match="holds a run of the study toy; give another out= or move it away"):
        other.__enter__()


# ---- what is on the disk when a name appears -------------------------------------------------------------------------


def test_files_are_synced_before_they_get_their_name_and_folders_after(tmp_path, monkeypatch):
    done, fsync, replace = [], os.fsync, os.replace
    monkeypatch.setattr(os, "fsync", lambda f: done.append(os.readlink(f"/proc/self/fd/{f}")) or fsync(f))
    monkeypatch.setattr(os, "replace", lambda a, b: done.append("renamed") or replace(a, b))
    whole_files.write_text(tmp_path / "summary.json", "{}")
    assert done == [str(tmp_path / ".summary.json.tmp"), "renamed", str(tmp_path)]


def test_a_file_that_cannot_be_written_leaves_the_old_one(tmp_path):
    (tmp_path / "x").write_text("old")
    with pytest.raises(ZeroDivisionError), whole_files.written(tmp_path / "x") as temporary:
        temporary.write_text("new")
        1 / 0
    assert [p.name for p in tmp_path.iterdir()] == ["x"] and (tmp_path / "x").read_text() == "old"


def test_a_checkpoint_replaces_the_older_one_only_when_it_is_whole(tmp_path):
    facts = dict(digest="d", rows=0, items={}, series="s")
    checkpoint.write(tmp_path, lambda place: (place / "x").write_text("1"), dict(facts, step=1))
    with pytest.raises(FileNotFoundError, match="no/x"):
        checkpoint.write(tmp_path, lambda place: (place / "no/x").write_text("2"), dict(facts, step=2))
    (folder,) = checkpoint.folders(tmp_path)
    assert checkpoint.read(folder)["step"] == 1
    checkpoint.write(tmp_path, lambda place: (place / "x").write_text("2"), dict(facts, step=2))
    (folder,) = checkpoint.folders(tmp_path)
    assert checkpoint.read(folder)["step"] == 2


def test_two_processes_do_not_start_in_one_folder_at_once(tmp_path):
    import fcntl

    with run_place.held(tmp_path):
        other = os.open(tmp_path, os.O_RDONLY)
        with pytest.raises(BlockingIOError):
            fcntl.flock(other, fcntl.LOCK_EX | fcntl.LOCK_NB)
        os.close(other)
