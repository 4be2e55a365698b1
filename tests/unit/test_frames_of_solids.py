"""Frames of a solid among spheres: contacts on both loops, its surface for ParaView, compressed text, the section in films."""

import gzip

import extended_xyz
import numpy as np
import pytest
from made_up_frames import DT, Parameters
from yade import O

from graindrive.bodies import dragged_body
from graindrive.solids import surfaces
from graindrive.runs import picture
from graindrive.scenes import scene, space
from graindrive.scenes.material import HertzRestitutionSpheres
from graindrive.postproc.lift import animation
from graindrive.postproc.reader import INTRUDER, Frame, Run
from graindrive.runs.run_folder import RunFolder

D, SIDE, RADIUS = 1.0, 8.0, 1.5
AT = np.array([7.5, SIDE / 2, 4.0])  # the cylinder goes through the periodic side


@pytest.fixture(autouse=True)
def after():
    yield
    O.reset()


def bed(loop, surface):
    """Spheres on a base, with a row that overlaps a cylinder of RADIUS at AT by 0.01; return ids of grains, base and body."""
    space.start(SIDE, SIDE, SIDE)
    O.dt = 1e-5
    base = space.add_base(SIDE, SIDE, D, 1.0)
    body = space.add_solid(surface, AT)
    reach = RADIUS + D / 2 - 0.01
    places = [(AT[0] + reach * np.cos(a), y, AT[2] + reach * np.sin(a)) for a in (0.5, 2, 4) for y in (0.6, 4, 7.4)]
    places += [(3, 3, 0.99), (4.5, 3.2, 1.5), (5.49, 3.2, 1.5)]
    grains = O.bodies.append([scene.sphere(place, D / 2, 1.0) for place in places])
    material = HertzRestitutionSpheres(1e5, 0.3, 0.6, 0.5, 1.0)
    {"grain": space.run_on_grain_loop, "yade": space.run_on_yade_loop}[loop](material, (0, 0, -1))
    O.run(2, True)
    return grains, scene.members(base), body


CYLINDER = surfaces.cylinder((0, 0, 0), (0, 1, 0), RADIUS)


def test_contacts_with_the_solid_touch_its_surface():
    grains, base, body = bed("grain", CYLINDER)
    shown = picture.taken(grains, base, body)
    assert len(shown.grains["x"]) == len(grains) + len(base) and len(shown.intruder["x"]) == 0
    c = shown.contacts
    of_body = (c["i"] == INTRUDER) | (c["j"] == INTRUDER)
    assert of_body.sum() == 9 and (c["fn"][of_body] > 0).all() and len(of_body) == 10
    away = np.column_stack([c[f"p{axis}"][of_body] for axis in "xz"]) - AT[[0, 2]]
    away[:, 0] -= SIDE * np.round(away[:, 0] / SIDE)
    # In the middle of an overlap of 0.01, which two steps of 1e-5 do not change.
    assert np.allclose(np.linalg.norm(away, axis=1), RADIUS - 0.005, atol=1e-6)
    frame = Frame(0.0, shown.grains, shown.contacts, shown.intruder, shown.period)
    begin, end = frame.contact_ends()
    # From the contact point to the grain's centre.
    assert np.allclose(np.linalg.norm(end - begin, axis=1)[of_body], D / 2 - 0.005, atol=1e-6)
    assert len(frame.disks()["x"]) == len(grains) + len(base)


def test_yades_loop_shows_the_same_picture():
    fast, yades = (picture.taken(*bed(loop, CYLINDER)) for loop in ("grain", "yade"))
    assert len(yades.intruder["x"]) == 0
    contacts = yades.contacts
    assert np.sum((contacts["i"] == INTRUDER) | (contacts["j"] == INTRUDER)) == 9
    for part, scale in (("grains", 1), ("intruder", 1), ("contacts", 1e5)):
        for name, column in getattr(yades, part).items():
            # Two steps of 1e-5 with forces of 50 on masses of 0.5; springs differ by round-off, and the stiffness is 1e5.
            assert np.allclose(column, getattr(fast, part)[name], rtol=0, atol=1e-9 * scale), name


def made_up(out, body, export):
    """A run of one frame with that `DraggedBody`; return its folder and the picture."""
    shown = picture.taken(*bed("grain", body.surface))
    with RunFolder(Parameters(out=str(out), export=export), study="lift") as folder:
        folder.note(dt=DT)
        folder.write("intruder", body.described())
        folder.frame(0.0, *shown)
    return out, shown


def read(path):
    """Return points, point arrays and polygons (lists of rows) that VTK reads from a file."""
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkIOXML import vtkXMLPolyDataReader

    reader = vtkXMLPolyDataReader()
    reader.SetFileName(str(path))
    reader.Update()
    data = reader.GetOutput()
    arrays = {
        name: vtk_to_numpy(data.GetPointData().GetArray(name))
        for name in ("radius", "role")
        if data.GetPointData().HasArray(name)
    }
    cells = [data.GetCell(k) for k in range(data.GetNumberOfPolys())] if data.GetNumberOfPolys() else []
    return vtk_to_numpy(data.GetPoints().GetData()), arrays, data, cells


