"""Frames of a run as files for ParaView: grains and contacts as .vtp, all frames in time order as .pvd."""

from pathlib import Path

import numpy as np

from .errors import UsageError


def export(frames, folder):
    """Write `grains_NNNN.vtp`, `contacts_NNNN.vtp`, `grains.pvd` and `contacts.pvd` into `folder`.

    `frames` yields objects with `t`, `grains` and `contacts` (dicts of 1D arrays, as `graindrive.postproc.reader.Frame`).
    Grains are points with radius, velocity, spin and role: in ParaView, glyph by sphere, scale by radius, factor 2.
    Contacts are lines from centre to centre, or to the contact point at the intruder, with normal and tangential
    force. Raises UsageError if Debian's package python3-vtk9 is missing.
    """
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    written = {"grains": [], "contacts": []}
    for number, frame in enumerate(frames, start=1):
        for kind, polydata in (("grains", grain_points(frame)), ("contacts", contact_lines(frame))):
            name = f"{kind}_{number:04d}.vtp"
            write(polydata, folder / name)
            written[kind].append((frame.t, name))
    for kind, entries in written.items():
        rows = [f'    <DataSet timestep="{t!r}" file="{name}"/>' for t, name in entries]
        text = [
            '<VTKFile type="Collection" version="0.1">',
            "  <Collection>",
            *rows,
            "  </Collection>",
            "</VTKFile>",
            "",
        ]
        (folder / f"{kind}.pvd").write_text("\n".join(text))


def grain_points(frame):
    """Return the vtkPolyData of a frame's grains."""
    g = frame.grains
    n = len(g["x"])
    arrays = {"radius": g["r"], "velocity": in_plane(g["vx"], g["vy"]), "spin": g["spin"]}
    if "role" in g:
        arrays["role"] = np.asarray(g["role"], dtype=np.int32)
    return polydata(in_plane(g["x"], g["y"]), "verts", np.arange(n).reshape(n, 1), arrays, on_points=True)


def contact_lines(frame):
    """Return the vtkPolyData of a frame's contacts; -1 as i or j stands for the intruder.

    A contact across the periodic side ends at its contact point instead of crossing the whole picture.
    """
    c = frame.contacts
    n = len(c["fn"]) if c else 0
    if n == 0:
        return polydata(np.zeros((0, 3)), "lines", np.zeros((0, 2), dtype=int), {}, on_points=False)
    centres = in_plane(frame.grains["x"], frame.grains["y"])
    point, reach = in_plane(c["px"], c["py"]), 3 * np.max(frame.grains["r"])
    ends = []
    for key in ("i", "j"):
        at = centres[np.maximum(c[key], 0)]
        outside = (np.asarray(c[key]) < 0) | (np.abs(at[:, 0] - point[:, 0]) > reach)
        ends.append(np.where(outside[:, None], point, at))
    arrays = {"normal_force": c["fn"], "tangential_force": c["ft"]}
    return polydata(np.concatenate(ends), "lines", np.arange(2 * n).reshape(2, n).T, arrays, on_points=False)


def in_plane(x, y):
    """Return (n, 3) vectors with z = 0."""
    return np.column_stack([x, y, np.zeros(len(x))]).astype(float)


def polydata(points, kind, cells, arrays, *, on_points):
    """Return a vtkPolyData of `points` (n, 3), `cells` (m, k) of kind "verts" or "lines", and named arrays on either."""
    vtk_points, vtk_cells, vtk_polydata, _, to_vtk = modules()
    data, positions, grid = vtk_polydata(), vtk_points(), vtk_cells()
    positions.SetData(to_vtk(points, deep=True))
    data.SetPoints(positions)
    offsets = np.arange(0, cells.size + 1, cells.shape[1], dtype=np.int64)
    grid.SetData(to_vtk_id(offsets), to_vtk_id(cells.ravel().astype(np.int64)))
    data.SetVerts(grid) if kind == "verts" else data.SetLines(grid)
    target = data.GetPointData() if on_points else data.GetCellData()
    for name, values in arrays.items():
        array = to_vtk(np.ascontiguousarray(values), deep=True)
        array.SetName(name)
        target.AddArray(array)
    return data


def to_vtk_id(integers):
    """Return a VTK array of ids."""
    from vtkmodules.util.numpy_support import numpy_to_vtkIdTypeArray

    return numpy_to_vtkIdTypeArray(integers, deep=True)


def write(data, path):
    """Write a vtkPolyData as a compressed .vtp file; raises OSError if that fails."""
    writer = modules()[3]()
    writer.SetFileName(str(path))
    writer.SetInputData(data)
    if not writer.Write():
        raise OSError(f"VTK could not write {path}")


def modules():
    """Return VTK's classes that this file needs; Debian's python3-vtk9 shares its libraries with YADE."""
    try:
        from vtkmodules.util.numpy_support import numpy_to_vtk
        from vtkmodules.vtkCommonCore import vtkPoints
        from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
        from vtkmodules.vtkIOXML import vtkXMLPolyDataWriter
    except ImportError as error:
        raise UsageError(f"vtk=1 needs VTK for Python ({error}); install Debian's package python3-vtk9") from None
    return vtkPoints, vtkCellArray, vtkPolyData, vtkXMLPolyDataWriter, numpy_to_vtk
