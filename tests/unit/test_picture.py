"""Frames of a scene: present contacts with the sign of their forces, all in one periodic image, on both loops."""

import disks
import numpy as np
import pytest
from graindrive.loops import grain_loop
from graindrive.runs import picture
from graindrive.postproc.reader import Frame
from yade import O

WIDTH = 8.0
# The same law on the same numbers: round-off of positions of 8 or so, times a stiffness of 2e5.
ROUND_OFF = 8 * disks.EPS * 2e5


@pytest.fixture(autouse=True)
def after():
    yield
    O.reset()


def crowd(seed=1):
    """A periodic crowd of overlapping disks, a clump among them, two frozen rows; return ids of grains, base and body.

    Disks lie in periodic images far away, as after a long run on YADE's loop.
    """
    disks.new_scene(dt=1e-4, period=(WIDTH, 40, 5))
    rng = np.random.default_rng(seed)
    base = [disks.disk(x + 0.5, y, frozen=True) for x in range(8) for y in (0, 6)]
    grains = []
    for x in range(8):
        for y in range(1, 6):
            if (x, y) not in ((0, 3), (7, 3)):
                at = (x + 0.5 + WIDTH * rng.integers(-2, 3), y)
                grains.append(disks.disk(*at, rng.uniform(0.501, 0.52), rng.uniform(-2, 2, 2), rng.uniform(-2, 2)))
    body, _ = disks.clump([(-0.5, 0), (0.5, 0)], at=(-3 * WIDTH, 3.0), radius=0.51)
    disks.loop(disks.hertz(gamma_n=2000, gamma_t=250), friction=0.3)
    return grains, base, body


def frame_of(shown):
    return Frame(0.0, shown.grains, shown.contacts, shown.intruder, shown.period)


def overlapping(shown, base_count):
    """Return the pairs of ids that overlap, by all distances; frozen pairs and those of the clump left out."""
    disk = frame_of(shown).disks()
    dx = disk["x"][:, None] - disk["x"]
    dx -= WIDTH * np.round(dx / WIDTH)
    touch = np.hypot(dx, disk["y"][:, None] - disk["y"]) < disk["r"][:, None] + disk["r"]
    role = disk["role"]
    touch &= ~((role[:, None] == role) & (role > 0))
    i, j = np.nonzero(np.triu(touch, 1))
    return sorted(tuple(sorted(pair)) for pair in zip(disk["id"][i], disk["id"][j]))


def pictures(steps):
    """Return the picture after some steps under each loop, from the same start."""
    taken = []
    for fast in (False, True):
        ids = crowd()
        if fast:
            grain_loop.use_grain_loop(periods=(WIDTH, 0))
        if steps:
            disks.run(steps)
        taken.append(picture.taken(*ids))
    return taken


@pytest.mark.parametrize("steps", [0, 1, 300])
def test_contacts_are_the_pairs_that_overlap_now(steps):
    for shown in pictures(steps):
        pairs = list(zip(shown.contacts["id_i"], shown.contacts["id_j"]))
        assert pairs == overlapping(shown, 16) and len(pairs) > 60


@pytest.mark.parametrize("steps, tolerance", [(0, ROUND_OFF), (300, 1e-4)])  # 1e-9 of round-off in 300 steps times 1e5
def test_both_loops_show_the_same_contacts(steps, tolerance):
    yades, fast = pictures(steps)
    for part in ("grains", "contacts", "intruder"):
        for name, column in getattr(yades, part).items():
            np.testing.assert_allclose(getattr(fast, part)[name], column, rtol=1e-6, atol=tolerance, err_msg=name)
    fn, ft = yades.contacts["fn"], yades.contacts["ft"]
    assert (fn > 0).any() and (ft < 0).any() and (ft > 0).any()
    assert steps or (fn < 0).any(), "at first some disks separate fast"


@pytest.mark.parametrize("steps", [0, 300])
def test_a_contact_stands_beside_its_first_side_and_its_line_is_as_long_as_two_radii(steps):
    for shown in pictures(steps):
        disk, c = frame_of(shown).disks(), shown.contacts
        row = {id_: k for k, id_ in enumerate(disk["id"])}
        i, j = (np.array([row[id_] for id_ in c[name]]) for name in ("id_i", "id_j"))
        start, end = frame_of(shown).contact_ends()
        assert np.array_equal(start, np.c_[disk["x"], disk["y"]][i])
        length, reach = np.hypot(*(end - start).T), disk["r"][i] + disk["r"][j]
        assert ((length < reach) & (length > 0.9 * reach)).all()
        point = np.c_[c["px"], c["py"]]
        # The middle of the overlap has the same distance to both rims.
        inside_i = disk["r"][i] - np.hypot(*(point - start).T)
        inside_j = disk["r"][j] - np.hypot(*(point - end).T)
        np.testing.assert_allclose(inside_i, inside_j, atol=20 * disks.EPS * WIDTH)
        assert (shown.grains["x"] >= 0).all() and (shown.grains["x"] < WIDTH).all()
        assert (np.abs(start[:, 0] - end[:, 0]) > 0.5).any() and ((end[:, 0] < 0) | (end[:, 0] > WIDTH)).any()


