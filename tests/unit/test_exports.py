"""Frames for other programs: formats, file names, complete files or none, and the contents of extended XYZ."""

import extended_xyz
import h5py
import numpy as np
import pytest
from made_up_frames import PERIOD, Parameters, disks, made_up_run

from graindrive.exports import exports, text_exports
from graindrive.base.errors import UsageError
from graindrive.parameters import StudyParameters
from graindrive.postproc import __main__ as command
from graindrive.commands import headless
from graindrive.commands.command_line import parameters_or_exit, parse
from graindrive.postproc.reader import Run
from graindrive.runs.run_folder import RunFolder
from graindrive.study import Study, house, loaded


@pytest.fixture(scope="module")
def finished(tmp_path_factory):
    return made_up_run(tmp_path_factory.mktemp("runs") / "run")


def rounded(values):
    """Return numbers rounded to 12 digits."""
    return np.array([float(text_exports.DIGITS % v) for v in np.ravel(values)]).reshape(np.shape(values))


@pytest.mark.parametrize("period", [PERIOD, 0.0])
def test_extended_xyz_holds_all_disks_of_all_frames_in_one_box(tmp_path, period):
    run = Run(made_up_run(tmp_path / "run", period=period, export="xyz"))
    frames = extended_xyz.read((run.path / "frames.xyz").read_text())
    assert len(frames) == 3
    for k, (settings, columns) in enumerate(frames):
        disks = run.frame(k).disks()
        x = np.mod(disks["x"], period) if period else disks["x"]
        assert settings["Time"] == 2.0 * k and settings["pbc"] == [period > 0, False, False]
        assert settings["length_unit"] == "d" and settings["time_unit"] == "sqrt(d/g)"
        assert np.array_equal(columns["pos"], rounded(np.c_[x, disks["y"], 0 * x]))
        assert np.array_equal(columns["velo"], rounded(np.c_[disks["vx"], disks["vy"], 0 * x]))
        expected = dict(id=disks["id"], type=disks["role"], radius=rounded(disks["r"]), spin=rounded(disks["spin"]))
        assert all(np.array_equal(columns[name], values) for name, values in expected.items())
        lattice, low = settings["Lattice"], settings["Origin"]
        assert np.array_equal(lattice, np.diag(np.diag(lattice))), "a rectangular box"
        reach = disks["r"][:, None] * [0 if period else 1, 1, 1]
        # The box is written with 12 digits, like the positions.
        assert (columns["pos"] - reach >= low - 1e-10).all() and (
            columns["pos"] + reach <= low + np.diag(lattice) + 1e-10
        ).all()
        assert not period or (lattice[0, 0], low[0]) == (period, 0)
        assert np.array_equal(lattice, frames[0][0]["Lattice"])


def test_a_run_exports_what_its_keys_ask_for(tmp_path):
    def written(**keys):
        out = made_up_run(tmp_path / "-".join(map(str, keys.values())), **keys)
        return {p.name for p in out.iterdir()} - {"run.h5", "summary.json"}

    assert written(export="") == set()
    assert written(vtk=True) == {"vtk"} and written(export="vtk") == {"vtk"}
    assert written(export="xyz, lammps", vtk=True) == {"vtk", "frames.xyz", "frames.lammpstrj"}


def test_the_folder_for_paraview_holds_frames_body_and_fields(finished):
    exports.write(finished, ["vtk"])
    names = {p.name for p in (finished / "vtk").iterdir()}
    kinds = {f"{kind}.pvd" for kind in ("grains", "contacts", "intruder", "fields_around")}
    assert names >= kinds | {"grains_0003.vtp", "contacts_0003.vtp", "intruder_0003.vtp", "fields_around_01.vti"}
    assert not list(finished.glob(".*"))


def test_a_finished_run_is_exported_by_the_command_and_draws_nothing(finished, capsys):
    assert command.main([str(finished), "export=xyz,lammps"]) == 0
    assert (finished / "frames.xyz").exists() and (finished / "frames.lammpstrj").exists()
    assert not (finished / "figure.png").exists() and "writing frames.xyz, frames.lammpstrj" in capsys.readouterr().out


