"""The results of the kill campaign: what counts as lost, different, failed or wedged (not resumable)."""

import json
import shutil

import h5py
import numpy as np
import pytest

from graindrive.commands import killtest


@pytest.fixture
def subject(tmp_path):
    """A complete run of 10 rows and a frame, and a resumed one with the same contents."""
    for folder in (tmp_path / "whole", tmp_path / "trial/run"):
        folder.mkdir(parents=True)
        with h5py.File(folder / "run.h5", "w") as file:
            file["series/x"] = np.arange(10.0)
            file["frames/0001/x"] = np.ones(3)
            file["frames/0001"].attrs["t"] = 0.5
            file["parameters/out"] = str(folder)
        (folder / "summary.json").write_text(json.dumps(dict(drag=1.5, wall_s=len(str(folder)))))
    return killtest.Subject("toy", tmp_path, tmp_path / "whole", 1.0)


def judged(subject, code=0, words=("",)):
    return {k: v for k, v in killtest.judge(subject, subject.place / "trial/run", code, words).items() if v}


def change(subject, action):
    with h5py.File(subject.place / "trial/run/run.h5", "r+") as file:
        action(file)


def test_the_same_data_are_no_fault_whatever_the_time_they_took(subject):
    assert judged(subject) == {}


def test_a_missing_row_and_a_changed_bit_are_counted(subject):
    def flip(file):
        file["series/x"][9] = np.nextafter(9.0, 10.0)  # changes the last bit

    change(subject, flip)
    assert judged(subject) == {"differing bits": 1}
    change(subject, lambda file: file.pop("series/x"))
    change(subject, lambda file: file.create_dataset("series/x", data=np.arange(8.0)))
    assert judged(subject)["lost rows"] == 2


def test_a_missing_frame_another_time_and_another_summary_are_counted(subject):
    change(subject, lambda file: file["frames/0001"].attrs.update(t=0.75))
    assert judged(subject) == {"differing bits": 1}  # of the exponents of 0.5 and 0.75 none, of the mantissas one
    change(subject, lambda file: file.pop("frames/0001"))
    assert judged(subject)["differing bits"] == 3 * 64 + 64  # three numbers and the time
    (subject.place / "trial/run/summary.json").write_text(json.dumps(dict(drag=1.25)))
    assert judged(subject)["differing bits"] == 4 * 64 + 64


def test_tracebacks_exit_codes_and_litter_are_counted(subject):
    assert judged(subject, words=["fine", "Traceback (most recent call last)"]) == {"tracebacks": 1}
    assert judged(subject, code=2) == {"wedged": 1}
    (subject.place / "trial/.run.part-1").mkdir()
    assert judged(subject) == {"wedged": 1}
    shutil.rmtree(subject.place / "trial/run")
    assert judged(subject) == {"wedged": 1}
