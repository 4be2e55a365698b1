"""The pages of studies/guides, followed exactly in an empty folder."""

import glob
import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from guide_pages import GUIDES, TOP, apply_changes, blocks, follow, write_files

from graindrive.postproc.reader import Run

needs_snakemake = pytest.mark.skipif(shutil.which("snakemake") is None, reason="needs snakemake")
needs_compiler = pytest.mark.skipif(
    shutil.which("g++") is None or shutil.which("patch") is None, reason="needs g++, patch"
)
FLAGS = "-std=c++17 -O0 -Wall -Wextra -Werror -DEIGEN_MAX_ALIGN_BYTES=16 -DEIGEN_MAX_STATIC_ALIGN_BYTES=16".split()
WITH_YADE = "-fPIC -Wno-psabi -DBOOST_ALLOW_DEPRECATED_HEADERS -DBOOST_BIND_GLOBAL_PLACEHOLDERS".split()


def test_the_index_names_every_page_and_every_page_says_what_to_look_at():
    index = (GUIDES / "README.md").read_text()
    pages = {path.name for path in GUIDES.glob("*.md")} - {"README.md"}
    assert {name for name in pages if f"({name})" in index} == pages and len(pages) == index.count(".md) |")
    assert all("\n## What to look at\n" in (GUIDES / name).read_text() for name in pages)


def test_a_shape_of_ones_own_in_a_plane_and_in_space(tmp_path):
    follow("shape.md", tmp_path)
    wiggle, lift = Run(tmp_path / "arrow-run"), Run(tmp_path / "rod-run")
    assert wiggle.state == lift.state == "complete" and wiggle.parameters["shape"] == "arrow.csv"
    assert lift.summary["body_height"] == pytest.approx(3, abs=0.2)  # between points a tenth of d apart
    assert (tmp_path / "arrow-run/figure.png").exists() and (tmp_path / "rod-run/figure.png").exists()


def test_solids_in_scripts_of_yade(tmp_path):
    """The drum's spheres weigh 60 x 1.3 g and stand at most 0.1 m beside its axis: their torque stays below 0.08 N m."""
    said = follow("solid.md", tmp_path)
    force, contacts = re.search(r"on the cylinder (-[0-9.]+) N by (\d+) contacts", said).groups()
    assert -0.1 < float(force) < -0.003 and int(contacts) > 100  # the spheres above the cylinder weigh 0.1 N
    contacts, torque = re.search(r"(\d+) contacts; torque on the drum (\S+) N m", said).groups()
    assert int(contacts) > 5 and 0 < abs(float(torque)) < 0.08


@needs_snakemake
def test_a_study_of_ones_own_and_its_campaign(tmp_path):
    said = follow("study.md", tmp_path)
    assert "oscillator.py [key=value …]" in said and "oscillator/report.md" in said
    assert json.loads((tmp_path / "first/summary.json").read_text())["energy_left_unit"] == "-"
    assert list(pd.read_csv(tmp_path / "oscillator/table.csv")["damping"]) == [0.05, 0.1, 0.2]
    assert (tmp_path / "oscillator/figures/oscillator-damping-energy_left.png").exists()


def test_frames_for_other_programs(tmp_path):
    pytest.importorskip("vtkmodules")
    follow("look.md", tmp_path)
    listed = (tmp_path / "look/vtk/grains.pvd").read_text()
    frames = (tmp_path / "look/frames.xyz").read_text().count("Lattice=")
    assert listed.count("<DataSet") == frames == 20 and (tmp_path / "look/frames.lammpstrj").exists()
    assert (tmp_path / "look/vtk/contacts.pvd").exists() and (tmp_path / "look/vtk/intruder.pvd").exists()
    compile((tmp_path / "picture.py").read_text(), "picture.py", "exec")


def test_a_study_with_grains_on_both_loops(tmp_path):
    """The same scene on the other loop gives the same drag within twice the errors of both."""
    said = follow("grains.md", tmp_path)
    near, reference = Run(tmp_path / "near").summary, Run(tmp_path / "reference").summary
    assert "pair.py [key=value …]" in said and near["drag"] > 3 * near["drag_err"] > 0
    assert abs(near["drag"] - reference["drag"]) < 2 * np.hypot(near["drag_err"], reference["drag_err"])
    first = (tmp_path / "near/frames.xyz").read_text().splitlines()[1]
    assert 'length_unit="d"' in first and 'time_unit="sqrt(d/g)"' in first


@needs_snakemake
def test_a_new_observable_stands_in_a_report_without_and_with_a_claim(tmp_path):
    said = follow("observable.md", tmp_path)
    plain, claims = (tmp_path / "plain.md").read_text(), (tmp_path / "walk/report.md").read_text()
    assert "| hops | runs | distance [d] | spread [d^2] |" in plain and "(figures/plain-length-spread.png)" in plain
    assert "Of 1 claims: 1 reproduced" in claims and "6 of 6 runs are there already" in said
    assert (tmp_path / "walk/figures/plain-length-spread.png").exists()
    assert (tmp_path / "walk/figures/claims-growth.png").exists()


# A stand-in for the parts of Slurm that the page's profile uses: jobs run at once, and have ended when sbatch returns.
SLURM = {
    "sbatch": 'echo "$@" >>"$HOME/submitted"; bash "${@: -1}" >/dev/null 2>&1; echo $$',
    "sacct": "echo '  COMPLETED '",
    "scancel": "exit 1",
}


