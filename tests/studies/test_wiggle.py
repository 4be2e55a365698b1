"""The wiggle study at small size: as a command in batch mode, and its bed."""

import importlib
import json
import os
import subprocess
from pathlib import Path

import h5py
import numpy as np
import pytest

from graindrive.bodies import intruder
from graindrive.beds import packing
from graindrive.scenes import yade_march
from graindrive.base.errors import Interrupted
from graindrive.scenes.material import HertzHistoryMaterial
from graindrive.runs.run_folder import RunFolder

STUDIES = Path(__file__).resolve().parents[2] / "studies"
TINY = ["scale=smoke", "width=22", "height=14", "depth=6", "amplitude=1", "time=0.5", "period=0.5", "frames=1"]


@pytest.fixture(scope="module")
def home(tmp_path_factory):
    """A home and a cache of its own, shared by the runs of this file."""
    return tmp_path_factory.mktemp("home")


def yade(home, study, *keys, folder=None):
    """Run a study without a display from the working directory `folder`, by its command; return the finished process."""
    environment = {**os.environ, "HOME": str(home), "GRAINDRIVE_CACHE": str(home / "cache")}
    command = ["yade", "-n", "-x", str(STUDIES / study), *keys]
    return subprocess.run(command, cwd=folder or home, env=environment, capture_output=True, text=True, timeout=600)


def files_below(folder):
    """Every file below a folder, as paths relative to it."""
    return sorted(str(path.relative_to(folder)) for path in Path(folder).rglob("*") if path.is_file())


def test_a_run_leaves_one_complete_folder_and_nothing_else(home, tmp_path):
    done = yade(home, "wiggle_triangle.py", *TINY, "out=result", folder=tmp_path)
    assert done.returncode == 0, done.stderr
    assert files_below(tmp_path) == [
        "result/" + name for name in ("figure.pdf", "figure.png", "run.h5", "summary.json")
    ]
    # YADE's program makes IPython's profile before it runs any script; all else is our cache.
    assert [name for name in files_below(home) if not name.startswith(("cache/", ".ipython/"))] == []
    summary = json.loads((tmp_path / "result/summary.json").read_text())
    assert summary["shape"] == "triangle" and summary["steps"] == 1000 and 0 < summary["dt_over_critical"] < 1
    assert set(summary) >= {
        "rise_rate",
        "rise_rate_err",
        "y_final",
        "amplitude",
        "period",
        "particle_steps_per_second",
        "n_grains",
        "wall_s",
    }


def test_imposed_x_is_exact_and_y_is_free(home, tmp_path):
    assert yade(home, "wiggle_triangle.py", *TINY, "out=result", folder=tmp_path).returncode == 0
    with h5py.File(tmp_path / "result/run.h5") as file:
        t, x, y, vy = (file["series"][name][:] for name in ("t", "x", "y", "vy"))
    # Round-off of positions of 11 d: a few times 2e-15.
    assert np.abs(x - x[0] - np.sin(2 * np.pi * t / 0.5)).max() < 1e-13
    assert np.ptp(y) > 1e-3 and np.ptp(vy) > 1e-3


def test_the_same_seed_gives_the_same_run_and_another_seed_another(home, tmp_path):
    track = {}
    for name, seed in (("a", 3), ("b", 3), ("c", 4)):
        done = yade(home, "wiggle.py", *TINY, "shape=disk", f"seed={seed}", f"out={name}", folder=tmp_path)
        assert done.returncode == 0, done.stderr
        with h5py.File(tmp_path / name / "run.h5") as file:
            track[name] = file["series/y"][:]
    assert np.array_equal(track["a"], track["b"])
    assert not np.array_equal(track["a"], track["c"])


@pytest.fixture
def wiggle(monkeypatch, home):
    """The study as a module, in this process."""
    monkeypatch.setenv("GRAINDRIVE_CACHE", str(home / "cache"))
    monkeypatch.syspath_prepend(str(STUDIES))
    return importlib.import_module("wiggle")


def tiny(wiggle, **changes):
    keys = {key: value for key, value in (pair.split("=") for pair in TINY)}
    return wiggle.WiggleParameters(**{**wiggle.PRESETS["smoke"], **keys, **changes})


def series_of(folder):
    with h5py.File(folder / "run.h5") as file:
        return {name: data[:] for name, data in file["series"].items()}