def test_the_body_is_never_cut_in_two():
    for shown in pictures(0):
        assert shown.intruder["centre"] == pytest.approx([0, 3])  # three periods to the left
        assert shown.intruder["x"] == pytest.approx([-0.5, 0.5])


def test_forces_of_a_picture_add_up_to_those_on_a_grain():
    """-fn n + ft (z x n) on i and the opposite on j are the accelerations of the next step."""
    grains, base, body = crowd()
    shown = picture.taken(grains, base, body)
    c, frame = shown.contacts, frame_of(shown)
    start, end = frame.contact_ends()
    n = (end - start) / np.hypot(*(end - start).T)[:, None]
    force = -c["fn"][:, None] * n + c["ft"][:, None] * np.c_[-n[:, 1], n[:, 0]]
    total = np.zeros((len(O.bodies), 2))
    np.add.at(total, c["id_i"], force)
    np.add.at(total, c["id_j"], -force)
    before = {id_: np.array(O.bodies[id_].state.vel)[:2] for id_ in grains}
    O.step()
    kick = [O.bodies[id_].state.mass * (np.array(O.bodies[id_].state.vel)[:2] - before[id_]) / O.dt for id_ in grains]
    np.testing.assert_allclose(total[grains], kick, rtol=1e-9, atol=8 * disks.EPS / O.dt)  # velocities of 2 over dt


def test_contacts_with_flat_walls_are_shown():
    disks.new_scene(period=(WIDTH, 40, 5))
    grain, other = disks.disk(1, 0.49, velocity=(0, -1)), disks.disk(4, 3)
    body = disks.disk(6, 5, frozen=True)
    disks.loop(disks.hertz(gamma_n=10))
    loop = grain_loop.use_grain_loop(periods=(WIDTH, 0))
    loop.setWall("y_low", position=0)
    c = picture.taken([grain, other], [], body).contacts
    assert (list(c["i"]), list(c["j"]), list(c["id_i"]), list(c["id_j"])) == ([0], [-4], [grain], [-4])
    assert c["fn"][0] > 0 and (c["px"][0], c["py"][0]) == (1.0, pytest.approx(0.49 - 0.495))
    frame = Frame(0.0, *picture.taken([grain, other], [], body))
    assert frame.contact_ends()[1][0] == pytest.approx([1.0, -0.005])


def test_a_single_disk_tells_how_far_it_has_turned():
    from graindrive import engines

    for fast in (False, True):
        disks.new_scene(dt=1e-3, period=(WIDTH, 40, 5))
        body = disks.disk(1, 3, frozen=True)
        disks.disk(4, 3)
        disks.loop(before_newton=[engines.SpinTranslateDrive(body=body, velocity=(1, 0, 0), spin=(0, 0, 2))])
        if fast:
            grain_loop.use_grain_loop(periods=(WIDTH, 0))
        disks.run(2000)  # 4 rad
        shown = picture.taken([1], [], body)
        assert shown.intruder["angle"] == pytest.approx(4 - 2 * np.pi, abs=2.1e-3)  # a step of 2e-3 more or less


@pytest.mark.parametrize("fast", [False, True])
def test_looking_changes_no_bit_and_leaves_a_scene_that_can_be_saved(tmp_path, fast):
    from graindrive import engines
    from graindrive.scenes import scene

    def everything(*, looking):
        grains, base, body = crowd()
        O.engines = [*O.engines[:-1], engines.OscillationDrive(body=body, amplitude=0.1, period=0.5), O.engines[-1]]
        if fast:
            loop = grain_loop.use_grain_loop(periods=(WIDTH, 0), label="loop")
        for _ in range(40):
            if looking:
                picture.taken(grains, base, body)
                scene.save(tmp_path / "checkpoint")
            disks.run(5)
        if fast:
            loop.sync()
        return disks.everything()

    looked, plain = everything(looking=True), everything(looking=False)
    # YADE's loop adds forces in an order that its threads determine: round-off of 200 steps.
    np.testing.assert_allclose(looked, plain, rtol=0, atol=0 if fast else 1e-12)
