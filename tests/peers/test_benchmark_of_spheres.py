"""The benchmark's beds of spheres: as described, with the same results in LAMMPS and LIGGGHTS, and an error if these differ."""

import functools

import numpy as np
import pytest
from graindrive import engines  # noqa: F401  first: it finds YADE
from graindrive.benchmark import __main__ as benchmark
from graindrive.benchmark import lammps, layout, lift, liggghts, ours, scenes
from yade import O

D = lift.D
needs_lammps = pytest.mark.skipif(
    lammps.available() is None, reason="LAMMPS is not installed (Debian's package lammps)"
)
PEERS = [
    pytest.param(functools.partial(lammps.run, ranks=1), "LAMMPS", marks=needs_lammps),
    pytest.param(
        liggghts.run,
        "LIGGGHTS",
        marks=pytest.mark.skipif(liggghts.available() is None, reason="LIGGGHTS is not installed (package liggghts)"),
    ),
]


@pytest.fixture(scope="module")
def bed():
    return lift.settled(lift.poured(8, 8, 500))


@pytest.fixture(scope="module")
def flow(bed):
    return ours.move_on(lift.tilted(bed), lambda loop, steps: steps >= 3000)


def contacts(a_scene):
    ours.bodies(a_scene)
    return ours.grain_loop(a_scene).presentContacts()


def energy_on_grain_loop(a_scene, steps):
    """The kinetic energy after some steps of a scene whose velocities are given at full steps."""
    ours.bodies(a_scene)
    loop = ours.grain_loop(a_scene)
    loop.beginOnStep()
    O.run(steps - 1, True)
    return loop.kineticEnergyOnStep()


def write(a_scene, folder):
    """The data file for each peer, in a separate folder."""
    places = {}
    for name, peer in (("LAMMPS", lammps), ("LIGGGHTS", liggghts)):
        places[name] = folder / name
        places[name].mkdir()
        peer.write(a_scene, places[name])
    return places


def test_a_poured_lattice_touches_nothing():
    assert len(contacts(lift.poured(8, 8, 500))["i"]) == 0


def test_a_settled_bed_lies_still_on_its_base(bed):
    free = bed["kind"] == layout.FREE
    assert (free.sum(), (~free).sum()) == (500, 64)
    assert layout.kinetic_energy(bed) == 0
    assert (bed["z"][~free] == 0).all() and bed["z"][free].min() > 0.4 * D  # no sphere has passed through another
    assert bed["r"][free].min() >= 0.475 * D and bed["r"][free].max() <= 0.525 * D
    assert tuple(bed["constants"]) == (5e6, 0.45, 0.6) and bed["dt"] == 1e-5
    # The volume from the base's centres to the highest centre counts as full: a loose packing of 0.55 seems up to 10 % denser.
    assert 0.5 < (4 / 3 * np.pi * bed["r"][free] ** 3).sum() / (64 * D**2 * bed["z"].max()) < 0.68


def test_a_settled_bed_is_carried_by_its_base(bed):
    """The springs of the bed's preparation are not stored, so it settles again; then friction bears a part of the weight too."""
    ours.bodies(bed)
    loop = ours.grain_loop(bed)
    free = bed["kind"] == layout.FREE
    weight = layout.masses(bed)[0][free].sum() * lift.GRAVITY
    O.run(3000, True)
    borne = []
    for _ in range(40):
        O.run(50, True)
        table = loop.presentContacts()
        of_base = ~free[table["j"]] ^ ~free[table["i"]]
        sign = np.where(free[table["j"]], 1, -1)[of_base]
        borne.append((sign * (table["normal_force"] + table["tangential_force"])[of_base, 2]).sum())
    assert np.mean(borne) == pytest.approx(weight, rel=0.01)  # the bed still oscillates by some percent


def test_beds_side_by_side_fit_at_their_seams(bed):
    three = layout.beside_each_other(bed, 3)
    assert layout.periods(three) == pytest.approx((24 * D, 8 * D, 0))
    one, many = contacts(bed), contacts(three)
    assert len(many["i"]) == 3 * len(one["i"]) > 1500
    # Positions that were shifted by a period have the round-off of 24 d, in an overlap of 1e-3 d.
    assert np.sort(many["overlap"]) == pytest.approx(np.sort(np.tile(one["overlap"], 3)), abs=1e-13 * D)


