"""ParaView files: VTK reads back what was written, with YADE in the same process, in both orders of import."""

import os
import subprocess
import sys
from xml.etree import ElementTree

import numpy as np
import pytest

pytest.importorskip("vtkmodules")

from graindrive.postproc.fields import Fields  # noqa: E402
from graindrive.postproc.reader import Frame  # noqa: E402
from graindrive.exports.vtk_export import export, export_fields  # noqa: E402

UNITS = {"r": "d", "vx": "sqrt(g d)", "fn": "rho g d^2", "slip": "d"}
BODY = {"beads": np.array([[-1.0, 0], [1.0, 0]]), "bead_radius": np.array(0.25)}
BODY["outline"] = np.array([[-1.25, -0.25], [1.25, -0.25], [1.25, 0.25], [-1.25, 0.25]])
DISK = {"beads": np.zeros((1, 2)), "bead_radius": np.array(0.25)}


def bed(t=1.25):
    """Three grains in a box of period 10, two of which touch across its side, and a body of two beads turned by 90 degrees."""
    grains = {"id": [0, 1, 2], "x": [0.5, 1.5, 9.5], "y": [0.0, 0.1, 0.0], "r": [0.5, 0.5, 0.5]}
    grains.update(vx=[1.0, 2.0, 3.0], vy=[0.0, 0.0, -1.0], spin=[0.1, 0.2, 0.3], role=[0, 1, 0])
    contacts = {"i": [0, 1, 0, 2], "j": [1, -1, 2, -4], "id_i": [0, 1, 0, 2], "id_j": [1, 8, 2, -4]}
    contacts.update(fn=[5.0, -6.0, 7.0, 8.0], ft=[0.5, -0.6, 0.7, 0.0], slip=[0.1, -0.2, 0.3, 0.0])
    contacts.update(px=[1.0, 1.5, 0.0, 9.5], py=[0.05, 0.6, 0.0, -0.5])
    body = {
        "id": [7, 8],
        "x": [1.5, 1.5],
        "y": [2.85, 0.85],
        "r": [0.25, 0.25],
        "vx": [0, 0],
        "vy": [1, 1],
        "spin": [0, 0],
    }
    body["centre"] = [1.5, 1.85]
    parts = ({name: np.array(values) for name, values in part.items()} for part in (grains, contacts, body))
    return Frame(t, *parts, period=10.0)


def read(path):
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkIOXML import vtkXMLImageDataReader, vtkXMLPolyDataReader

    reader = vtkXMLImageDataReader() if path.suffix == ".vti" else vtkXMLPolyDataReader()
    reader.SetFileName(str(path))
    reader.Update()
    return reader.GetOutput(), vtk_to_numpy


def arrays_of(data, to_numpy):
    """Return {name: (values, unit)} of a point or cell data."""
    from vtkmodules.vtkCommonCore import vtkDataArray

    found = [data.GetArray(k) for k in range(data.GetNumberOfArrays())]
    return {a.GetName(): (to_numpy(a), a.GetInformation().Get(vtkDataArray.UNITS_LABEL())) for a in found}


def test_grains_come_back_as_points_with_ids_and_the_body_among_them(tmp_path):
    export([bed()], tmp_path, BODY, UNITS)
    data, to_numpy = read(tmp_path / "grains_0001.vtp")
    assert data.GetNumberOfPoints() == data.GetNumberOfVerts() == 5
    points, arrays = to_numpy(data.GetPoints().GetData()), arrays_of(data.GetPointData(), to_numpy)
    assert np.array_equal(points, [[0.5, 0, 0], [1.5, 0.1, 0], [9.5, 0, 0], [1.5, 2.85, 0], [1.5, 0.85, 0]])
    assert np.array_equal(arrays["velocity"][0][2:4], [[3, -1, 0], [0, 1, 0]])
    expected = dict(id=[0, 1, 2, 7, 8], radius=[0.5] * 3 + [0.25] * 2, spin=[0.1, 0.2, 0.3, 0, 0], role=[0, 1, 0, 2, 2])
    for name, values in expected.items():
        assert np.array_equal(arrays[name][0], values)
    assert arrays["radius"][1] == "d" and arrays["velocity"][1] == "sqrt(g d)"


