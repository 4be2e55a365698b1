"""The arrows between rooms, in Python and in C++, are those that the READMEs' tables name."""

import re
from collections import defaultdict
from pathlib import Path

import pytest
from import_graph import FOLDERS, TOP, graph_of

ROW = re.compile(r"^\| (`[^|]+`[^|]*)\|[^|]*\|([^|]*)\|$")
NAME = re.compile(r"`([\w./]+?)/?`")
INCLUDE = re.compile(r'^#include "engines/([^"]+)"', re.MULTILINE)


def table(readme):
    """Return {room: set of rooms} that a README's table of rooms names in its first and last column."""
    rows = [ROW.match(line) for line in readme.read_text(encoding="utf-8").splitlines()]
    return {room: set(NAME.findall(row[2])) for row in rows if row for room in NAME.findall(row[1])}


def room_of_module(name):
    """Return the room of a full name: `graindrive.beds.lid` is in beds, `graindrive.postproc.drum.x` in postproc/drum."""
    _, first, *rest = [*name.split("."), ""]
    deeper = first == "postproc" and rest[0] and (TOP / "postproc" / rest[0]).is_dir()
    return f"postproc/{rest[0]}" if deeper else first


def arrows_of_python():
    """Return {room: {other room: a module and what it imports}}; the package itself, which starts runs, is left out."""
    found = defaultdict(dict)
    for module, imported in graph_of(FOLDERS).items():
        for other in imported:
            pair = room_of_module(module), room_of_module(other)
            if pair[0] != pair[1] and module != "graindrive":
                found[pair[0]][pair[1]] = f"{module} imports {other}"
    return found


def arrows_of_engines():
    """Return {room: {other room: a file and what it includes}} of the C++ code, tests and rooms' own files aside."""
    found = defaultdict(dict)
    for file in sorted((TOP / "engines").rglob("*.[ch]pp")):
        if re.search(r"(_test|test_\w+)\.[ch]pp$", file.name):
            continue
        room = file.relative_to(TOP / "engines").parent.as_posix()
        for included in INCLUDE.findall(file.read_text(encoding="utf-8")):
            other = Path(included).parent.as_posix()
            if room != "." and not one_holds_the_other(room, other):
                found[room][other] = f"{file.name} includes {included}"
    return found


def one_holds_the_other(room, other):
    """True if two rooms are the same, or one is inside the other; such rooms count as one."""
    return f"{room}/".startswith(f"{other}/") or f"{other}/".startswith(f"{room}/")


@pytest.mark.parametrize(
    "readme, arrows", [("scripts/README.md", arrows_of_python), ("engines/README.md", arrows_of_engines)]
)
def test_rooms_know_what_their_table_names(readme, arrows):
    known, found = table(TOP / readme), arrows()
    unknown = {room: where for room, where in found.items() if room not in known}
    assert not unknown, f"rooms that {readme} does not list"
    undeclared = [
        f"{room}: {where}" for room in found for other, where in found[room].items() if other not in known[room]
    ]
    assert not undeclared, f"arrows that {readme} does not name"
    idle = [
        f"{room} -> {other}" for room in known for other in known[room] if other in known and other not in found[room]
    ]
    assert not idle, f"arrows in {readme} that no file needs"


def test_an_arrow_that_is_not_named_is_found(tmp_path):
    (tmp_path / "README.md").write_text(
        "| room | what | knows |\n|---|---|---|\n| `a/` | x | `b`, Eigen |\n| `b` | y | – |\n"
    )
    assert table(tmp_path / "README.md") == {"a": {"b"}, "b": set()}
    assert (
        room_of_module("graindrive.beds.lid") == "beds"
        and room_of_module("graindrive.postproc.drum.flow") == "postproc/drum"
    )
    assert Path(TOP / "engines").is_dir() and "seam" in arrows_of_engines()["drives"]
