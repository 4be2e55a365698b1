"""Fields from an averager into a run folder and back, and their drawing."""

import math

import disks
import matplotlib.pyplot as plt
import numpy as np
import pytest
import spheres
from graindrive import engines
from graindrive.runs.fields import GRAIN, SI, SI_IN_SPACE, write_fields
from graindrive.parameters import StudyParameters
from graindrive.postproc import fields as results
from graindrive.postproc.figures import STYLE
from graindrive.postproc.reader import Run, RunError
from graindrive.runs.run_folder import RunFolder
from yade import O


@pytest.fixture(scope="module")
def averaged():
    """Disks on a circle that turn around the origin: 30 steps, three phases, the last without a sample."""
    disks.new_scene(dt=1e-3)
    for angle in 2 * math.pi * np.arange(9) / 9:
        x, y = 2 * math.cos(angle), 2 * math.sin(angle)
        disks.disk(x, y, velocity=(-2 * y, 2 * x), spin=2)
    options = dict(low=(-3, -3, 0), high=(3, 3, 0), spacing=0.2, phases=3, period=0.045)
    fine = engines.FieldAverager(kernel="diskBin", stress=False, **options)
    smooth = engines.FieldAverager(kernel="gaussian", **options)
    disks.loop(before_newton=[fine, smooth])
    disks.run(30)
    yield fine, smooth
    O.reset()


@pytest.fixture(scope="module")
def run(averaged, tmp_path_factory):
    out = tmp_path_factory.mktemp("fields") / "run"
    with RunFolder(StudyParameters(out=str(out)), study="magnus") as folder:
        write_fields(folder, "fine", averaged[0])
        write_fields(folder, "smooth", averaged[1], GRAIN)
    return Run(out)


def test_everything_comes_back_with_units_and_settings(averaged, run):
    found, averager = results.read(run, "fine"), averaged[0]
    np.testing.assert_array_equal(found.x, averager.x)
    np.testing.assert_array_equal(found.samples, [15, 15, 0])
    for name, attribute in dict(area_fraction="areaFraction", velocity="velocity", temperature="temperature").items():
        np.testing.assert_array_equal(found.arrays[name], getattr(averager, attribute))
    assert found.units["velocity"] == SI.velocity == "m/s" and found.units["temperature"] == "m^2/s^2"
    assert found.settings["kernel"] == "diskBin" and found.settings["phases"] == 3
    assert "pressure" not in found.arrays
    smooth = results.read(run, "smooth")
    assert smooth.units["pressure"] == "rho g d" and smooth.arrays["contact_stress"].shape == (3, 30, 30, 2, 2)


def test_phases_are_averaged_by_their_samples(averaged, run):
    fields = results.read(run, "fine")
    fraction = fields.map("area_fraction")
    np.testing.assert_allclose(fraction, averaged[0].areaFraction[:2].mean(axis=0), rtol=1e-14)
    assert fraction.sum() * 0.2**2 == pytest.approx(9 * math.pi / 4, rel=1e-12)
    v_x, v_y = fields.velocity()
    np.testing.assert_array_equal(np.isnan(v_x), fraction == 0)
    inside = fraction > 1 - 1e-12
    # The disks turn with their circle: v = omega x r, except that a step of 1e-3 moves them along a chord, not an arc.
    expected = -2 * np.broadcast_to(fields.y[:, None], v_x.shape)
    np.testing.assert_allclose(v_x[inside], expected[inside], atol=0.15)
    assert np.isnan(fields.map("speed", phase=2)).all() and fields.map("speed", phase=0).shape == (30, 30)


def test_names_that_are_not_there(run):
    with pytest.raises(RunError, match="holds no fields of the name coarse"):
        results.read(run, "coarse")
    with pytest.raises(RunError, match="area_fraction, density, speed, temperature; there is no pressure"):
        results.read(run, "fine").map("pressure")


