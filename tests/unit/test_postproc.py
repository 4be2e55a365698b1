"""Reading run folders, and drawing the wiggle figure from their contents only."""

import subprocess
import sys

import numpy as np
import pytest

from graindrive.parameters import StudyParameters, quantity
from graindrive.postproc import __main__ as command
from graindrive.postproc.reader import Run, RunError
from graindrive.postproc.wiggle import figure
from graindrive.runs.run_folder import RunFolder


class Parameters(StudyParameters):
    shape: str = quantity("triangle", "-", "outline")
    amplitude: float = quantity(3.0, "d", "amplitude")
    period: float = quantity(4.0, "sqrt(d/g)", "period")
    width: float = quantity(20.0, "d", "width of the box")


@pytest.fixture
def run_folder(tmp_path):
    return make(tmp_path / "run")


def make(out, *, frames=2, study="wiggle_triangle", contacts=True, width=20.0):
    """Write a run of 25 periods rising at 0.01 sqrt(g d), with a square lattice of grains around a diamond of beads."""
    with RunFolder(Parameters(out=str(out), width=width), study=study) as folder:
        write_run(folder, frames, contacts)
    return out


def write_run(folder, frames, contacts):
    t = np.linspace(0, 100, 2001)
    folder.declare_series(t="sqrt(d/g)", x="d", y="d")
    folder.append(t=t, x=19 + 3 * np.sin(np.pi * t / 2), y=5 + 0.01 * t)
    beads = np.array([[1.0, 0], [0, 1.0], [-1.0, 0], [0, -1.0]])
    folder.write("intruder", {"beads": (beads, "d"), "bead_radius": (0.25, "d"), "outline": (1.25 * beads, "d")})
    x, y = (a.ravel() for a in np.meshgrid(np.arange(20.0), np.arange(10.0)))
    grains = dict(x=x, y=y, r=np.full(200, 0.5), vx=x / 20, vy=0 * x, spin=0 * x, role=(y == 0).astype("i1"))
    i = np.arange(199)
    links = dict(i=np.append(i, 7), j=np.append(i + 1, -1), fn=np.arange(200.0), ft=np.zeros(200))
    links.update(px=np.append(x[:-1] + 0.5, 7.0), py=np.append(y[:-1], 0.5))
    for k in range(frames):
        folder.frame(99.0 + k, grains, links if contacts else None)


def test_everything_comes_back_with_units(run_folder):
    run = Run(run_folder)
    assert (run.study, run.state, run.parameters["period"], run.units["period"]) == (
        "wiggle_triangle",
        "complete",
        4.0,
        "sqrt(d/g)",
    )
    assert len(run.series["t"]) == 2001 and run.units["y"] == "d" and "code_version" in run.provenance
    assert [run.frame(k).t for k in (0, -1)] == [99.0, 100.0]
    assert run.frame().grains["x"].shape == (200,) and run.frame().contacts["j"][-1] == -1
    assert run.frame().speed == pytest.approx(run.frame().grains["x"] / 20) and np.bincount(
        run.frame().role
    ).tolist() == [180, 20]
    assert run.group("intruder")["outline"].shape == (4, 2) and run.group("nothing") == {}
    assert run.at(50.0, "y") == [pytest.approx(5.5)] and "wall_s" in run.summary


def test_vtk_is_exported_on_request(tmp_path):
    pytest.importorskip("vtkmodules")
    with RunFolder(Parameters(out=str(tmp_path / "run"), vtk=True), study="wiggle") as folder:
        write_run(folder, 2, True)
    assert {p.name for p in (tmp_path / "run/vtk").iterdir()} >= {"grains.pvd", "grains_0002.vtp", "contacts_0001.vtp"}


def test_frames_stay_in_order_past_9999(tmp_path):
    with RunFolder(Parameters(out=str(tmp_path / "run")), study="wiggle") as folder:
        folder.frames = 9998
        for t in range(3):
            folder.frame(float(t), {"x": np.zeros(1)})
    assert [Run(tmp_path / "run").frame(k).t for k in range(3)] == [0, 1, 2]


@pytest.mark.parametrize("frame", [2, -3])
def test_a_frame_that_is_not_there(run_folder, frame):
    with pytest.raises(RunError, match=f"holds 2 frames; there is no frame {frame}"):
        Run(run_folder).frame(frame)


def test_what_is_no_run_is_refused(tmp_path):
    with pytest.raises(RunError, match="is not a run folder"):
        Run(tmp_path)
    (tmp_path / "run.h5").write_bytes(b"nonsense")
    with pytest.raises(RunError, match="cannot be read as a run"):
        Run(tmp_path)


def test_a_growing_run_shows_its_series(tmp_path):
    with RunFolder(Parameters(out=str(tmp_path / "run")), study="wiggle") as folder:
        write_run(folder, 2, True)
        folder.series.flush()
        run = Run(folder.path)
        assert run.state == "running" and len(run.series["t"]) == 2001 and run.frame_names == []
        figure.draw(folder.path)


