"""The film of a Magnus run and the body in its figure: with the orientation of its beads, among the passing grains."""

import subprocess

import numpy as np
import pytest

from graindrive.parameters import StudyParameters, quantity
from graindrive.postproc.figures import plt
from graindrive.postproc.magnus import animation, body
from graindrive.postproc.reader import Run, RunError
from graindrive.runs.run_folder import RunFolder
from graindrive.study import Constant

D, WIDTH, V0, SPIN_RATIO, SIZE = 0.02, 20.0, 0.5, 3.0, 4.0
SPIN = SPIN_RATIO * V0 / (SIZE * D / 2)
CORNERS = D * np.array([[2.0, 0.0], [-1.0, 1.5], [-1.0, -1.5]])


class Keys(StudyParameters):
    """The keys of a Magnus run that its pictures need."""

    unit_system = "SI"
    shape: str = quantity("triangle", "-", "shape")
    phi: float = quantity(0.3, "-", "area fraction")
    v0: float = quantity(V0, "m/s", "speed")
    spin_ratio: float = quantity(SPIN_RATIO, "-", "spin ratio")
    mu: float = quantity(0.5, "-", "friction")
    width: float = quantity(WIDTH, "d", "length of the channel")
    height: float = quantity(12.0, "d", "height of the channel")
    intruder_diameter: float = quantity(SIZE, "d", "size")


def make(out, *, shape="triangle", times=(0.0, 0.02, 0.04)):
    """Write a run with pictures at these times: a body that turns as it moves, 60 grains, and walls above and below."""
    rng = np.random.default_rng(4)
    constants = dict(d=Constant(D, "m", "mean diameter"))
    with RunFolder(Keys(out=str(out), shape=shape), study="magnus", constants=constants) as folder:
        beads = np.zeros((1, 2)) if shape == "disk" else CORNERS
        outline = {} if shape == "disk" else dict(outline=(CORNERS, "m"))
        folder.write(
            "intruder", dict(beads=(beads, "m"), bead_radius=(2 * D if shape == "disk" else 0.2 * D, "m"), **outline)
        )
        folder.declare_series(t="s", travel="d")
        folder.append(t=np.array(times), travel=V0 * np.array(times) / D)
        for t in times:
            folder.frame(t, *picture(rng, shape, beads, t))
    return out


def picture(rng, shape, beads, t):
    """Return grains, contacts and body of a frame, and the period."""
    x = rng.uniform(0, WIDTH * D, 80)
    y = np.r_[rng.uniform(-5 * D, 5 * D, 60), np.repeat([-6 * D, 6 * D], 10)]
    grains = dict(id=np.arange(80), x=x, y=y, r=np.full(80, D / 2), vx=np.full(80, 0.1), vy=np.zeros(80))
    grains.update(spin=np.zeros(80), role=np.repeat([0, 1], [60, 20]))
    angle, centre = SPIN * t, np.array([WIDTH * D / 2 + V0 * t, 0.0])
    cos, sin = np.cos(angle), np.sin(angle)
    places = beads @ np.array([[cos, sin], [-sin, cos]]) + centre
    there = dict(
        id=80 + np.arange(len(beads)), x=places[:, 0], y=places[:, 1], r=np.full(len(beads), 0.2 * D), centre=centre
    )
    there.update({name: np.zeros(len(beads)) for name in ("vx", "vy", "spin")})
    if shape == "disk":
        there["angle"] = np.arctan2(sin, cos)
    return grains, None, there, WIDTH * D


@pytest.mark.parametrize("shape", ["triangle", "disk"])
def test_the_body_is_turned_by_its_angle(tmp_path, shape):
    run = Run(make(tmp_path / "run", shape=shape))
    for k, t in enumerate((0.0, 0.02, 0.04)):
        angle = body.turned(run, run.frame(k))
        assert np.exp(1j * angle) == pytest.approx(np.exp(1j * SPIN * t), abs=1e-12)
    assert body.turned(run) == pytest.approx(SPIN * 0.04)  # without a frame: the motion that the drive imposes


def test_the_outline_is_drawn_where_the_beads_are(tmp_path):
    run = Run(make(tmp_path / "run"))
    figure, axes = plt.subplots()
    body.draw(axes, run, body.turned(run, run.frame(-1)), unit=D, swept=True)
    beads = np.column_stack([run.frame(-1).intruder[name] for name in "xy"]) - run.frame(-1).intruder["centre"]
    outline, swept = axes.patches[:2]
    assert outline.get_xy()[:-1] == pytest.approx(beads / D)
    assert swept.get_radius() == pytest.approx(np.hypot(*CORNERS.T).max() / D + 0.2)
    plt.close(figure)


def test_grains_pass_the_body_in_the_image_nearest_to_it(tmp_path):
    bed = Run(make(tmp_path / "run")).frame(-1)
    x, y = animation.relative(bed)
    assert np.abs(x).max() <= WIDTH * D / 2
    away = (x + bed.intruder["centre"][0] - bed.grains["x"]) / (WIDTH * D)
    assert away == pytest.approx(np.round(away), abs=1e-12) and y == pytest.approx(bed.grains["y"])


def test_a_run_is_filmed_frame_by_frame(tmp_path):
    film = animation.film(make(tmp_path / "run"))
    probe = ["ffprobe", "-v", "error", "-count_frames", "-show_entries", "stream=nb_read_frames", "-of", "csv=p=0"]
    counted = subprocess.run([*probe, str(film)], capture_output=True, text=True, check=True)
    assert int(counted.stdout.strip().strip(",")) == 3


def test_one_frame_is_no_film(tmp_path):
    with pytest.raises(RunError, match="holds 1 frames, a film needs more"):
        animation.film(make(tmp_path / "run", times=(0.0,)))
