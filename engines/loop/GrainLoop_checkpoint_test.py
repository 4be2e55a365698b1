"""One file for a scene on GrainLoop: a run from it equals an uninterrupted one to the last bit; wrong files are refused."""

import disks
import numpy as np
import pytest

from graindrive import engines
from graindrive.loops import grain_loop
from graindrive.scenes import scene
from yade import O

BEFORE, AFTER = 1500, 300  # steps; the bed has fallen onto its base when it is saved


def bed(**settings):
    """The shaken bed with all drives and measures on GrainLoop, before its first step; return the loop."""
    disks.shaken_bed()
    return grain_loop.use_grain_loop(**settings)


def plain(value):
    """An attribute's value as numbers that compare to the last bit."""
    return tuple(value) if hasattr(value, "__len__") and not isinstance(value, str) else value


def state():
    """The state of bodies, drives and measures, to the last bit."""
    kept = {e.label: {k: plain(v) for k, v in e.dict().items()} for e in O.engines if e.label not in ("", "loop")}
    return O.iter, O.time, disks.everything().tolist(), kept


@pytest.fixture
def saved(tmp_path):
    """A checkpoint, and the state some steps after it."""
    loop = bed(label="loop")
    disks.run(BEFORE)
    path = str(tmp_path / "scene.checkpoint")
    loop.checkpoint(path)
    disks.run(AFTER)
    return path, state()


def test_a_scene_built_anew_goes_on_with_bodies_drives_and_measures(saved):
    path, expected = saved
    loop = bed(label="loop", threads=2)
    loop.restore(path)
    assert O.iter == BEFORE and loop.threads == 2
    disks.run(AFTER)
    assert expected == state()
    assert expected[3]["bins"]["samples"] == BEFORE + AFTER and expected[3]["shake"]["work"] != 0


def test_a_running_scene_goes_back_to_its_checkpoint(saved):
    path, expected = saved
    disks.engine("loop").restore(path)
    disks.run(AFTER)
    assert expected == state()


@pytest.mark.parametrize("loop", ["grain", "yade"])
def test_an_empty_yade_goes_on_from_one_file(loop, tmp_path):
    disks.shaken_bed()
    if loop == "grain":
        grain_loop.use_grain_loop(label="loop")
    disks.run(BEFORE)
    path = tmp_path / "scene.checkpoint"
    scene.save(path)
    disks.run(AFTER)
    expected = state()
    O.reset()
    scene.load(path)
    assert O.iter == BEFORE and [file.name for file in tmp_path.iterdir()] == ["scene.checkpoint"]
    disks.run(AFTER)
    if loop == "grain":
        assert expected == state()
    else:  # O.load changes the order of interactions, so forces are summed in another order, and 1e-16 grows in 200 steps
        np.testing.assert_allclose(state()[2], expected[2], rtol=0, atol=1e-9)


def other_body():
    bed(label="loop")
    disks.disk(20, 20)


def other_radius():
    loop = bed(label="loop")
    O.bodies[int(loop.ids[-1])].shape.radius *= 0.9


def other_engines():
    bed(label="loop")
    O.engines = O.engines[1:]


def other_time_step():
    bed(label="loop")
    O.dt /= 2


def other_gravity():
    bed(label="loop").gravity = (0, -9, 0)


@pytest.mark.parametrize(
    "build, why",
    [
        (other_body, "was written with .* bodies, the scene has"),
        (other_radius, "body .* has another radius"),
        (other_engines, "was written with the engines \\[OscillationDrive 'shake', .* the scene has \\[Spin"),
        (other_time_step, "was written with O.dt = 0.0002"),
        (other_gravity, "GrainLoop.gravity = .* the scene has"),
    ],
)
def test_a_file_that_does_not_fit_the_scene_is_refused_and_changes_nothing(saved, build, why):
    build()
    before = state()
    with pytest.raises(RuntimeError, match=why):
        disks.engine("loop").restore(saved[0])
    assert before == state()


@pytest.mark.parametrize(
    "damage, why",
    [
        (lambda good: good[:-9], "truncated"),
        (lambda good: good[:2000] + bytes([good[2000] ^ 1]) + good[2001:], "damaged"),
        (lambda good: good[:16] + bytes([99]) + good[17:], "has version 99"),
        (lambda good: b"a poem", "not a checkpoint of GrainLoop"),
    ],
)
def test_a_file_that_cannot_be_trusted_is_refused_and_changes_nothing(saved, tmp_path, damage, why):
    broken = tmp_path / "broken"
    with open(saved[0], "rb") as file:
        broken.write_bytes(damage(file.read()))
    before = state()
    for read in (disks.engine("loop").restore, scene.load):
        with pytest.raises(RuntimeError, match=why):
            read(str(broken))
    assert before == state()


def test_a_file_of_yades_loop_is_not_one_of_grain_loop(saved, tmp_path):
    path = str(tmp_path / "yade.checkpoint")
    engines.seal_scene(path, b"what O.save wrote")
    assert engines.saved_scene(path) == b"what O.save wrote"
    with pytest.raises(RuntimeError, match="not a checkpoint of GrainLoop"):
        disks.engine("loop").restore(path)


def test_a_loop_alone_holds_no_scene_to_load(saved):
    with pytest.raises(RuntimeError, match="holds no YADE scene"):
        scene.load(saved[0])
