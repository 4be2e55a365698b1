"""Files that hold no outline: one line with the reason, quickly, and no run folder; forms of file names that a study accepts."""

import os
import sys

import pytest
from graindrive.bodies import intruder
from graindrive.engines import Outline, clump_of, outline_of, read_outline
from graindrive.base.errors import UsageError

SQUARE = "POLYGON ((0 0, 4 0, 4 4, 0 4, 0 0))"


def reason(path):
    """Return a study's message on an outline file; computing the file's digest must be as quick."""
    intruder.contents_of(str(path))
    with pytest.raises(UsageError) as caught:
        intruder.make(str(path), bead_diameter=0.5, mass=1)
    said = str(caught.value)
    assert "\n" not in said and said.startswith("shape=")
    return said


def test_a_pipe_is_not_waited_for(tmp_path):
    os.mkfifo(tmp_path / "pipe.csv")
    assert "got a pipe or a device" in reason(tmp_path / "pipe.csv")


def test_an_endless_device_is_not_read(tmp_path):
    (tmp_path / "zero.csv").symlink_to("/dev/zero")
    assert "got a pipe or a device" in reason(tmp_path / "zero.csv")


def test_a_folder_a_missing_file_and_a_circle_of_links_are_named_as_such(tmp_path):
    (tmp_path / "folder.csv").mkdir()
    (tmp_path / "a.csv").symlink_to("b.csv")
    (tmp_path / "b.csv").symlink_to("a.csv")
    assert "got a folder" in reason(tmp_path / "folder.csv")
    assert "No such file" in reason(tmp_path / "none.csv")
    assert "Too many levels of symbolic links" in reason(tmp_path / "a.csv")
    assert "No such file" in reason("~no-such-user/x.csv")


@pytest.mark.skipif(os.geteuid() == 0, reason="root may read everything")
def test_a_file_without_permission_to_read(tmp_path):
    (tmp_path / "mine.csv").write_text("0,0\n1,0\n0,1\n")
    (tmp_path / "mine.csv").chmod(0)
    assert "look at its permissions" in reason(tmp_path / "mine.csv")


def test_a_path_with_a_zero_byte():
    assert "must not hold the byte 0" in reason("a\0.csv")


def test_a_file_that_is_too_large_to_be_an_outline(tmp_path):
    with open(tmp_path / "large.csv", "wb") as file:
        file.truncate(1 << 40)  # a sparse file of a terabyte
    assert "must not be larger than 4 MiB" in reason(tmp_path / "large.csv")
    assert intruder.contents_of(str(tmp_path / "large.csv")) == ""


@pytest.mark.parametrize(
    "content, said",
    [
        (b"", "at least 3 different vertices, got 0"),
        (SQUARE.encode("utf-16"), "got UTF-16; save it as UTF-8"),
        (SQUARE.encode("utf-16-be"), "got UTF-16; save it as UTF-8"),
        (bytes(range(256)), "got binary data"),
        (b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR", "got binary data"),
        (b"x;y\n0,0;0,0\n", "decimals take a point"),
        (b'{"type": "Polygon", "coordinates": [[[0, 0], [1, 0], [1, 1]]]}', "line 1 must hold two numbers"),
        ("0;0\né;ü\n".encode("latin-1"), "line 2 must hold two numbers x, y, got '?;?'"),
        (b"POLYGON EMPTY", "the WKT POLYGON is EMPTY"),
        (b"POLYGON ((0 0, 4 0, 4, 0 4, 0 0))", "vertex 2 of the WKT must hold 2 numbers, got '4'"),
        (b"0,0\n1e154,0\n0,1e154\n", "up to 1e50, got vertex 1"),
        (b"0,0\ninf,0\n0,1\n", "must be finite numbers, got vertex 1 (inf, 0)"),
    ],
    ids=lambda value: value[:20] if isinstance(value, str) else "",
)
def test_contents_that_are_no_outline(tmp_path, content, said):
    (tmp_path / "shape.csv").write_bytes(content)
    assert said in reason(tmp_path / "shape.csv")


def test_a_table_from_a_geographic_program_is_read(tmp_path):
    (tmp_path / "export.csv").write_text(f'WKT,id\r\n"SRID=25832;MULTI{SQUARE[:7]}((({SQUARE[10:-2]})))",1\r\n')
    assert read_outline(str(tmp_path / "export.csv")).area == 16


def test_a_name_with_another_ending_is_no_file(tmp_path):
    (tmp_path / "shape.txt").write_text("0,0\n4,0\n0,4\n")
    assert "other shapes are read from files that end in .wkt or .csv" in reason(tmp_path / "shape.txt")


@pytest.mark.parametrize("turn", [1e300, -1e17 * 360, sys.float_info.max, 5e-324])
def test_any_number_is_an_orientation(turn):
    assert intruder.outline_of("wide", turn).area == pytest.approx(9.5 * 4.5, rel=1e-14)


def test_whole_turns_leave_a_shape_as_it_was():
    assert (intruder.outline_of("triangle", 7200).vertices == intruder.outline_of("triangle", 0).vertices).all()


@pytest.mark.parametrize("vertices", [[(0, 0), (1e154, 0), (0, 1e154)], [(0, 0), (float("nan"), 0), (0, 1)]])
def test_vertices_beyond_all_bounds_are_refused(vertices):
    with pytest.raises(ValueError, match="vertex 1"):
        Outline(vertices)


@pytest.mark.parametrize("bead", [float("nan"), float("inf"), 1e308, 1e154, 1e-300, 5e-324, 0.0])
def test_bead_diameters_beyond_all_bounds_are_refused(bead):
    with pytest.raises(ValueError, match="bead"):
        clump_of(outline_of("square"), bead, 1.0)