def test_contacts_come_back_as_lines_with_ids_signs_and_slip(tmp_path):
    export([bed()], tmp_path, BODY, UNITS)
    data, to_numpy = read(tmp_path / "contacts_0001.vtp")
    arrays = arrays_of(data.GetCellData(), to_numpy)
    assert np.array_equal(arrays["normal_force"][0], [5, -6, 7, 8]) and arrays["normal_force"][1] == "rho g d^2"
    assert np.array_equal(arrays["tangential_force"][0], [0.5, -0.6, 0.7, 0])
    assert np.array_equal(arrays["slip"][0], [0.1, -0.2, 0.3, 0])
    assert np.array_equal(arrays["i"][0], [0, 1, 0, 2]) and np.array_equal(arrays["j"][0], [1, 8, 2, -4])
    ends = [[data.GetCell(k).GetPoints().GetPoint(e)[:2] for e in (0, 1)] for k in range(data.GetNumberOfLines())]
    assert np.allclose(ends[0], [[0.5, 0], [1.5, 0.1]])
    assert np.allclose(ends[1], [[1.5, 0.1], [1.5, 0.85]]), "the body's end is its bead"
    assert np.allclose(ends[2], [[0.5, 0], [-0.5, 0]]), "the far end is the image across the periodic side"
    assert np.allclose(ends[3], [[9.5, 0], [9.5, -0.5]]), "at a flat wall the line ends at the contact point"


def test_the_body_s_outline_moves_and_turns_with_it(tmp_path):
    export([bed()], tmp_path, BODY)
    data, to_numpy = read(tmp_path / "intruder_0001.vtp")
    corners = [data.GetCell(0).GetPoints().GetPoint(k)[:2] for k in range(5)]
    # Beads at (-1, 0), (1, 0) are now at (0, 1), (0, -1) about (1.5, 1.85): turned by -90 degrees, (x, y) -> (y, -x).
    turned = [[-0.25, 1.25], [-0.25, -1.25], [0.25, -1.25], [0.25, 1.25], [-0.25, 1.25]]
    assert data.GetNumberOfLines() == 1 and np.allclose(corners, np.add(turned, [1.5, 1.85]))


def test_a_single_disk_s_outline_is_its_circle_with_a_spoke_that_turns(tmp_path):
    frame = bed()
    for name, values in dict(id=[7], x=[3.0], y=[4.0], r=[0.25], vx=[0], vy=[0], spin=[2], angle=np.pi / 2).items():
        frame.intruder[name] = np.array(values)
    export([frame], tmp_path, DISK)
    data, to_numpy = read(tmp_path / "intruder_0001.vtp")
    points = to_numpy(data.GetPoints().GetData())[:, :2]
    assert np.allclose(points[:2], [[3, 4], [3, 4.25]]) and np.allclose(np.hypot(*(points[1:] - [3, 4]).T), 0.25)


def test_a_body_of_many_disks_without_an_outline_is_the_ring_through_them(tmp_path):
    """A drum's wall: eight disks on a circle of radius 2 about (3, 4), turned by 0.3, and listed in no order."""
    order = np.array([3, 1, 4, 0, 5, 7, 2, 6])
    angles = 2 * np.pi * order / 8
    wall = dict(beads=2 * np.column_stack([np.cos(angles), np.sin(angles)]), bead_radius=np.array(0.5))
    frame = bed()
    frame.intruder["x"], frame.intruder["y"] = 3 + 2 * np.cos(angles + 0.3), 4 + 2 * np.sin(angles + 0.3)
    export([frame], tmp_path, wall)
    data, to_numpy = read(tmp_path / "intruder_0001.vtp")
    line = np.array([data.GetCell(0).GetPoints().GetPoint(k)[:2] for k in range(9)])
    assert np.allclose(np.hypot(*(line - [3, 4]).T), 2)
    assert np.allclose(np.hypot(*np.diff(line, axis=0).T), 4 * np.sin(np.pi / 8)), "from neighbour to neighbour"


