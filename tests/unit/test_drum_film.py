"""The film of a drum: which frames are drawn side by side, the position of what is drawn, and runs with too few frames."""

import subprocess

import numpy as np
import pytest

from graindrive.beds import drum
from graindrive.parameters import StudyParameters, quantity
from graindrive.postproc import __main__ as command
from graindrive.postproc.drum import animation
from graindrive.postproc.drum.flow import BED_FRACTION
from graindrive.postproc.drum.flow_frames import FlowFrames
from graindrive.postproc.reader import Run
from graindrive.runs.run_folder import RunFolder

D, OMEGA, WALL = 40.0, 0.02, 126


class DrumKeys(StudyParameters):
    """The keys of a drum that its frames need."""

    unit_system = "grain"
    drum_diameter: float = quantity(D, "d", "D")
    angular_velocity: float = quantity(OMEGA, "sqrt(g/d)", "Omega")
    froude: float = quantity(OMEGA**2 * D / 2, "-", "Fr")


def grains(t):
    """A bed of 300 grains below the axis that rotates rigidly, and the wall's disks turned by Omega t."""
    rng = np.random.default_rng(3)
    radius, angle = 17 * np.sqrt(rng.uniform(0, 1, 300)), rng.uniform(-np.pi, 0, 300)
    x, y = radius * np.cos(angle), radius * np.sin(angle)
    bed = dict(id=np.arange(300), x=x, y=y, r=np.full(300, 0.5), vx=-OMEGA * y, vy=OMEGA * x, role=np.zeros(300, int))
    (c, s), (x0, y0) = (np.cos(OMEGA * t), np.sin(OMEGA * t)), drum.wall_places(D, WALL)
    x, y = c * x0 - s * y0, s * x0 + c * y0
    wall = dict(id=300 + np.arange(WALL), x=x, y=y, r=np.full(WALL, 0.5), vx=-OMEGA * y, vy=OMEGA * x)
    return bed, {}, {**wall, "centre": np.zeros(2)}


def flow():
    """The arrays of a continuum that rotates rigidly below the axis."""
    x = np.linspace(-25, 25, 50)
    inside = (np.hypot(x, x[:, None]) < D / 2) & (x[:, None] < 0)
    velocity = OMEGA * np.stack(np.broadcast_arrays(-x[:, None], x), axis=-1)
    return dict(
        x=x, y=x, area_fraction=BED_FRACTION * inside, velocity=velocity, pressure=np.where(inside, -x[:, None], 0.0)
    )


def make(out, of_grains=(), of_flow=()):
    """Write a run with frames of grains and of the continuum at these times; return its folder."""
    with RunFolder(DrumKeys(out=str(out)), study="drum") as folder:
        for t in of_grains:
            folder.frame(t, *grains(t))
        for number, t in enumerate(of_flow, start=1):
            folder.write(f"flow_frames/{number:04d}", flow(), t=float(t))
        folder.summarize(froude=OMEGA**2 * D / 2)
    return out


def count_frames(film):
    """Return how many frames a film has."""
    probe = ["ffprobe", "-v", "error", "-count_frames", "-show_entries", "stream=nb_read_frames", "-of", "csv=p=0"]
    return int(
        subprocess.run([*probe, str(film)], capture_output=True, text=True, check=True).stdout.strip().strip(",")
    )


def test_each_picture_of_grains_has_the_continuum_of_its_time_beside_it(tmp_path):
    moments = animation.Moments(Run(make(tmp_path / "run", (0, 10, 20, 30), (0, 10, 17))))
    assert [(moment.t, moment.flow.t) for moment in moments] == [(0, 0), (10, 10), (20, 17), (30, 17)]
    assert moments.apart == 10


@pytest.mark.parametrize("of_grains, of_flow, panels", [((0, 40), (), 1), ((), (0, 40, 80), 1), ((0, 40), (0, 30), 2)])
def test_a_drum_is_filmed_frame_by_frame(tmp_path, of_grains, of_flow, panels):
    out = make(tmp_path / "run", of_grains, of_flow)
    film = command.film_of(str(out))(out)
    assert count_frames(film) == len(of_grains or of_flow)
    figure, draw = animation.prepared(Run(out))
    draw(animation.Moments(Run(out))[1])
    assert len([axes for axes in figure.axes if axes.get_aspect() == 1.0]) == panels


def test_the_wall_turns_in_the_picture_of_grains_and_of_the_continuum(tmp_path):
    """The sectors of the wall have turned by Omega t, both of the grains' disks and of the continuum's rim."""
    out, t = make(tmp_path / "run", (0, 20.0), (0, 20.0)), 20.0
    figure, draw = animation.prepared(Run(out))
    draw(animation.Moments(Run(out))[1])
    beds, rims = figure.axes[0], figure.axes[1]
    black = beds.collections[1].get_offsets()
    first = np.degrees(np.arctan2(*black[0][::-1]))
    wedge = min((patch for patch in rims.patches if hasattr(patch, "theta1")), key=lambda patch: patch.theta1)
    assert first == pytest.approx(np.degrees(OMEGA * t), abs=1e-6) and wedge.theta1 == pytest.approx(first)


def test_colours_are_speeds_over_omega_d(tmp_path):
    out = make(tmp_path / "run", (0, 20.0), (0, 20.0))
    figure, draw = animation.prepared(Run(out))
    moment = animation.Moments(Run(out))[0]
    draw(moment)
    drawn = figure.axes[0].collections[0].get_array()
    np.testing.assert_allclose(drawn, np.hypot(moment.grains.grains["x"], moment.grains.grains["y"]) / D, rtol=1e-12)
    cells = figure.axes[1].collections[0].get_array()
    x, y = np.meshgrid(moment.flow.x, moment.flow.y)
    seen = moment.flow.arrays["area_fraction"] > 0
    np.testing.assert_allclose(np.ma.compressed(cells), np.hypot(x, y)[seen] / D, rtol=1e-6)  # kept in single precision


@pytest.mark.parametrize("of_grains, of_flow", [((5,), ()), ((), (5,)), ((5,), (0, 5))])
def test_a_run_of_one_picture_is_no_film(tmp_path, of_grains, of_flow):
    from graindrive.postproc.reader import RunError

    out = make(tmp_path / "run", of_grains, of_flow)
    with pytest.raises(RunError, match="holds 1 frames, a film needs more; run again with frames=200 or so"):
        animation.film(out)
    assert not (out / "animation.mp4").exists()


def test_pictures_of_a_continuum_go_to_paraview_where_the_grains_are(tmp_path):
    pytest.importorskip("vtkmodules")
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkIOXML import vtkXMLImageDataReader

    from graindrive.exports import exports

    out = make(tmp_path / "run", (0, 10), (0, 10))
    exports.write(out, ["vtk"])
    listed = (out / "vtk" / "flow.pvd").read_text()
    assert 'timestep="0.0" file="flow_0001.vti"' in listed and 'timestep="10.0" file="flow_0002.vti"' in listed
    reader = vtkXMLImageDataReader()
    reader.SetFileName(str(out / "vtk" / "flow_0002.vti"))
    reader.Update()
    data, frame = reader.GetOutput(), FlowFrames(Run(out))[1]
    assert data.GetOrigin()[:2] == pytest.approx((frame.x[0], frame.y[0]))  # the axis at 0, as that of the grains
    assert data.GetSpacing()[0] == pytest.approx(frame.x[1] - frame.x[0])
    values = vtk_to_numpy(data.GetPointData().GetArray("velocity")).reshape(50, 50, 3)
    np.testing.assert_array_equal(values[..., :2], frame.arrays["velocity"])
