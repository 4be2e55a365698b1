"""Settings of GrainLoop that change between or within runs act at once, as if the scene had been built with them."""

import disks
import numpy as np
import pytest
from graindrive.loops import grain_loop
from yade import O
from yade.minieigenHP import Vector3
from yade.wrapper import FrictMat

STEPS = 400


def crowd(**settings):
    """Disks that slide over frozen ones."""
    disks.new_scene(dt=1e-3)
    for x in np.arange(0, 12.0):
        disks.disk(x, 0, frozen=True)
    for k in range(8):
        disks.disk(1.05 * k + 1, 0.97, velocity=(1, 0))
    disks.loop(disks.hertz(gamma_n=50, gamma_t=50), gravity=(0, -10), friction=settings.pop("friction", 0))
    return grain_loop.use_grain_loop(label="loop", **settings)


def changed(name, value, **settings):
    """The state after a run in which the setting is changed before the second half."""
    loop = crowd(**settings)
    disks.run(STEPS)
    setattr(loop, name, value)
    disks.run(STEPS)
    return disks.everything()


def read_anew(name, value, **settings):
    """The same with the whole scene read again, springs kept."""
    loop = crowd(**settings)
    disks.run(STEPS)
    setattr(loop, name, value)
    loop.read()
    disks.run(STEPS)
    return disks.everything()


@pytest.mark.parametrize(
    "name, value",
    [
        ("friction", 0.3),
        ("gravity", Vector3(1, -10, 0)),
        ("normalStiffness", 4e5),
        ("normalDamping", 10.0),
        ("precision", "single"),
        ("threads", 2),
        ("skin", 0.05),
    ],
)
@pytest.mark.parametrize("friction", [0, 0.2])
def test_a_setting_is_heard_at_once(name, value, friction):
    found, expected = changed(name, value, friction=friction), read_anew(name, value, friction=friction)
    # After the second reading the order of sums differs: round-off, times its growth in 400 steps of sliding contacts.
    tolerance = 1e-4 if name == "precision" else 1e-10
    np.testing.assert_allclose(found[:, 0:6], expected[:, 0:6], rtol=0, atol=tolerance)
    if name not in ("precision", "threads", "skin"):
        assert np.abs(found - changed("syncEvery", 0, friction=friction)).max() > 1e-6  # the setting has an effect


def test_settings_survive_a_checkpoint_as_they_were_changed(tmp_path):
    loop = crowd(friction=0.2)
    disks.run(STEPS)
    loop.friction, loop.gravity = 0.4, Vector3(0.5, -9, 0)
    disks.run(STEPS)
    path = str(tmp_path / "loop.checkpoint")
    loop.checkpoint(path)
    disks.run(STEPS)
    expected = disks.everything()
    loop.restore(path)
    disks.run(STEPS)
    assert np.array_equal(disks.everything(), expected)


def test_another_physics_is_refused_while_energy_is_tracked():
    loop = crowd(friction=0.2, trackEnergy=True)
    disks.run(10)
    loop.friction = 0.3
    with pytest.raises(ValueError, match="law, friction, gravity and damping must stay while energy is tracked"):
        O.engines[-1]()


def test_a_time_step_too_long_for_the_new_stiffness_is_refused():
    loop = crowd()
    disks.run(10)
    loop.normalStiffness = 1e12
    with pytest.raises(ValueError, match="time step must not exceed the critical one"):
        O.engines[-1]()


@pytest.mark.parametrize("name", ["springs", "wallSprings", "wallSettings"])
def test_what_the_loop_keeps_cannot_be_set_while_it_runs(name):
    loop = crowd(friction=0.2)
    disks.run(10)
    before = getattr(loop, name)
    with pytest.raises(ValueError, match=f"GrainLoop.{name} is kept by the running loop"):
        setattr(loop, name, [])
    assert getattr(loop, name) == before


def test_a_disk_watched_later_is_written_at_every_step():
    loop = crowd()
    disks.run(10)
    free = O.bodies[len(O.bodies) - 1].id
    loop.watched = [free]
    disks.run(10)
    assert list(loop.watched) == [free]
    row = list(loop.ids).index(free)
    assert tuple(loop.positions[row]) == tuple(O.bodies[free].state.pos)[:2]


@pytest.mark.parametrize("change", ["frictionAngle = 0.1", "young *= 3", "poisson = 0.1"])
def test_a_material_that_changes_is_refused_until_the_loop_is_told(change):
    loop = crowd(friction=0.2)
    disks.run(10)
    exec(f"O.materials[0].{change}")
    with pytest.raises(RuntimeError, match="the constants of material 0 .* were changed"):
        O.engines[-1]()
    loop.read()
    disks.run(10)


def test_a_body_with_another_material_is_refused_until_the_loop_is_told():
    loop = crowd(friction=0.2)
    disks.run(10)
    other = O.materials.append(FrictMat(density=1, young=1e6, poisson=0.3, frictionAngle=0.1))
    O.bodies[len(O.bodies) - 1].material = O.materials[other]
    with pytest.raises(RuntimeError, match="was given another material"):
        O.engines[-1]()
    loop.read()
    disks.run(10)
