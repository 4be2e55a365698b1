"""CMake, the package and the citation have the same version."""

import re
from pathlib import Path

import graindrive

ROOT = Path(__file__).resolve().parents[2]


def version_in(name, pattern):
    return re.search(pattern, (ROOT / name).read_text(encoding="utf-8")).group(1)


def test_cmake_package_and_citation_have_one_version():
    cmake = version_in("CMakeLists.txt", r"project\(graindrive VERSION ([\d.]+)")
    citation = version_in("CITATION.cff", r"(?m)^version: ([\d.]+)$")
    assert cmake == citation == graindrive.__version__