def enclosed(data):
    """Return the volume within the polygons of a vtkPolyData, by VTK."""
    from vtkmodules.vtkFiltersCore import vtkMassProperties, vtkTriangleFilter

    triangles, mass = vtkTriangleFilter(), vtkMassProperties()
    triangles.SetInputData(data)
    mass.SetInputConnection(triangles.GetOutputPort())
    mass.Update()
    return mass.GetVolume()


def test_paraview_gets_grains_alone_and_the_cylinder_as_a_closed_surface_at_its_place(tmp_path):
    pytest.importorskip("vtkmodules")
    out, shown = made_up(tmp_path / "run", dragged_body.cylinder(2 * RADIUS, SIDE), "vtk")
    points, arrays, *_ = read(out / "vtk" / "grains_0001.vtp")
    assert len(points) == len(shown.grains["x"]) and np.array_equal(arrays["radius"], shown.grains["r"])
    assert set(arrays["role"]) == {0, 1}
    corners, _, data, cells = read(out / "vtk" / "intruder_0001.vtp")
    assert np.allclose(np.linalg.norm((corners - AT)[:, [0, 2]], axis=1), RADIUS, rtol=1e-6)
    assert set(np.round(corners[:, 1], 9)) == {0, SIDE} and len(cells) == 64 + 2
    # The area of a polygon of 64 corners.
    assert enclosed(data) == pytest.approx(64 / 2 * np.sin(2 * np.pi / 64) * RADIUS**2 * SIDE, rel=1e-5)
    assert (out / "vtk" / "intruder.pvd").exists()


def test_a_notched_outline_is_swept_with_the_volume_of_the_body(tmp_path):
    pytest.importorskip("vtkmodules")
    (tmp_path / "notched.csv").write_text("0, 0\n2, 0\n2, 2\n1, 0.5\n0, 2\n")
    body = dragged_body.of_shape(str(tmp_path / "notched.csv"), 0, SIDE, D)
    out, _ = made_up(tmp_path / "run", body, "vtk")
    corners, _, data, _ = read(out / "vtk" / "intruder_0001.vtp")
    assert enclosed(data) == pytest.approx(body.volume, rel=1e-5)
    assert np.allclose(corners.min(axis=0), AT + body.low) and np.allclose(corners.max(axis=0), AT + body.high)


def test_a_function_of_distance_becomes_a_mesh(tmp_path):
    pytest.importorskip("vtkmodules")
    text = "low, high = (-2.2,) * 3, (2.2,) * 3\ndef distance(p):\n    return (p**2).sum(axis=1) ** 0.5 - 1.5\n"
    (tmp_path / "ball.py").write_text(text)
    out, _ = made_up(tmp_path / "run", dragged_body.of_shape(str(tmp_path / "ball.py"), 0, SIDE, D), "vtk")
    corners, _, data, _ = read(out / "vtk" / "intruder_0001.vtp")
    # The distance is interpolated to 0.1^3/1.5^2; facets of a 48th of the diameter cut off 0.1 % of the volume.
    assert np.allclose(np.linalg.norm(corners - AT, axis=1), 1.5, atol=1e-3)
    assert enclosed(data) == pytest.approx(4 / 3 * np.pi * 1.5**3, rel=4e-3)


def test_a_turned_solid_is_shown_turned():
    half = np.sqrt(0.5)
    frame = Frame(0.0, {}, {}, dict(turn=np.array([half, 0, half, 0]), centre=np.array([1.0, 2, 3])), np.zeros(3))
    # A quarter about y takes x to -z and z to x.
    assert np.allclose(frame.place_solid([[1, 0, 0], [0, 5, 0], [0, 0, 1]]), [[1, 2, 2], [1, 7, 3], [2, 2, 3]])


def test_compressed_text_is_the_text(tmp_path):
    body = dragged_body.cylinder(2 * RADIUS, SIDE)
    out, shown = made_up(tmp_path / "run", body, "xyz,xyz.gz,lammps,lammps.gz")
    for name in ("frames.xyz", "frames.lammpstrj"):
        with gzip.open(out / f"{name}.gz", "rt") as file:
            assert file.read() == (out / name).read_text()
    ((_, columns),) = extended_xyz.read((out / "frames.xyz").read_text())
    assert len(columns["radius"]) == len(shown.grains["x"]) and (columns["radius"] == D / 2).all()


def test_the_films_cut_is_where_the_plane_meets_each_sphere(tmp_path):
    out, shown = made_up(tmp_path / "run", dragged_body.cylinder(2 * RADIUS, SIDE), "")
    bed = Run(out).frame(0)
    bed.grains["y"][:3] = [1.3, SIDE + 0.7, 2.0]
    _, _, radii = animation.cut(bed, 1.0)
    assert radii[:3] == pytest.approx([0.4, 0.4, 0])  # 0.5^2 - 0.3^2 = 0.4^2, the second through the periodic side