@pytest.mark.parametrize("loop", ["grain", "yade"])
def test_an_interrupted_run_goes_on_as_if_it_had_not_been(wiggle, tmp_path, monkeypatch, loop):
    whole = tiny(wiggle, loop=loop, out=str(tmp_path / "whole"))
    with RunFolder(whole, study="wiggle") as folder:
        wiggle.run(whole, folder)

    advance, blocks = yade_march.advance, iter(range(7))

    def stop_in_the_seventh_block(steps):
        if next(blocks) == 6:
            raise Interrupted(15)
        return advance(steps)

    monkeypatch.setattr(yade_march, "advance", stop_in_the_seventh_block)
    parts = tiny(wiggle, loop=loop, out=str(tmp_path / "parts"), checkpoint_seconds=0)  # one after every block
    with pytest.raises(Interrupted), RunFolder(parts, study="wiggle") as folder:
        wiggle.run(parts, folder)
    monkeypatch.setattr(yade_march, "advance", advance)
    resumed = parts.copy(update={"resume": True})
    with RunFolder(resumed, study="wiggle") as folder:
        assert folder.resumed["step"] > 0
        wiggle.run(resumed, folder)

    expected, found = series_of(tmp_path / "whole"), series_of(tmp_path / "parts")
    if loop == "grain":
        assert all(np.array_equal(expected[name], found[name]) for name in expected)
    else:  # O.load changes the order of interactions and so of sums; round-off grows as between the two loops
        assert np.array_equal(expected["t"], found["t"])
        assert np.abs(expected["y"] - found["y"]).max() < 1e-6


@pytest.mark.parametrize("pressure", [0, 20])
def test_both_loops_go_the_same_way_until_chaos(wiggle, tmp_path, pressure):
    track = {}
    for loop in ("grain", "yade"):
        p = tiny(wiggle, loop=loop, lid_pressure=pressure, out=str(tmp_path / loop))
        with RunFolder(p, study="wiggle") as folder:
            wiggle.run(p, folder)
        track[loop] = series_of(tmp_path / loop)
    t, apart = track["grain"]["t"], np.abs(track["grain"]["y"] - track["yade"]["y"])
    # Round-off of 1e-15 grows tenfold in about 0.1 sqrt(d/g) once the grains collide.
    assert apart[t <= 0.1].max() < 1e-12
    assert apart.max() < 1e-6


def test_an_outline_from_a_file_is_an_intruder(home, tmp_path):
    (tmp_path / "arrow.csv").write_text("x,y\n0,0\n6,0\n4,8\n")
    done = yade(home, "wiggle.py", *TINY, "shape=arrow.csv", "out=result", folder=tmp_path)
    assert done.returncode == 0, done.stderr
    with h5py.File(tmp_path / "result/run.h5") as file:
        outline = file["intruder/outline"][:]
        # The body is drawn about its position in the series, which is its centroid.
        assert outline.mean(axis=0) == pytest.approx([0, 0], abs=1e-12)
        assert np.ptp(outline, axis=0) == pytest.approx([6, 8])
        assert (file["series/x"][0], file["series/y"][0]) == (11, 8)  # width/2, height - depth


@pytest.mark.parametrize(
    "given, said",
    [
        ("perod=3", "did you mean period?"),
        ("period=soon", "a number > 0"),
        ("period=0", "a number > 0"),
        ("width=10", "raise width or lower amplitude"),
        ("height=7", "raise height or lower depth"),
        ("depth=1", "raise depth"),
        ("dt_factor=100", "lower dt_factor"),
        ("shape=hexagram", "shape must be one of"),
        ("shape=missing.csv", "missing.csv"),
        ("out=/proc/nowhere/run", "give out="),
    ],
)
def test_bad_input_is_one_line_exit_2_and_nothing_written(home, tmp_path, given, said):
    before = files_below(home)
    done = yade(
        home,
        "wiggle_triangle.py",
        *[key for key in TINY if key.split("=")[0] != given.split("=")[0]],
        given,
        folder=tmp_path,
    )
    yades = ("Running script", "Warning: no X", "TCP python prompt")  # printed before any script runs
    own_lines = [line for line in done.stderr.splitlines() if not line.startswith(yades)]
    assert done.returncode == 2
    assert len(own_lines) == 1 and said in own_lines[0], done.stderr
    assert files_below(tmp_path) == [] and files_below(home) == before


def bed_recipe(**changes):
    body = intruder.make("square", orientation_deg=0, bead_diameter=0.5, bead_spacing=1, mass=9.0)
    values = dict(
        width=20.0,
        height=16.0,
        d_min=0.9,
        d_max=1.1,
        material=HertzHistoryMaterial(2e6, 2.46e6, 2500, 2500, 0.1, 1.0),
        **body.placed(np.array([10.0, 7.0])),
        outline_area=body.area,
        dt=5e-4,
        rest=1e-3,
        seed=1,
    )
    return packing.BedRecipe(**{**values, **changes})


def test_a_bed_rests_around_the_held_body_without_deep_overlaps(monkeypatch, tmp_path):
    monkeypatch.setenv("GRAINDRIVE_CACHE", str(tmp_path))
    bed = packing.settled_bed(bed_recipe())
    assert bed["kinetic_energy"] < 1e-3
    # Hertz under the weight of 16 layers: delta = (16/(K_n sqrt(R_eff)))^(2/3) ~ 6e-4 d; eight times that for the load on chains.
    assert bed["deepest_overlap"] < 5e-3 / 0.45
    beads = np.array(bed_recipe().beads)
    gap = np.hypot(bed["x"][:, None] - beads[:, 0], bed["y"][:, None] - beads[:, 1]) - bed["r"][:, None] - 0.25
    assert gap.min() > -5e-3
    inside = (np.abs(bed["x"] - 10) < 3) & (np.abs(bed["y"] - 7) < 3)
    assert not inside.any()
    assert bed["y"].min() > 0.5  # no grain fell through the base