@pytest.mark.parametrize("name", ["fine", "smooth"])
def test_maps_and_streamlines_show_the_fields(run, name):
    fields = results.read(run, name)
    with plt.rc_context(STYLE):
        figure, axes = plt.subplots()
        mesh = results.draw_map(axes, fields, "speed")
        lines = results.draw_streamlines(axes, fields)
        figure.canvas.draw()
    np.testing.assert_array_equal(np.ma.getmaskarray(mesh.get_array()).ravel(), np.isnan(fields.map("speed")).ravel())
    assert axes.get_xlim() == pytest.approx((-3, 3))
    segments = np.array(lines.lines.get_segments())
    # The disks are on a circle of radius 2 with a hole of radius 1.5; no line extends much beyond the circle.
    radius = np.hypot(*segments.reshape(-1, 2).T)
    assert len(segments) > 50 and radius.max() < 3.5
    assert name == "smooth" or radius.min() > 1.2
    middle, along = segments.mean(axis=1), segments[:, 1] - segments[:, 0]
    turning = middle[:, 0] * along[:, 1] - middle[:, 1] * along[:, 0]
    assert (turning > 0).mean() > 0.95  # counter-clockwise, like the disks
    assert axes.get_xlabel() == {"fine": "$x$  [m]", "smooth": "$x$  [$d$]"}[name]
    plt.close(figure)


# ---- spheres, averaged along an axis ----


@pytest.fixture(scope="module")
def in_space(tmp_path_factory):
    """Spheres on a ring about y that turn from x up to z and move along y: averaged along y, and on a grid in space."""
    disks.new_scene(dt=1e-3, period=(8, 4, 8))
    for angle in 2 * math.pi * np.arange(9) / 9:
        x, z = 2 * math.cos(angle), 2 * math.sin(angle)
        for y in (0.5, 2.5):
            spheres.sphere((x, y, z), velocity=(-2 * z, 0.5, 2 * x))
    options = dict(dimensions=3, low=(-3, 0, -3), high=(3, 4, 3), width=0.5, cutoff=3)
    row = engines.FieldAverager(averageAlong="y", spacing=0.2, **options)
    full = engines.FieldAverager(spacing=0.5, **options)
    spheres.loop(before_newton=[row, full])
    disks.run(3)
    out = tmp_path_factory.mktemp("fields") / "run"
    with RunFolder(StudyParameters(out=str(out)), study="lift") as folder:
        write_fields(folder, "row", row)
        write_fields(folder, "grains", row, GRAIN)
        write_fields(folder, "full", full)
    yield row, Run(out)
    O.reset()


def test_fields_of_spheres_come_back_with_their_axes_and_units(in_space):
    averager, run = in_space
    found = results.read(run, "row")
    assert found.axes == "xz" and found.fraction == "solid_fraction"
    np.testing.assert_array_equal(found.x, averager.x)
    np.testing.assert_array_equal(found.y, averager.z)
    assert found.units["density"] == SI_IN_SPACE.density == "kg/m^3" and found.units["pressure"] == "N/m^2"
    assert results.read(run, "grains").units["pressure"] == "rho g d"
    np.testing.assert_array_equal(found.arrays["contact_stress"], averager.contactStress)
    fraction = found.map("solid_fraction")
    # The cut at 3 w leaves a step of exp(-9) of the peak.
    assert fraction.sum() * 0.2**2 * 4 == pytest.approx(18 * math.pi / 6, rel=1e-3)
    v_x, v_z = found.velocity()
    np.testing.assert_allclose(v_z, averager.velocity[0, ..., 2], rtol=4 * disks.EPS)  # times a weight, and over it
    np.testing.assert_allclose(found.map("speed"), np.linalg.norm(averager.velocity[0], axis=-1), rtol=1e-14)
    assert found.map("contact_pressure").shape == (30, 30)


def test_a_grid_in_space_is_refused_where_planes_are_drawn(in_space):
    with pytest.raises(RunError, match="the fields full of .* lie on a grid along xyz; maps and exports show planes"):
        results.read(in_space[1], "full")


def test_maps_and_streamlines_of_spheres_have_their_axes(in_space):
    fields = results.read(in_space[1], "row")
    with plt.rc_context(STYLE):
        figure, axes = plt.subplots()
        results.draw_map(axes, fields, "speed")
        lines = results.draw_streamlines(axes, fields)
        figure.canvas.draw()
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("$x$  [m]", "$z$  [m]")
    segments = np.array(lines.lines.get_segments())
    middle, along = segments.mean(axis=1), segments[:, 1] - segments[:, 0]
    assert ((middle[:, 0] * along[:, 1] - middle[:, 1] * along[:, 0]) > 0).mean() > 0.9  # from x up to z
    plt.close(figure)
