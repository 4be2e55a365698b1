"""GrainLoop in a cell that YADE shears: the motion of YADE's own loop, the cell in O.cell, checkpoints, and refusals by name."""

import disks
import numpy as np
import pytest

from graindrive import engines
from graindrive.loops import grain_loop
from yade import Matrix3, O, Vector3

SIDE, RATE = 8, 2.0


def crowd(seed=3, side=SIDE, drive=None, rotation=True):
    """side^2 dense disks that move with the mean flow, on YADE's loop; returns the ids."""
    disks.new_scene(dt=1e-4, period=(side, side, side))
    O.cell.homoDeform = 1
    rng = np.random.default_rng(seed)
    ids = []
    for row in range(side):
        for column in range(side):
            x, y = column + 0.5 + rng.uniform(-0.02, 0.02), row + 0.5 + rng.uniform(-0.02, 0.02)
            ids.append(disks.disk(x, y, rng.uniform(0.46, 0.5), velocity=rng.uniform(-0.5, 0.5, 2)))
    disks.loop(disks.hertz(gamma_n=250, gamma_t=250), friction=0.4, before_newton=[drive] if drive else [])
    return ids


def sheared(rate=RATE, **numbers):
    crowd(**numbers)
    O.cell.velGrad = Matrix3(0, rate, 0, 0, 0, 0, 0, 0, 0)


def seen_from_one_image():
    """Positions and velocities (n, 4) of all bodies in the image whose height lies in the cell and whose x does too.

    Bodies stand one step further than O.cell.hSize, which YADE deforms at the start of a step.
    """
    width, height = O.cell.hSize[0][0], O.cell.hSize[1][1] * (1 + O.dt * O.cell.velGrad[1][1])
    tilt = O.cell.hSize[0][1] + O.dt * O.cell.velGrad[0][1] * O.cell.hSize[1][1]
    moving = np.array([O.cell.velGrad[0][1], O.cell.velGrad[1][1]]) * O.cell.hSize[1][1]
    found = []
    for body in O.bodies:
        x, v = np.array(body.state.pos)[:2], np.array(body.state.vel)[:2]
        up = np.floor(x[1] / height)
        x, v = x - up * np.array([tilt, height]), v - up * moving
        found.append([x[0] % width, x[1], *v, body.state.angVel[2]])
    return np.array(found)


def largest_difference(a, b):
    """Largest difference of two `seen_from_one_image`; a grain on a side may be seen at either."""
    d = a - b
    width, height = O.cell.hSize[0][0], O.cell.hSize[1][1]
    same_side = np.abs(d[:, 1]) < height / 2
    d[:, 0] -= width * np.round(d[:, 0] / width)
    return np.abs(d[same_side]).max()


def test_it_moves_as_on_yades_loop_and_follows_its_cell():
    sheared()
    disks.run(2500)
    yades, cell = seen_from_one_image(), str(O.cell.dict())
    sheared()
    loop = grain_loop.use_grain_loop()
    disks.run(2500)
    # Both loops agree to round-off, which collisions let grow; a strain of 0.5, velocities up to 16.
    assert largest_difference(seen_from_one_image(), yades) < 1e-9
    assert str(O.cell.dict()) == cell
    assert O.cell.hSize[0][1] == pytest.approx(2499 * O.dt * RATE * SIDE)
    assert loop.positions[:, 1].max() < SIDE + 1  # wrapped when new lists were made


def test_springs_and_stress_agree_with_yades_loop_in_mid_shear():
    """The drive reads the same contacts on both loops; the pressure makes the cell's height oscillate."""
    measured = []
    for on_grain in (False, True):
        drive = engines.ShearDrive(shearRate=RATE, pressure=2e3, pressureDamping=2e4, every=3, label="shear")
        crowd(drive=drive)
        if on_grain:
            grain_loop.use_grain_loop()
        disks.run(600)
        measured.append([*drive.sums, O.cell.hSize[1][1], O.cell.hSize[0][1], *drive.profileCounts])
    # GrainLoop keeps the affine part of the motion affine; YADE's homoDeform = 1 leaves velGrad^2 x dt out. With |growth| up to
    # 0.1 over a time of 0.06 the difference is 1e-3 of the velocities, and 1e-2 after the first collisions.
    assert measured[1] == pytest.approx(measured[0], rel=3e-2)
    assert abs(measured[1][15] - SIDE) > 1e-3 * SIDE


def test_shear_stops_and_begins_anew():
    found = []
    for on_grain in (False, True):
        sheared()
        if on_grain:
            grain_loop.use_grain_loop()
        disks.run(300)
        O.cell.velGrad = Matrix3.Zero
        disks.run(300)
        O.cell.velGrad = Matrix3(0, -RATE / 2, 0, 0, 0, 0, 0, 0, 0)
        disks.run(300)
        found.append(seen_from_one_image())
    assert largest_difference(*found) < 1e-9


@pytest.mark.parametrize("pressure", [0, 2e3])
def test_a_checkpoint_in_mid_shear_goes_on_with_the_same_bits(tmp_path, pressure):
    def scene():
        drive = engines.ShearDrive(shearRate=RATE, pressure=pressure, pressureDamping=2e4, label="shear")
        crowd(drive=drive)
        return grain_loop.use_grain_loop(), drive

    def state(drive):
        return disks.everything().tolist(), str(O.cell.dict()), list(drive.sums), drive.growth, O.time

    loop, drive = scene()
    disks.run(731)
    loop.checkpoint(str(tmp_path / "shear.checkpoint"))
    disks.run(200)
    expected = state(drive)
    loop, drive = scene()
    disks.run(5)
    loop.restore(str(tmp_path / "shear.checkpoint"))
    disks.run(200)
    assert state(drive) == expected


