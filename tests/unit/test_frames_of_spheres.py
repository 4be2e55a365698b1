"""Frames of spheres: their contents on both loops, and what is read back from a run folder and from its exports."""

import disks
import extended_xyz
import numpy as np
import pytest
import spheres
from graindrive import engines
from graindrive.exports import exports
from graindrive.loops import grain_loop
from graindrive.runs import picture
from graindrive.scenes import scene
from graindrive.runs.block_means import block_means
from graindrive.base.errors import UsageError
from graindrive.postproc import quantities
from graindrive.postproc.reader import Frame, Run
from made_up_frames import DT, Parameters
from graindrive.runs.run_folder import RunFolder
from yade import O

SIDE = 5


@pytest.fixture(autouse=True)
def after():
    yield
    O.reset()


def crowd(loop):
    """A bed above a held base with a body of two beads across the periodic side; return ids of grains, base and body."""
    spheres.bed(layers=3, side=SIDE)
    base = [b.id for b in O.bodies if b.state.blockedDOFs]
    grains = [b.id for b in O.bodies if not b.state.blockedDOFs]
    body, _ = spheres.clump([(-0.4, 0, 0), (0.4, 0, 0)], at=(2 * SIDE + 0.2, 2.5, 5.05), radius=0.5)
    O.bodies[grains[-1]].state.pos += (-3 * SIDE, 0, 0)  # in an image far away, as after a long run on YADE's loop
    spheres.loop(disks.hertz(gamma_n=200, gamma_t=200), 0.3, gravity=(0.5, 0, -10))
    if loop == "grain":
        grain_loop.use_grain_loop(periods=(SIDE, SIDE, 0))
    disks.run(3000)
    return grains, base, body


def frame_of(shown):
    return Frame(0.0, shown.grains, shown.contacts, shown.intruder, shown.period)


@pytest.mark.parametrize("loop", ["yade", "grain"])
def test_contacts_are_the_pairs_that_overlap_now(loop):
    shown = picture.taken(*crowd(loop))
    frame = frame_of(shown)
    grain = frame.disks()
    places = frame.along_axes(grain)
    way = places[:, None] - places
    way[..., :2] -= SIDE * np.round(way[..., :2] / SIDE)
    touch = np.linalg.norm(way, axis=-1) < grain["r"][:, None] + grain["r"]
    touch &= ~((grain["role"][:, None] == grain["role"]) & (grain["role"] > 0))
    i, j = np.nonzero(np.triu(touch, 1))
    expected = sorted(tuple(sorted(pair)) for pair in zip(grain["id"][i], grain["id"][j]))
    assert list(zip(shown.contacts["id_i"], shown.contacts["id_j"])) == expected and len(expected) > 40
    assert (places[:, :2] >= -0.9).all() and (places[: len(shown.grains["x"]), :2] < SIDE).all()
    begin, end = frame.contact_ends()
    radii = dict(zip(grain["id"], grain["r"]))
    reach = [radii[a] + radii[b] for a, b in expected]
    assert (np.linalg.norm(end - begin, axis=1) < reach).all()


def test_both_loops_show_the_same():
    yades, fast = (picture.taken(*crowd(loop)) for loop in ("yade", "grain"))
    assert np.abs(yades.contacts["slip_y"]).max() > 1e-5 and np.abs(yades.contacts["ft_z"]).max() > 1e-2
    # The loops turn springs by different formulas, so positions differ by less than 1e-6; the stiffness is 2e5.
    for part, tolerance in (("grains", 1e-5), ("intruder", 1e-5)):
        for name, column in getattr(yades, part).items():
            assert np.abs(column - getattr(fast, part)[name]).max() < tolerance, name
    assert np.array_equal(yades.contacts["id_j"], fast.contacts["id_j"])
    for name in ("slip_x", "slip_y", "slip_z"):
        assert np.abs(yades.contacts[name] - fast.contacts[name]).max() < 1e-6
    for name in ("fn", "ft_x", "ft_y", "ft_z"):
        assert np.abs(yades.contacts[name] - fast.contacts[name]).max() < 0.05


def made_up(out, export):
    """A run with two frames of many spheres; return the folder and its frames."""
    ids, shown = crowd("grain"), []
    with RunFolder(Parameters(out=str(out), export=export), study="wiggle") as folder:
        folder.note(dt=DT)
        folder.write("intruder", dict(beads=np.array([[-0.4, 0], [0.4, 0]]), bead_radius=0.5))
        for k in range(2):
            disks.run(100)
            shown.append(picture.taken(*ids))
            folder.frame(2.0 * k, *shown[-1])
    return out, shown


def test_a_run_folder_gives_back_what_it_was_given_with_units(tmp_path):
    out, shown = made_up(tmp_path / "run", "")
    run = Run(out)
    frame = run.frame(1)
    assert frame.axes == "xyz" and np.array_equal(frame.periods, [SIDE, SIDE, 0])
    for part in ("grains", "contacts", "intruder"):
        for name, column in getattr(shown[1], part).items():
            assert np.array_equal(getattr(frame, part)[name], column)
    assert np.allclose(frame.speed, np.sqrt(sum(frame.grains[f"v{axis}"] ** 2 for axis in "xyz")))
    units = exports.units_of(run)
    assert (
        units["fn"] == units["ft_z"] == quantities.DIMENSIONS["force on spheres"][1] and units["spin_y"] == "sqrt(g/d)"
    )