@pytest.mark.parametrize("options", [{}, {"frames": 0}, {"contacts": False}, {"width": 300.0}])
def test_the_figure_is_drawn_from_the_folder_alone(tmp_path, options, figures_drawn):
    from matplotlib.image import imread

    out = make(tmp_path / "run", **options)
    figure.draw(out)
    image = imread(out / "figure.png")
    assert image.shape[1] == 1020, "3.4 inches at 300 dpi"
    assert image.shape[0] > (1400 if options.get("frames", 2) else 1000), "a fourth panel where there is a frame"
    assert (out / "figure.pdf").read_bytes()[:4] == b"%PDF"
    assert sorted(p.name for p in out.iterdir()) == ["figure.pdf", "figure.png", "run.h5", "summary.json"]


def test_the_figure_shows_grains_chains_and_intruder(run_folder, monkeypatch):
    """Colours in the picture: the base's grey, the chains' vermillion, the beads' black."""
    from matplotlib.image import imread

    figure.draw(run_folder, frame=0)
    pixels = (255 * imread(run_folder / "figure.png")[500:, :, :3]).astype(int).reshape(-1, 3)
    for colour in ((0xBB, 0xBB, 0xBB), (0xD5, 0x5E, 0x00), (0, 0, 0)):
        assert np.sum(np.abs(pixels - colour).sum(axis=1) < 6) > 100


def test_command_redraws(run_folder, capsys):
    assert command.main([str(run_folder), "frame=0"]) == 0 and (run_folder / "figure.png").exists()
    assert command.main([]) == 2 and command.main(["help"]) == 0 and "frame=N" in capsys.readouterr().out


@pytest.mark.parametrize(
    "extra, words",
    [
        (["frame=x"], "whole number"),
        (["frame=9"], "no frame 9"),
        (["/nowhere"], "not a run folder"),
        (["anmation=1"], "there is no key 'anmation'; allowed: frame animation export study"),
        (["frame=0", "frame=1"], "frame is given twice: frame=0 and frame=1; keep one"),
    ],
)
def test_command_mistakes_are_one_line_and_exit_2(run_folder, extra, words, capsys):
    assert command.main([str(run_folder), *extra]) == 2
    err = capsys.readouterr().err
    assert words in err and err.count("\n") == 1
    if "frame=9" not in extra:
        assert not (run_folder / "figure.png").exists(), "nothing is drawn before all is read"


def test_what_a_run_lacks_and_what_cannot_be_written_is_one_line(run_folder, monkeypatch, capsys):
    def lacking(*_):
        raise KeyError("steady_from")

    monkeypatch.setattr(command, "figure_of", lambda *_: lacking)
    assert command.main([str(run_folder)]) == 2
    assert "does not hold 'steady_from' which this needs" in capsys.readouterr().err
    (run_folder / "frames.xyz").mkdir()
    assert command.main([str(run_folder), "export=xyz"]) == 2
    err = capsys.readouterr().err
    assert "cannot be written" in err and err.count("\n") == 1


def test_command_without_a_folder_says_so(capsys):
    assert command.main(["export=xyz"]) == 2
    assert "no run folder is given" in capsys.readouterr().err


def test_command_takes_a_folder_whose_name_holds_a_key(run_folder, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    run_folder.rename(tmp_path / "seed=2")
    assert command.main(["seed=2", "frame=0"]) == 0 and (tmp_path / "seed=2/figure.png").exists()


def test_command_names_the_studies_it_can_draw(tmp_path, capsys):
    out = make(tmp_path / "run", study="weather")
    assert command.main([str(out)]) == 2
    said = capsys.readouterr().err
    assert "weather, which has no figure here; there are: " in said and " wiggle, " in said and "study=FILE" in said


def test_postproc_runs_as_a_module(run_folder):
    code = [sys.executable, "-m", "graindrive.postproc", str(run_folder)]
    assert subprocess.run(code, capture_output=True, timeout=300).returncode == 0


def test_a_run_is_filmed_frame_by_frame(run_folder):
    assert command.main([str(run_folder), "animation=1"]) == 0
    probe = ["ffprobe", "-v", "error", "-count_frames", "-show_entries", "stream=nb_read_frames", "-of", "csv=p=0"]
    counted = subprocess.run([*probe, str(run_folder / "animation.mp4")], capture_output=True, text=True, check=True)
    assert int(counted.stdout.strip().strip(",")) == len(Run(run_folder).frame_names) == 2
    assert not (run_folder / ".animation.mp4").exists()


def test_a_run_of_one_frame_is_no_film(tmp_path, capsys):
    out = make(tmp_path / "run", frames=1)
    assert command.main([str(out), "animation=1"]) == 2
    assert "holds 1 frames, a film needs more; run again with frames=200 or so" in capsys.readouterr().err