def test_a_tilted_bed_starts_with_bagnolds_profile(bed):
    flow = lift.tilted(bed, slope=0.4)
    x, y, z = layout.gravity(flow)
    assert np.hypot(x, z) == pytest.approx(9.81) and y == 0 and np.arctan2(x, -z) == pytest.approx(0.4)
    free = bed["kind"] == layout.FREE
    assert (flow["vx"][~free] == 0).all()
    top = np.argmax(bed["z"])
    depth = bed["z"][top]
    assert flow["vx"][top] == pytest.approx(2 / 3 * 0.1 * np.sqrt(0.6 * 9.81 * np.cos(0.4) * depth**3) / D)
    # The shear rate just below a depth of y is I sqrt(phi g cos(slope) y) / d.
    order = np.argsort(bed["z"][free])
    z, v = bed["z"][free][order], flow["vx"][free][order]
    k = len(z) // 2
    rate = (v[k + 20] - v[k - 20]) / (z[k + 20] - z[k - 20])
    middle = depth - (z[k + 20] + z[k - 20]) / 2
    # A difference quotient over a twelfth of the depth has an error of about (1/12)^2/24.
    assert rate == pytest.approx(0.1 * np.sqrt(0.6 * 9.81 * np.cos(0.4) * middle) / D, rel=0.01)


def test_a_flow_shears_above_a_base_at_rest(flow):
    free = flow["kind"] == layout.FREE
    assert (flow["vx"][~free] == 0).all()
    high = flow["z"] > np.median(flow["z"][free])
    assert flow["vx"][free & high].mean() > 1.5 * flow["vx"][free & ~high].mean() > 0


def test_the_numbers_of_spheres():
    for made, size in ((lift.poured(46, 10, 19_540), 20_000), (lift.poured(20, 10, 26_943), 27_143)):
        assert len(made["r"]) == size
    assert 7 * 27_143 == pytest.approx(190_000, rel=1e-4)


def test_every_scene_has_its_comparisons():
    assert list(benchmark.PLAN) == list(scenes.SCENES)


@needs_lammps
@pytest.mark.parametrize("restitution", [0.2, 0.6, 0.9])
def test_lammps_damps_to_the_same_restitution(tmp_path, restitution):
    """Two spheres in a head-on impact: our restitution, which other tests check, against the inverse of Tsuji's polynomial."""
    pair = lift.poured(8, 8, 2)
    for key, value in dict(x=[6e-3, 7.51e-3], y=[6e-3, 6e-3], z=[9e-3, 9e-3], vx=[0.1, -0.1]).items():
        pair[key][:2] = value
    pair.update(gravity=np.zeros(3), constants=(5e6, 0.45, restitution))
    pair["r"][:2] = D / 2
    lammps.write(pair, tmp_path)
    for steps in (60, 600):  # during and after the impact
        theirs = lammps.run(pair, steps, tmp_path, 1)["energy"]
        # Bisection and round-off of 600 steps; LAMMPS writes 15 digits.
        assert energy_on_grain_loop(pair, steps) == pytest.approx(theirs, rel=1e-10)
    assert theirs < 0.99 * layout.kinetic_energy(pair)


@pytest.mark.parametrize("run, name", PEERS)
@pytest.mark.parametrize("moving", [False, True])
def test_peers_compute_the_same_scene(tmp_path, bed, flow, run, name, moving):
    a_scene = flow if moving else bed
    folder = write(a_scene, tmp_path)[name]
    # The reasons for the tolerances are given where they are defined.
    when_smooth = benchmark.tolerance_when_smooth(name, a_scene)
    for friction, tolerance in ((0.0, when_smooth), (0.5, benchmark.tolerance(a_scene))):
        same = dict(a_scene, friction=friction)
        assert energy_on_grain_loop(same, 300) == pytest.approx(run(same, 300, folder)["energy"], rel=tolerance)


@needs_lammps
@pytest.mark.parametrize(
    "friction, change, word",
    [
        (0.5, dict(friction=0.0), "ratio against LAMMPS: kinetic energies"),
        (0.0, dict(constants=(5e6, 0.45, 0.61)), "ratio against LAMMPS: without friction kinetic energies"),
        (0.0, dict(dt=1.001e-5), "ratio against LAMMPS: without friction kinetic energies"),
        (0.0, dict(gravity=np.array([0, 0, -9.8])), "ratio against LAMMPS: without friction kinetic energies"),
    ],
)
def test_no_ratio_against_a_peer_that_computes_something_else(tmp_path, capsys, bed, friction, change, word):
    """The comparison detects a peer without friction, and peers with small errors that friction would hide."""
    folder = write(bed, tmp_path)["LAMMPS"]
    path = benchmark.save(bed, tmp_path, "scene.npz")

    def run(a_scene, steps):
        return lammps.run(dict(a_scene, **change) if a_scene["friction"] == friction else a_scene, steps, folder, 1)

    assert benchmark.against("LAMMPS", run, "bed", bed, path, 1, 1, 10) is None
    assert word in capsys.readouterr().err


@needs_lammps
def test_a_ratio_against_a_peer_that_computes_the_same(tmp_path, bed):
    folder = write(bed, tmp_path)["LAMMPS"]
    path = benchmark.save(bed, tmp_path, "scene.npz")
    run = functools.partial(lammps.run, folder=folder, ranks=1)
    row = benchmark.against("LAMMPS", run, "bed", bed, path, 1, 1, 100)
    assert row["law"] == "hertzRestitution" and row["peer"] == "LAMMPS"
    assert row["ratio"] == row["ours"] / row["theirs"] > 0