@needs_snakemake
def test_a_campaign_goes_through_a_slurm_profile(tmp_path):
    programs = tmp_path / "programs"
    programs.mkdir()
    for name, text in SLURM.items():
        (programs / name).write_text(f"#!/bin/bash\n{text}\n")
        (programs / name).chmod(0o755)
    follow("cluster.md", tmp_path, programs)
    submitted = (tmp_path / "submitted").read_text().splitlines()
    assert len(submitted) == 4 and all(
        "--parsable --partition=short --cpus-per-task=1 --mem=2000" in s for s in submitted
    )
    assert len(pd.read_csv(tmp_path / "toss/table.csv")) == 4 and "heads" in (tmp_path / "toss/report.md").read_text()


# ---- C++ -------------------------------------------------------------------------------------------------------------


def compiled(place, *arguments):
    """Compile with the headers of `place` before those of the checkout; a failure shows the compiler's output."""
    headers = ["-I", str(place), "-I", str(TOP), "-isystem", "/usr/include/eigen3"]
    done = subprocess.run(["g++", *FLAGS, *headers, *map(str, arguments)], cwd=place, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr


@needs_compiler
def test_a_new_law_is_known_to_registry_spheres_and_functors(tmp_path):
    apply_changes("law.md", tmp_path)
    laws = tmp_path / "engines" / "laws"
    sources = [laws / "kelvin_voigt_test.cpp", TOP / "engines/laws/registry.cpp"]
    compiled(tmp_path, *sources, "-lgtest", "-lgtest_main", "-o", "law_test")
    done = subprocess.run([tmp_path / "law_test"], capture_output=True, text=True)
    assert done.returncode == 0 and "[  PASSED  ] 2 tests." in done.stdout, done.stdout
    python = f"/usr/include/python3.{sys.version_info.minor}"
    functors = tmp_path / "engines/functors/contact_law_functors.cpp"
    compiled(tmp_path, *WITH_YADE, "-isystem", python, "-fsyntax-only", functors)


# The binding as in drives_py.cpp, in a module of its own with the sources that it needs, so that headers are compiled once.
MODULE = """
#include "engines/seam/attributes.cpp"
#include "engines/seam/bind.cpp"
#include "engines/seam/scene_contacts.cpp"
#include "engines/drives/Tether.cpp"
BOOST_PYTHON_MODULE(tether) { graindrive::seam::bind<graindrive::Tether>(graindrive::Tether::documentation); }
"""
INTO_THE_PACKAGE = """
import graindrive.engines
import tether
graindrive.engines.Tether = tether.Tether
"""


@needs_compiler
def test_a_new_engine_compiles_and_acts_on_both_loops(tmp_path):
    apply_changes("engine.md", tmp_path)
    binding = (tmp_path / "engines/drives/drives_py.cpp").read_text()
    assert '#include "engines/drives/Tether.hpp"' in binding and "seam::bind<Tether>(Tether::documentation);" in binding
    (tmp_path / "module.cpp").write_text(MODULE)
    python = f"python3.{sys.version_info.minor}"
    source = [*WITH_YADE, "-isystem", f"/usr/include/{python}", "module.cpp"]
    (folder,) = glob.glob("/usr/lib/*/yade-double")
    boost = [
        f"-lboost_{name}"
        for name in (f"python3{sys.version_info.minor}", f"numpy3{sys.version_info.minor}", "serialization")
    ]
    yade = ["-L", folder, f"-Wl,-rpath,{folder}", "-lyade", "-lpkg_common", "-lpkg_dem"]
    compiled(tmp_path, "-shared", *source, *yade, *boost, f"-l{python}", "-o", "tether.so")
    (tmp_path / "conftest.py").write_text(INTO_THE_PACKAGE)
    command = [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", "engines/drives/Tether_test.py"]
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join([str(tmp_path), *filter(None, sys.path)])}
    done = subprocess.run(command, cwd=tmp_path, env=environment, capture_output=True, text=True)
    assert done.returncode == 0 and "3 passed" in done.stdout, done.stdout + done.stderr


def test_a_change_whose_place_is_gone_is_found(tmp_path, monkeypatch):
    monkeypatch.setattr("guide_pages.GUIDES", tmp_path)
    (tmp_path / "page.md").write_text(
        "```diff\n--- a/LICENSE\n+++ b/LICENSE\n@@ -1 +1 @@\n-no such line\n+another\n```\n"
    )
    with pytest.raises(AssertionError, match="FAILED"):
        apply_changes("page.md", tmp_path / "place")


def test_blocks_are_files_commands_and_changes(tmp_path, monkeypatch):
    monkeypatch.setattr("guide_pages.GUIDES", tmp_path)
    (tmp_path / "page.md").write_text("`a/b.txt`:\n\n```text\nx\n```\n\n```bash\necho y\n```\n")
    assert blocks("page.md") == [("a/b.txt", "text", "x\n"), (None, "bash", "echo y\n")]
    assert write_files("page.md", tmp_path) == ["a/b.txt"] and (Path(tmp_path) / "a/b.txt").read_text() == "x\n"
    assert follow("page.md", tmp_path) == "y\n"