def test_saved_and_loaded_by_yade_it_goes_on(tmp_path):
    sheared()
    grain_loop.use_grain_loop()
    disks.run(400)
    O.save(str(tmp_path / "scene.xml.gz"))
    disks.run(200)
    expected = seen_from_one_image()
    O.load(str(tmp_path / "scene.xml.gz"))
    disks.run(200)
    # Lists are made again from bodies, in another order: round-off.
    assert largest_difference(seen_from_one_image(), expected) < 1e-9


def test_who_looks_between_steps_sees_images_and_leaves_no_trace():
    sheared()
    loop = grain_loop.use_grain_loop()
    for _ in range(40):
        disks.run(10)
        contacts = loop.contacts()
        radii = np.array([b.shape.radius for b in O.bodies])
        assert np.all(contacts["overlap"] < 0.1 * radii.min())
        loop.presentContacts()
    watched = disks.everything()
    sheared()
    grain_loop.use_grain_loop()
    disks.run(400)
    assert np.array_equal(disks.everything(), watched)


def test_the_energy_ledger_closes_and_knows_the_work_of_the_cell():
    drive = engines.ShearDrive(shearRate=RATE, pressure=2e3, pressureDamping=2e4, label="shear")
    crowd(drive=drive)
    loop = grain_loop.use_grain_loop(trackEnergy=True)
    disks.run(2000)
    energy = loop.energy
    assert energy["workOfCell"] > 0
    assert abs(energy["residual"]) < 1e-9 * energy["workOfCell"]


def test_the_loops_hand_a_sheared_scene_over_in_mid_shear():
    sheared()
    disks.run(300)
    whole = seen_from_one_image()
    crowd()
    grain_loop.use_grain_loop()
    O.cell.velGrad = Matrix3(0, RATE, 0, 0, 0, 0, 0, 0, 0)
    disks.run(200)
    grain_loop.use_yade_loop()  # its integrator must not take the gradient as a change, which would add up to 16 to velocities
    disks.run(100)
    # Contacts are found again in the cell of the step before: springs of new contacts lack one step.
    assert largest_difference(seen_from_one_image(), whole) < 0.05


def clumped():
    crowd()
    disks.clump([(-0.3, 0), (0.3, 0)], at=(4, 4))


def driven():
    ids = crowd()
    O.bodies[ids[5]].state.blockedDOFs = "xyzXYZ"
    O.bodies[ids[5]].state.vel = Vector3(0.1, 0, 0)


@pytest.mark.parametrize(
    "spoil, words",
    [
        (lambda: setattr(O.cell, "homoDeform", 2), "homoDeform must be 1"),
        (lambda: setattr(O.cell, "homoDeform", 0), "homoDeform must be 1"),
        (clumped, "only free disks"),
        (driven, "only free disks"),
        (lambda: setattr(O.engines[-1], "damping", 0.3), "damping"),
    ],
)
def test_what_a_sheared_cell_cannot_hold_is_refused_by_name(spoil, words):
    crowd()
    spoil()
    O.cell.velGrad = Matrix3(0, RATE, 0, 0, 0, 0, 0, 0, 0)
    with pytest.raises(ValueError, match=words):
        grain_loop.use_grain_loop()
        O.engines[-1]()


@pytest.mark.parametrize("entry", [(0, 0), (1, 0), (0, 2), (2, 2), (1, 2)])
def test_other_gradients_are_refused_by_name(entry):
    crowd()
    gradient = Matrix3.Zero
    gradient[entry] = 0.1
    O.cell.velGrad = gradient
    with pytest.raises(ValueError, match="only velGrad.0..1. .shear. and velGrad.1..1. .height."):
        grain_loop.use_grain_loop()


def test_fields_are_refused_where_images_slide():
    crowd(drive=engines.FieldAverager(origin=(4, 4, 0), low=(-2, -2, 0), high=(2, 2, 0), label="fields"))
    O.cell.velGrad = Matrix3(0, RATE, 0, 0, 0, 0, 0, 0, 0)
    grain_loop.use_grain_loop()
    with pytest.raises((ValueError, RuntimeError), match="sheared"):
        for _ in range(3):
            O.run(1, True)


def test_the_drive_goes_to_a_height_and_keeps_it():
    drive = engines.ShearDrive(shearRate=RATE, height=0.97 * SIDE, heightRate=1, label="shear")
    crowd(drive=drive)
    grain_loop.use_grain_loop()
    disks.run(1500)
    assert O.cell.hSize[1][1] == pytest.approx(0.97 * SIDE, rel=1e-12) and drive.growth == pytest.approx(0, abs=1e-9)
    area = sum(np.pi * b.shape.radius**2 for b in O.bodies)
    drive.clear()
    disks.run(50)
    assert drive.sums[9] / drive.samples == pytest.approx(area / (0.97 * SIDE**2), rel=1e-9)


@pytest.mark.parametrize(
    "numbers, words",
    [
        ({"shearRate": float("nan")}, "shearRate must be finite"),
        ({"pressure": -1.0}, "pressure must not be negative"),
        ({"pressure": 1.0, "height": 2.0}, "a pressure or a height"),
        ({"pressureDamping": 0.0}, "pressureDamping must be positive"),
        ({"every": 0}, "every must be at least 1"),
    ],
)
def test_numbers_of_the_drive_out_of_range_are_refused(numbers, words):
    with pytest.raises(ValueError, match=words):
        engines.ShearDrive(**numbers)