def test_extended_xyz_holds_three_columns_of_each_vector(tmp_path):
    out, shown = made_up(tmp_path / "run", "xyz,lammps")
    frames = extended_xyz.read((out / "frames.xyz").read_text())
    assert len(frames) == 2
    for (settings, columns), one in zip(frames, shown):
        frame = frame_of(one)
        grain = frame.disks()
        places = frame.along_axes(grain)
        places[:, :2] %= SIDE
        assert settings["pbc"] == [True, True, False] and settings["spin_unit"] == "sqrt(g/d)"
        assert np.allclose(columns["pos"], places, rtol=1e-11, atol=1e-11)
        assert np.allclose(columns["velo"], frame.along_axes(grain, "v{}"), rtol=1e-11)
        assert np.allclose(columns["spin"], frame.along_axes(grain, "spin_{}"), rtol=1e-11)
        assert np.array_equal(np.diag(settings["Lattice"])[:2], [SIDE, SIDE])
        low, high = settings["Origin"][2], settings["Origin"][2] + settings["Lattice"][2, 2]
        assert (places[:, 2] - grain["r"] > low - 1e-9).all() and (places[:, 2] + grain["r"] < high + 1e-9).all()
    dump = (out / "frames.lammpstrj").read_text()
    assert "BOX BOUNDS pp pp ff\n" in dump and "radius omegax omegay omegaz\n" in dump


def read(path):
    """Return the data set that VTK reads from a file, and the arrays of its points or cells (`data`) with their units."""
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkCommonCore import vtkDataArray
    from vtkmodules.vtkIOXML import vtkXMLPolyDataReader

    def arrays_of(data):
        found = [data.GetArray(k) for k in range(data.GetNumberOfArrays())]
        return {a.GetName(): (vtk_to_numpy(a), a.GetInformation().Get(vtkDataArray.UNITS_LABEL())) for a in found}

    reader = vtkXMLPolyDataReader()
    reader.SetFileName(str(path))
    reader.Update()
    data = reader.GetOutput()
    return vtk_to_numpy(data.GetPoints().GetData()), arrays_of(data.GetPointData()), arrays_of(data.GetCellData())


def test_paraview_gets_vectors_in_space(tmp_path):
    pytest.importorskip("vtkmodules")
    out, shown = made_up(tmp_path / "run", "vtk")
    frame = frame_of(shown[1])
    points, arrays, _ = read(out / "vtk" / "grains_0002.vtp")
    assert np.allclose(points, frame.along_axes(frame.disks()), rtol=1e-6)
    assert np.array_equal(arrays["spin"][0], frame.along_axes(frame.disks(), "spin_{}"))
    assert np.array_equal(arrays["velocity"][0], frame.along_axes(frame.disks(), "v{}"))
    _, _, arrays = read(out / "vtk" / "contacts_0002.vtp")
    assert np.array_equal(arrays["tangential_force"][0], frame.along_axes(frame.contacts, "ft_{}"))
    assert np.array_equal(arrays["slip"][0], frame.along_axes(frame.contacts, "slip_{}"))
    assert arrays["tangential_force"][1] == "rho g d^3"
    assert not (out / "vtk" / "intruder.pvd").exists(), "the body is its beads, among the grains"


def test_rows_of_spheres_have_three_columns_and_bodies_the_mass_of_a_sphere():
    disks.new_scene(dt=1e-4)
    ids = scene.add_spheres([(0, 0, 0), (2, 1, 3)], [0.5, 0.4], 2.0)
    O.bodies[1].state.vel, O.bodies[1].state.angVel = (1, 2, 3), (4, 5, 6)
    spheres.loop()
    assert O.bodies[0].state.mass == pytest.approx(2 * np.pi / 6) and scene.dimensions() == 3
    assert O.bodies[0].state.inertia[1] == pytest.approx(0.1 * O.bodies[0].state.mass)
    for _ in range(2):
        row = {name: column[1] for name, column in scene.rows_of(ids).items()}
        assert row == dict(x=2, y=1, z=3, r=0.4, vx=1, vy=2, vz=3, spin_x=4, spin_y=5, spin_z=6)
        if not scene.fast_loop():
            grain_loop.use_grain_loop()


def test_means_of_forces_in_the_plane_are_refused_among_spheres():
    disks.new_scene(dt=1e-4)
    spheres.sphere((0, 0, 0)), spheres.sphere((2, 1, 3))
    binner = engines.ContactForceBinner(body=0)
    spheres.loop(before_newton=[binner])
    grain_loop.use_grain_loop()
    with pytest.raises(UsageError, match="block_means records forces in the plane"):
        block_means(binner)