def test_the_cache_gives_the_same_bed_back_and_knows_every_parameter(monkeypatch, tmp_path):
    monkeypatch.setenv("GRAINDRIVE_CACHE", str(tmp_path))
    first = packing.settled_bed(bed_recipe())
    monkeypatch.setattr(packing, "settle", lambda recipe: pytest.fail("the bed was built twice"))
    again = packing.settled_bed(bed_recipe())
    assert all(np.array_equal(first[name], again[name]) for name in first)
    with pytest.raises(pytest.fail.Exception):
        packing.settled_bed(bed_recipe(seed=2))


def test_a_bed_without_room_is_refused():
    with pytest.raises(Exception, match="no room for grains"):
        packing.insert(bed_recipe(height=0.5))


def test_an_outline_file_with_new_contents_is_another_run(home, tmp_path):
    outline, keys = tmp_path / "arrow.csv", [*TINY, "time=0.05", "shape=arrow.csv", "out=arrow"]
    keys.remove("time=0.5")
    outline.write_text("0,0\n6,0\n3,6\n")
    assert yade(home, "wiggle.py", *keys, folder=tmp_path).returncode == 0
    again = yade(home, "wiggle.py", *keys, folder=tmp_path)
    assert again.returncode == 0 and "is there already" in again.stderr
    outline.write_text("0,0\n6,0\n3,5\n")
    changed = yade(home, "wiggle.py", *keys, folder=tmp_path)
    assert changed.returncode == 2 and "a file that they name has changed" in changed.stderr


@pytest.mark.parametrize(
    "keys, words",
    [
        (["out=/"], "is not the name of a run folder"),
        (["frames=1e30"], "frames is a whole number"),
        (["period=1e-6"], "must be at least 40 time steps"),
        (["period=1e20", "fields=1"], "must be at most 40 times time=4"),
        (["intruder_mass=1e-9"], "of a body of mass 1e-09"),
        (["dt_factor=1e-12"], "steps, more than 1e+10; raise dt_factor or shorten the run"),
        (["dt_factor=1e9"], "lower dt_factor, to 6.5e-09 times its value or less"),
        (["shape=noise.WKT"], "shape=noise.WKT: noise.WKT: line 1 must hold two numbers x, y"),
    ],
)
def test_what_cannot_be_run_is_refused_in_one_line(home, tmp_path, keys, words):
    (tmp_path / "noise.WKT").write_bytes(b"\xff \xfe\n" * 9)
    refused = yade(home, "wiggle.py", "scale=smoke", *keys, folder=tmp_path)
    assert refused.returncode == 2 and words in refused.stderr.splitlines()[-1], refused.stderr
    assert files_below(tmp_path) == ["noise.WKT"]


@pytest.mark.parametrize("loop", ["grain", "yade"])
def test_frames_are_even_in_time_and_show_the_contacts_of_their_moment(wiggle, tmp_path, loop):
    """Frames in 1000 steps with blocks of 30 steps: at every 250th step, or about every 167th, also within blocks."""
    for count in (5, 7):
        p = tiny(wiggle, loop=loop, frames=count, period=0.6, out=str(tmp_path / str(count)))
        with RunFolder(p, study="wiggle") as folder:
            wiggle.run(p, folder)
        with h5py.File(tmp_path / str(count) / "run.h5") as file:
            frames = [file["frames"][name] for name in sorted(file["frames"])]
            times = np.array([frame.attrs["t"] for frame in frames])
            dt = file["provenance"].attrs["dt"]
            # Each to half a time step.
            np.testing.assert_allclose(times, np.linspace(0, 0.5, count), rtol=0, atol=0.51 * dt)
            assert -1 in frames[0]["contacts/j"][:], "the settled bed touches the body"
            for frame in frames:
                assert_contacts_are_overlapping_pairs(frame, 22.0)


def assert_contacts_are_overlapping_pairs(frame, width):
    """Contacts of grains and base, without pairs of two frozen ones."""
    x, y, r, role = (frame[name][:] for name in ("x", "y", "r", "role"))
    dx = x[:, None] - x
    dx -= width * np.round(dx / width)
    overlap = r[:, None] + r - np.hypot(dx, y[:, None] - y)
    touch = np.triu((overlap > 0) & ~((role[:, None] > 0) & (role > 0)), 1)
    i, j = frame["contacts/i"][:], frame["contacts/j"][:]
    found = {tuple(sorted(pair)) for pair in zip(i, j) if min(pair) >= 0}
    assert found == set(zip(*np.nonzero(touch))) and len(found) > 20