def test_frames_stand_in_time_order_in_the_collections(tmp_path):
    export([bed(0.5), bed(1.5)], tmp_path, BODY)
    for kind in ("grains", "contacts", "intruder"):
        sets = ElementTree.parse(tmp_path / f"{kind}.pvd").findall("Collection/DataSet")
        assert [(float(s.get("timestep")), s.get("file")) for s in sets] == [
            (0.5, f"{kind}_0001.vtp"),
            (1.5, f"{kind}_0002.vtp"),
        ]


def test_a_bed_without_contacts_and_without_body(tmp_path):
    export([Frame(0.0, bed().grains, {})], tmp_path)
    assert read(tmp_path / "contacts_0001.vtp")[0].GetNumberOfLines() == 0
    assert read(tmp_path / "grains_0001.vtp")[0].GetNumberOfPoints() == 3 and not (tmp_path / "intruder.pvd").exists()


def test_fields_come_back_as_images_with_units(tmp_path):
    x, y, rng = np.array([-1.0, -0.5, 0.0]), np.array([2.0, 2.5]), np.random.default_rng(1)
    shapes = dict(pressure=(2, 2, 3), velocity=(2, 2, 3, 2), contact_stress=(2, 2, 3, 2, 2))
    arrays = {name: rng.uniform(size=shape) for name, shape in shapes.items()}
    arrays["velocity"][1, 0, 2] = np.nan
    settings = dict(period=4.0, phaseStart=1.0)
    export_fields(Fields(x, y, np.array([5, 6]), arrays, {"pressure": "rho g d"}, settings), "around", tmp_path)
    data, to_numpy = read(tmp_path / "fields_around_02.vti")
    found = arrays_of(data.GetPointData(), to_numpy)
    for k in range(6):
        place, row, column = data.GetPoint(k), k // 3, k % 3
        assert place == (x[column], y[row], 0)
        assert found["pressure"][0][k] == arrays["pressure"][1, row, column]
        assert np.array_equal(found["velocity"][0][k], [*arrays["velocity"][1, row, column], 0], equal_nan=True)
        tensor = found["contact_stress"][0][k].reshape(3, 3)
        assert np.array_equal(tensor[:2, :2], arrays["contact_stress"][1, row, column]) and not tensor[2].any()
    assert found["pressure"][1] == "rho g d"
    sets = ElementTree.parse(tmp_path / "fields_around.pvd").findall("Collection/DataSet")
    assert [float(s.get("timestep")) for s in sets] == [
        2.0,
        4.0,
    ]  # the middles of the two halves of a cycle of length 4 that begins at 1


def test_fields_averaged_along_y_lie_in_the_plane_of_x_and_z(tmp_path):
    x, z, rng = np.array([-1.0, -0.5, 0.0]), np.array([2.0, 2.5]), np.random.default_rng(1)
    shapes = dict(pressure=(1, 2, 3), velocity=(1, 2, 3, 3), contact_stress=(1, 2, 3, 3, 3))
    arrays = {name: rng.uniform(size=shape) for name, shape in shapes.items()}
    export_fields(Fields(x, z, np.array([5]), arrays, {}, {}, "xz"), "row", tmp_path)
    data, to_numpy = read(tmp_path / "fields_row_01.vti")
    found = arrays_of(data.GetPointData(), to_numpy)
    assert data.GetNumberOfPoints() == 6
    for k in range(6):
        row, column = k // 3, k % 3
        assert data.GetPoint(k) == (x[column], 0, z[row])
        for name, shape in (("pressure", ()), ("velocity", (3,)), ("contact_stress", (3, 3))):
            assert np.array_equal(found[name][0][k].reshape(shape), arrays[name][0, row, column])


@pytest.mark.parametrize("order", ["import yade, vtkmodules.vtkIOXML", "import vtkmodules.vtkIOXML, yade"])
def test_lives_beside_yade(tmp_path, order):
    pytest.importorskip("yade")
    code = f"{order}; import test_vtk_export as t; t.export([t.bed()], {str(tmp_path)!r})"
    path = os.pathsep.join([os.path.dirname(__file__), *filter(None, sys.path)])
    subprocess.run([sys.executable, "-c", code], env={**os.environ, "PYTHONPATH": path}, check=True, timeout=60)
    assert ElementTree.parse(tmp_path / "grains.pvd").find("Collection/DataSet").get("file") == "grains_0001.vtp"
    assert (tmp_path / "grains_0001.vtp").stat().st_size > 0