def test_a_run_without_frames_writes_no_empty_files_and_says_so(tmp_path, capsys):
    with RunFolder(StudyParameters(out=str(tmp_path / "run"), export="vtk,xyz"), study="toy") as folder:
        folder.declare_series(t="s")
        folder.append(t=1.0)
    assert {p.name for p in (tmp_path / "run").iterdir()} == {"run.h5", "summary.json"}
    said = capsys.readouterr().err
    assert (
        f"graindrive: {tmp_path}/run holds no frames: there is nothing for export=xyz; leave it out, or have the"
        in said
    )
    assert ".part" not in said, "the folder's hidden name"
    assert command.main([str(tmp_path / "run"), "export=vtk"]) == 2
    assert "holds no frames and no fields: there is nothing for export=vtk" in capsys.readouterr().err


@pytest.mark.parametrize("name", ["shear", "rounding", "extremes"])
@pytest.mark.parametrize("asked", ["export=xyz", "vtk=1"])
def test_a_study_without_frames_refuses_exports_before_the_run(name, asked):
    with pytest.raises(
        UsageError, match=f"^{asked} needs pictures of grains, and runs of {name} keep none; leave it out"
    ):
        parse(loaded(house()[name]), [asked], environment={})
    assert parse(loaded(house()["wiggle"]), [asked], environment={}).exports == (
        asked.replace("=1", "").split("=")[-1],
    )


def test_an_export_asked_for_later_is_written_for_the_finished_run(tmp_path, capsys):
    def run(p, folder):
        grains = disks(np.random.default_rng(1), [0, 1], [1.0, 3.0], [1.0, 1.0], role=np.zeros(2, dtype=int))
        folder.frame(0.5, grains, period=PERIOD)

    study = Study("toy", Parameters, {"demo": {}}, run=run)

    def call(*arguments):
        p = parse(study, [f"out={tmp_path}/run", *arguments], environment={})
        return headless.guarded(lambda: headless.carry_out(study, p), study.name)

    assert call() == 0 and not (tmp_path / "run" / "frames.xyz").exists()
    assert call("export=xyz") == 0
    assert "toy: wrote frames.xyz\ntoy: " in capsys.readouterr().err
    assert len(extended_xyz.read((tmp_path / "run" / "frames.xyz").read_text())) == 1
    assert call("export=xyz") == 0 and "wrote" not in capsys.readouterr().err


def test_an_older_export_stays_until_the_new_one_is_whole(tmp_path, monkeypatch):
    out = made_up_run(tmp_path / "run", export="vtk,xyz")
    before = {p: p.read_bytes() for p in out.rglob("*.*") if p.is_file()}

    def full(*_args, **_options):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(text_exports, "write_rows", full)
    monkeypatch.setattr(exports.vtk_export, "outline", full)
    for name in ("xyz", "vtk"):
        with pytest.raises(OSError, match="No space left on device"):
            exports.write(out, [name])
    assert all(path.read_bytes() == content for path, content in before.items())


@pytest.mark.parametrize("given, words", [("xzy", "got 'xzy'"), ("vtk;xyz", "comma list of vtk, xyz, lammps")])
def test_an_unknown_format_is_refused_with_those_that_there_are(finished, given, words, capsys):
    with pytest.raises(SystemExit) as refused:
        parameters_or_exit(Study("test", StudyParameters, {"demo": {}}, run=None), [f"export={given}"])
    said = capsys.readouterr().err
    assert refused.value.code == 2 and words in said and said.count("\n") == 1
    assert command.main([str(finished), f"export={given}"]) == 2
    assert words in capsys.readouterr().err


def test_frames_of_older_versions_are_refused(tmp_path, capsys):
    out = made_up_run(tmp_path / "run")
    with h5py.File(out / "run.h5", "r+") as file:
        del file["frames/0001"].attrs["period"]
    assert command.main([str(out), "export=xyz"]) == 2
    assert "frames of an older version, without the box's period; make the run again" in capsys.readouterr().err


def test_paraviews_files_need_vtk(monkeypatch, tmp_path):
    def missing():
        raise UsageError("files for ParaView (vtk=1) need VTK for Python")

    monkeypatch.setattr(exports.vtk_export, "modules", missing)
    with pytest.raises(UsageError, match="need VTK"):
        made_up_run(tmp_path / "run", export="vtk")
    assert list(tmp_path.iterdir()) == []
