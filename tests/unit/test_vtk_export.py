"""ParaView files: what is written is what VTK reads back, beside YADE in the same process, in either order of import."""

import os
import subprocess
import sys
from types import SimpleNamespace
from xml.etree import ElementTree

import numpy as np
import pytest

pytest.importorskip("vtkmodules")

from graindrive.vtk_export import export  # noqa: E402


def bed(t=1.25):
    grains = {"x": [0.5, 1.5, 9.5], "y": [0.0, 0.1, 0.0], "r": [0.5, 0.5, 0.5]}
    grains.update(vx=[1.0, 2.0, 3.0], vy=[0.0, 0.0, -1.0], spin=[0.1, 0.2, 0.3], role=[0, 1, 2])
    contacts = {"i": [0, 1, 0], "j": [1, -1, 2], "fn": [5.0, 6.0, 7.0], "ft": [0.5, 0.6, 0.7]}
    contacts.update(px=[1.0, 1.5, 0.0], py=[0.05, 0.6, 0.0])
    arrays = ({name: np.array(values) for name, values in part.items()} for part in (grains, contacts))
    return SimpleNamespace(t=t, **dict(zip(("grains", "contacts"), arrays)))


def read(path):
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkIOXML import vtkXMLPolyDataReader

    reader = vtkXMLPolyDataReader()
    reader.SetFileName(str(path))
    reader.Update()
    return reader.GetOutput(), vtk_to_numpy


def test_grains_come_back_as_points(tmp_path):
    export([bed()], tmp_path)
    data, to_numpy = read(tmp_path / "grains_0001.vtp")
    assert data.GetNumberOfPoints() == data.GetNumberOfVerts() == 3
    assert np.array_equal(to_numpy(data.GetPoints().GetData())[:, 0], [0.5, 1.5, 9.5])
    assert np.array_equal(to_numpy(data.GetPointData().GetArray("velocity"))[2], [3, -1, 0])
    for name, values in {"radius": [0.5] * 3, "spin": [0.1, 0.2, 0.3], "role": [0, 1, 2]}.items():
        assert np.array_equal(to_numpy(data.GetPointData().GetArray(name)), values)


def test_contacts_come_back_as_lines_that_do_not_cross_the_box(tmp_path):
    export([bed()], tmp_path)
    data, to_numpy = read(tmp_path / "contacts_0001.vtp")
    assert data.GetNumberOfLines() == 3
    assert np.array_equal(to_numpy(data.GetCellData().GetArray("normal_force")), [5, 6, 7])
    ends = [[data.GetCell(k).GetPoints().GetPoint(e)[:2] for e in (0, 1)] for k in range(3)]
    assert np.allclose(ends[0], [[0.5, 0], [1.5, 0.1]])
    assert np.allclose(ends[1], [[1.5, 0.1], [1.5, 0.6]]), "the intruder's end is the contact point"
    assert np.allclose(ends[2], [[0.5, 0], [0, 0]]), "the far end is across the periodic side"


def test_frames_stand_in_time_order_in_the_collection(tmp_path):
    export([bed(0.5), bed(1.5)], tmp_path)
    sets = ElementTree.parse(tmp_path / "grains.pvd").findall("Collection/DataSet")
    assert [(float(s.get("timestep")), s.get("file")) for s in sets] == [
        (0.5, "grains_0001.vtp"),
        (1.5, "grains_0002.vtp"),
    ]


def test_a_bed_without_contacts(tmp_path):
    frame = bed()
    frame.contacts = {}
    export([frame], tmp_path)
    assert read(tmp_path / "contacts_0001.vtp")[0].GetNumberOfLines() == 0


@pytest.mark.parametrize("order", ["import yade, vtkmodules.vtkIOXML", "import vtkmodules.vtkIOXML, yade"])
def test_lives_beside_yade(tmp_path, order):
    pytest.importorskip("yade")
    code = f"{order}; import test_vtk_export as t; t.export([t.bed()], {str(tmp_path)!r})"
    path = os.pathsep.join([os.path.dirname(__file__), *filter(None, sys.path)])
    subprocess.run([sys.executable, "-c", code], env={**os.environ, "PYTHONPATH": path}, check=True, timeout=60)
    assert (tmp_path / "grains.pvd").exists()
