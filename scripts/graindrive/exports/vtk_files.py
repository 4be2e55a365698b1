"""Arrays as files that VTK and ParaView read: points and lines (.vtp), images (.vti), collections in time (.pvd)."""

import os
from pathlib import Path
from xml.sax.saxutils import quoteattr

import numpy as np

from ..base.errors import UsageError


def modules():
    """Return VTK's modules that this file needs; Debian's python3-vtk9 shares its libraries with YADE.

    Raises UsageError if they are missing.
    """
    try:
        from vtkmodules import vtkCommonCore, vtkCommonDataModel, vtkIOXML
        from vtkmodules.util import numpy_support
    except ImportError as error:
        raise UsageError(
            f"files for ParaView (vtk=1) need VTK for Python ({error}); install Debian's package python3-vtk9 (scripts/setup vtk)"
        ) from None
    return vtkCommonCore, vtkCommonDataModel, vtkIOXML, numpy_support


def in_plane(x, y):
    """Return (n, 3) vectors with z = 0."""
    return np.column_stack([x, y, np.zeros(len(x))]).astype(float)


def polydata(points, kind, cells, arrays, units=(), *, on_points):
    """Return a vtkPolyData of `points` (n, 3), `cells` of kind "verts", "lines" or "polys", and named arrays on either.

    `cells` is an array (m, k) of rows of points, or a list of such arrays with different k.
    `units` maps names to units, which the arrays carry as VTK's key UNITS_LABEL.
    """
    core, model, _, support = modules()
    data, positions, grid = model.vtkPolyData(), core.vtkPoints(), model.vtkCellArray()
    positions.SetData(support.numpy_to_vtk(points, deep=True))
    data.SetPoints(positions)
    groups = cells if isinstance(cells, list) else [cells]
    offsets = np.cumsum(np.concatenate([[0], *(np.full(len(group), group.shape[1]) for group in groups)]))
    corners = np.concatenate([group.ravel() for group in groups])
    grid.SetData(*(support.numpy_to_vtkIdTypeArray(a.astype(np.int64), deep=True) for a in (offsets, corners)))
    {"verts": data.SetVerts, "lines": data.SetLines, "polys": data.SetPolys}[kind](grid)
    add_arrays(data.GetPointData() if on_points else data.GetCellData(), arrays, units)
    return data


def image(x, y, arrays, units=(), axes="xy"):
    """Return a vtkImageData of a plane through the origin with values at evenly spaced places x (nx,), y (ny,) along `axes`.

    `arrays` are (ny, nx), (ny, nx, D) or (ny, nx, D, D); vectors and tensors of D = 2 get zeros along z.
    """
    data = modules()[1].vtkImageData()
    spacing = next((a[1] - a[0] for a in (x, y) if len(a) > 1), 1.0)
    places = [dict(zip(axes, (x, y))).get(axis, [0.0]) for axis in "xyz"]
    data.SetDimensions(*map(len, places))
    data.SetOrigin(*(along[0] for along in places))
    data.SetSpacing(spacing, spacing, spacing)
    add_arrays(data.GetPointData(), {name: in_space(values) for name, values in arrays.items()}, units)
    return data


def in_space(values):
    """Return values on a grid (ny, nx, …) as rows (n,), (n, 3) or (n, 9), x fastest."""
    order = values.ndim - 2
    padded = np.pad(values, [(0, 0)] * 2 + [(0, 3 - size) for size in values.shape[2:]])
    return padded.reshape(-1, 3**order) if order else padded.ravel()


def add_arrays(target, arrays, units):
    """Add named arrays with their units to a VTK object's point or cell data."""
    core, _, _, support = modules()
    for name, values in arrays.items():
        array = support.numpy_to_vtk(np.ascontiguousarray(values), deep=True)
        array.SetName(name)
        if name in units:
            array.GetInformation().Set(core.vtkDataArray.UNITS_LABEL(), units[name])
        target.AddArray(array)


def write(data, path):
    """Write a vtkPolyData or vtkImageData as a compressed XML file; raises OSError if that fails."""
    xml = modules()[2]
    writer = xml.vtkXMLImageDataWriter() if data.IsA("vtkImageData") else xml.vtkXMLPolyDataWriter()
    writer.SetFileName(str(path))
    writer.SetInputData(data)
    if not writer.Write():
        raise OSError(f"VTK could not write {path}")


def write_collection(path, entries):
    """Write the .pvd file of (time, name of file) pairs, in one step."""
    rows = [f'    <DataSet timestep="{float(t)!r}" file={quoteattr(name)}/>' for t, name in entries]
    head, foot = ['<VTKFile type="Collection" version="0.1">', "  <Collection>"], ["  </Collection>", "</VTKFile>", ""]
    temporary = Path(path).with_name(f".{Path(path).name}")
    temporary.write_text("\n".join([*head, *rows, *foot]))
    os.replace(temporary, path)
