"""Series, items and their union: what is written is read back, and files can be read at any time during a run."""

import json
from types import SimpleNamespace

import h5py
import numpy as np
import pytest

from graindrive.runs import run_data, run_folder
from graindrive.base.errors import UsageError
from graindrive.parameters import StudyParameters
from graindrive.runs.run_folder import RunFolder, plain


def test_series_take_rows_and_blocks_of_rows(tmp_path):
    writer = run_data.SeriesWriter(tmp_path / "s.h5", {"t": "s", "x": "m"})
    writer.append(t=0, x=1)
    writer.append(t=np.arange(1, 10001), x=np.ones(10000))
    writer.close()
    series, units = run_data.read_series(tmp_path / "s.h5")
    assert np.array_equal(series["t"], np.arange(10001)) and units == {"t": "s", "x": "m"}


@pytest.mark.parametrize(
    "columns", [{"t": 1}, {"t": 1, "x": 1, "y": 1}, {"t": [1, 2], "x": [1]}, {"t": [[1]], "x": [[1]]}]
)
def test_series_refuse_what_does_not_fit(tmp_path, columns):
    writer = run_data.SeriesWriter(tmp_path / "s.h5", {"t": "s", "x": "m"})
    with pytest.raises(ValueError, match="series"):
        writer.append(**columns)
    assert writer.rows == 0
    writer.close()


def test_series_can_be_read_while_they_grow(tmp_path):
    writer = run_data.SeriesWriter(tmp_path / "s.h5", {"t": "s"})
    writer.append(t=np.arange(5))
    writer.flush()
    assert len(run_data.read_series(tmp_path / "s.h5")[0]["t"]) == 5
    writer.append(t=np.arange(5))
    writer.flush()
    assert len(run_data.read_series(tmp_path / "s.h5")[0]["t"]) == 10
    writer.close()


def test_merge_makes_one_plain_file(tmp_path):
    writer = run_data.SeriesWriter(tmp_path / "run.h5", {"t": "s"})
    writer.append(t=np.arange(5))
    writer.close()
    run_data.write_item(
        tmp_path / "items", "frames/0001", {"x": (np.zeros(2000), "d"), "contacts/i": np.arange(3)}, {"t": 1.5}
    )
    run_data.write_item(tmp_path / "items", "fields/phase/03", {"v": [1, 2]})
    run_data.merge(tmp_path / "run.h5", tmp_path / "run.h5", sorted((tmp_path / "items").iterdir()), lambda file: None)
    with h5py.File(tmp_path / "run.h5") as file:
        assert file["frames/0001"].attrs["t"] == 1.5 and file["frames/0001/x"].attrs["unit"] == "d"
        assert list(file["frames/0001/contacts/i"]) == [0, 1, 2] and list(file["fields/phase/03/v"]) == [1, 2]
        file_ends = file["series/t"]
        assert list(file_ends) == [0, 1, 2, 3, 4] and file_ends.maxshape == (None,)


def test_summaries_are_flat_and_finite():
    assert plain({"a": np.float64("nan"), "b": np.int64(3), "c": "disk", "d": float("inf")}) == {
        "a": None,
        "b": 3,
        "c": "disk",
        "d": None,
    }
    with pytest.raises(TypeError, match="summary quantity a must be a number or a word, got list"):
        plain({"a": [1]})


class TestFolder:
    """A run folder from start to end in one process, without YADE."""

    def folder(self, path, **parameters):
        return RunFolder(StudyParameters(out=str(path), **parameters), study="test")

    def test_parents_are_made_and_removed_again(self, tmp_path):
        with pytest.raises(UsageError, match="too big"), self.folder(tmp_path / "a/b/c"):
            raise UsageError("too big")
        assert list(tmp_path.iterdir()) == []
        with self.folder(tmp_path / "a/b/c"):
            pass
        assert sorted(p.name for p in (tmp_path / "a/b/c").iterdir()) == ["run.h5", "summary.json"]

    def test_an_empty_folder_is_used_and_a_full_one_is_not(self, tmp_path):
        (tmp_path / "empty").mkdir()
        with self.folder(tmp_path / "empty"):
            pass
        (tmp_path / "full").mkdir()
        (tmp_path / "full/thesis.tex").write_text("years of work")
        for parameters in ({}, {"redo": True}):
            with pytest.raises(UsageError, match="holds something other"), self.folder(tmp_path / "full", **parameters):
                pass
        assert [p.name for p in (tmp_path / "full").iterdir()] == ["thesis.tex"]

    def test_a_folder_that_appears_meanwhile_is_not_overwritten(self, tmp_path):
        with pytest.raises(UsageError, match="complete and kept in .*a.complete"):
            with self.folder(tmp_path / "a"):
                (tmp_path / "a").mkdir()
                (tmp_path / "a/other").write_text("")
        assert (tmp_path / "a.complete/summary.json").exists() and (tmp_path / "a/other").exists()

    def test_interrupted_runs_do_not_overwrite_each_other(self, tmp_path):
        for _ in range(2):
            with pytest.raises(KeyboardInterrupt), self.folder(tmp_path / "a") as folder:
                folder.frame(0.0, {"x": np.zeros(3)})
                raise KeyboardInterrupt
        assert sorted(p.name for p in tmp_path.iterdir()) == ["a.interrupted", "a.interrupted-2"]


def test_a_resumed_run_took_the_time_of_its_earlier_sessions_too(tmp_path, monkeypatch):
    now = SimpleNamespace(seconds=0.0)
    monkeypatch.setattr(
        run_folder, "time", SimpleNamespace(monotonic=lambda: now.seconds, process_time=lambda: 2 * now.seconds)
    )
    for session, seconds in enumerate((40, 30)):
        parameters = StudyParameters(out=str(tmp_path / "a"), resume=session > 0)
        with pytest.raises(KeyboardInterrupt), RunFolder(parameters, study="toy") as folder:
            now.seconds += seconds
            folder.checkpoint(lambda place: None, 10 * (session + 1))
            now.seconds += 5  # these steps are made again
            raise KeyboardInterrupt
        now.seconds += 1000  # no process runs it
    with RunFolder(StudyParameters(out=str(tmp_path / "a"), resume=True), study="toy"):
        now.seconds += 25
    summary = json.loads((tmp_path / "a" / "summary.json").read_text())
    assert summary["wall_s"] == 40 + 30 + 25 and summary["core_seconds"] == 2 * summary["wall_s"]
    assert 10 < summary["peak_memory"] < 1e5  # MB, of this Python


def test_a_disk_that_fills_up_keeps_the_first_error_and_names_the_folder(tmp_path, monkeypatch, capsys):
    def full(*_):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(run_data, "merge", full)
    with pytest.raises(RuntimeError, match="the engine's own"):
        with RunFolder(StudyParameters(out=str(tmp_path / "a")), study="toy") as folder:
            folder.declare_series(t="s")
            folder.append(t=1)
            raise RuntimeError("the engine's own")
    assert f"the data so far are in {folder.path}, unfinished" in capsys.readouterr().err
    assert run_data.read_series(folder.path / "run.h5")[0]["t"][0] == 1


def test_quantities_without_a_value_are_named_on_stderr(tmp_path, capsys):
    with RunFolder(StudyParameters(out=str(tmp_path / "run")), study="toy") as folder:
        folder.summarize(slope=float("nan"), slope_err=float("nan"), depth=1.0, depth_err=float("nan"), speed=None)
    assert "toy: the run gives no value of slope, speed: null in summary.json" in capsys.readouterr().err
    assert json.loads((tmp_path / "run" / "summary.json").read_text())["slope"] is None
