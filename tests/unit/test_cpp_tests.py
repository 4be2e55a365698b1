"""Rules that C++ tests must obey so that they can run in parallel."""

from pathlib import Path

ENGINES = Path(__file__).resolve().parents[2] / "engines"


def test_files_of_cpp_tests_are_named_after_the_test_and_its_process():
    with_a_fixed_name = [
        path.relative_to(ENGINES)
        for path in sorted(ENGINES.rglob("*.cpp")) + sorted(ENGINES.rglob("*.hpp"))
        if path.name != "temporary_file.hpp" and "TempDir() +" in path.read_text(encoding="utf-8")
    ]
    assert not with_a_fixed_name, f"use engines/base/temporary_file.hpp in {with_a_fixed_name}"
