"""A scene without a feature gives the same as with the feature set to zero, bit for bit or to the tolerance in `FEATURES`."""

import json

import numpy as np
import pytest
from yade import O

from graindrive.benchmark import __main__ as benchmark
from graindrive.benchmark import features, ours
from graindrive.benchmark.features import BITS, FEATURES, crowd

STEPS = 3000  # of 1e-4; contacts last 70 steps, and every disk collides with several others
SET_TO_NOTHING = [feature for feature in FEATURES if feature.nothing]


@pytest.fixture(autouse=True)
def empty_scene():
    O.reset()
    yield
    O.reset()


def outcome(a_scene, **settings):
    """Return positions and velocities (x and y) of a scene after STEPS, and the number of contacts."""
    ours.bodies(a_scene)
    loop = ours.with_features(a_scene, settings)
    O.run(STEPS, True)
    assert O.iter == STEPS
    return np.hstack([loop.positions[:, :2], loop.velocities[:, :2]]), len(loop.contacts()["i"])


@pytest.fixture(scope="module")
def plain():
    """The results of the scene without changes."""
    return outcome(crowd())[0]


def test_the_crowd_collides(plain):
    """The comparison needs collisions: all disks except the held one have changed their velocities."""
    first = crowd()
    turned = np.hypot(plain[:, 2] - first["vx"], plain[:, 3] - first["vy"]) > 0.01
    assert turned.sum() == len(turned) - 1


@pytest.mark.parametrize("feature", SET_TO_NOTHING, ids=[feature.name for feature in SET_TO_NOTHING])
def test_a_feature_set_to_nothing_changes_nothing(feature, plain):
    change, settings = feature.nothing
    found, _ = outcome(change(crowd()), **settings)
    if feature.differs == BITS:
        np.testing.assert_array_equal(found, plain)
    else:
        np.testing.assert_allclose(found, plain, rtol=0, atol=feature.differs)


@pytest.mark.parametrize(
    "change, settings",
    [
        (features.changed(friction=0.5), {}),
        (features.changed(gravity=1.0), dict(bounds=(-50, -50, 50, 50))),  # otherwise flying grains count as lost
        (dict, dict(walls="near")),
        (lambda scene: dict(scene, period=features.extent(scene) - 0.9), {}),
        (dict, dict(damping=0.1)),
    ],
    ids=["friction", "gravity", "walls", "periods", "damping"],
)
def test_the_same_feature_in_earnest_does(change, settings, plain):
    found, _ = outcome(change(crowd()), **settings)
    assert np.abs(found - plain).max() > 1e-3


def test_the_base_scene_has_six_contacts_a_disk_and_keeps_them_under_gravity_and_friction():
    lattice = features.lattice(columns=10, rows=10)
    for a_scene in (lattice, dict(lattice, friction=0.5), dict(lattice, gravity=1.0)):
        assert outcome(a_scene)[1] == 3 * len(lattice["x"])


def test_a_ratio_is_the_median_of_rounds_by_turns():
    """Two made-up programs: the result is the median of the rounds' ratios, not the ratio of the medians."""
    pairs = [(dict(cpu=a, processor="p", contacts=3), dict(cpu=b, contacts=3)) for a, b in ((2, 1), (9, 3), (8, 2))]
    found = features.row(FEATURES[0], 1e9, pairs)
    assert (found["ratio"], found["lowest"], found["highest"]) == (3, 2, 4)
    assert (found["with_it_ns"], found["without_it_ns"]) == (8, 2)


def test_the_command_prints_features_as_json_and_refuses_another_scene(monkeypatch, capsys):
    made = [dict(feature="gravity", ratio=1.0)]
    monkeypatch.setattr(features, "measure", lambda start, save, rounds, steps: iter(made))
    assert benchmark.main(["--features", "--json", "--quick"]) == 0
    assert json.loads(capsys.readouterr().out) == made
    with pytest.raises(SystemExit) as ending:
        benchmark.main(["--features", "--scene", "bed10k"])
    assert ending.value.code == 2 and "leave --scene bed10k out" in capsys.readouterr().err
