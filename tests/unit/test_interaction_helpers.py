"""YADE's functions that read interactions: with GrainLoop they return the same as on YADE's loop, or raise an error."""

import math
import os
import subprocess
import sys

import disks
import numpy as np
import pytest
import spheres
from graindrive import engines
from graindrive.loops import grain_loop, interaction_helpers
from yade import O, _utils, utils, wrapper
from yade.minieigenHP import Vector3

REFUSED = [name for names in interaction_helpers.REFUSED.values() for name in names]


@pytest.fixture(autouse=True)
def forget():
    yield
    O.reset()


def pair(**settings):
    disks.new_scene(dt=1e-3)
    disks.disk(0, 0), disks.disk(0.95, 0)
    disks.loop(**settings)


def falling_bed(gravity):
    """Disks and a clump that fall on frozen ones. Those are apart, because YADE counts contacts of frozen disks too."""
    disks.new_scene(dt=2e-4)
    rng = np.random.default_rng(5)
    for x in np.arange(-1, 9, 1.02):
        disks.disk(float(x), 0.0, frozen=True)
    disks.clump([(-0.3, 0), (0.3, 0)], at=(3.6, 3.2))
    for row in range(6):
        for column in range(7):
            x, y = 1.1 * column + 0.5 * (row % 2) + rng.uniform(-0.03, 0.03), 1.0 + rng.uniform(0, 0.03) + row
            if math.hypot(x - 3.6, y - 3.2) > 1.2:
                disks.disk(x, y, rng.uniform(0.45, 0.5), velocity=(0, -1))
    disks.loop(disks.hertz(gamma_n=250, gamma_t=250), friction=0.4, gravity=gravity)


def told_of(build, loop, pushes=()):
    """Return (mean, maximum, coordination number), read every 500 steps by a PyRunner between contacts and integrator."""
    build()
    O.tags["told"] = ""
    command = (
        "import yade; O.tags['told'] += ' '.join(repr(x) for x in (yade.utils.unbalancedForce(),"
        " yade._utils.unbalancedForce(True), yade.utils.avgNumInteractions())) + ' '"
    )
    runner = wrapper.PyRunner(command=command, iterPeriod=499, firstIterRun=998)
    O.engines = [*O.engines[:-1], *pushes, runner, O.engines[-1]]
    if loop == "grain":
        grain_loop.use_grain_loop()
    disks.run(2200)
    return np.array([float(word) for word in O.tags["told"].split()]).reshape(-1, 3)


@pytest.mark.parametrize("gravity", [(0, 0), (0, -10)])
def test_unbalanced_force_and_coordination_number_are_yades(gravity):
    yade, grain = (told_of(lambda: falling_bed(gravity), loop) for loop in ("yade", "grain"))
    assert yade.shape == (3, 3) and np.all(yade > 0)
    np.testing.assert_allclose(grain, yade, rtol=1e-6)


def test_of_spheres_they_are_yades_too():
    """Spheres and a clump fall on frozen ones, which do not touch; one is pushed out of all planes."""

    def build():
        disks.new_scene(dt=2e-4)
        rng = np.random.default_rng(5)
        for k in range(5):
            for x, y in np.ndindex(4, 4):
                place = 1.02 * np.array([x, y, k]) + (rng.uniform(-0.01, 0.01, 3) if k else 0)
                spheres.sphere(place, rng.uniform(0.46, 0.5), velocity=(0, 0, -1), blocked="" if k else "xyzXYZ")
                O.bodies[-1].state.vel *= k > 0
        spheres.free_clump([(1, 1, 5.2), (1.4, 1, 5.2), (1.4, 1.4, 5.3)])
        spheres.loop(disks.hertz(gamma_n=250, gamma_t=250), friction=0.4, gravity=(1, 0, -10))
        O.forces.setPermF(20, Vector3(3, -2, 4))

    yade, grain = (told_of(build, loop) for loop in ("yade", "grain"))
    assert yade.shape == (3, 3) and np.all(yade > 0)
    np.testing.assert_allclose(
        grain, yade, rtol=1e-3
    )  # the loops turn the clump by different integrators, with an error of order dt


def test_forces_from_outside_count():
    def pushed():
        falling_bed((0, -10))
        O.forces.setPermF(14, Vector3(3, 0, 0))

    pushes = [wrapper.ForceEngine(ids=[16, 20], force=(0, -5, 0))]
    yade, grain = (told_of(pushed, loop, pushes) for loop in ("yade", "grain"))
    without = told_of(lambda: falling_bed((0, -10)), "yade")
    np.testing.assert_allclose(grain, yade, rtol=1e-6)
    assert not np.allclose(yade[:, 1], without[:, 1], rtol=1e-2)


def test_loads_of_grain_loop_count():
    """Two equal disks press on each other with F; a load f on one: mean of |F|, |f - F|, over F."""
    pair()
    loop = grain_loop.use_grain_loop(watched=[1])
    disks.run(1)
    force = np.linalg.norm(loop.presentContacts()["normal_force"][0])
    loop.setLoad(1, (-force / 4, 0, 0))
    assert utils.unbalancedForce() == pytest.approx((1 + 3 / 4) / 2, rel=1e-12)
    assert utils.unbalancedForce(useMaxForce=True) == pytest.approx(1, rel=1e-12)


def test_loads_on_spheres_count_along_all_axes():
    """Two equal spheres press on each other with F; a load across it on one: mean of |F|, |f - F|, over F."""
    disks.new_scene(dt=1e-3)
    spheres.sphere((0, 0, 0)), spheres.sphere((0, 0, 0.95))
    spheres.loop()
    loop = grain_loop.use_grain_loop(watched=[1])
    disks.run(1)
    force = np.linalg.norm(loop.presentContacts()["normal_force"][0])
    loop.setLoad(1, (0, 0, -force / 4))
    assert utils.unbalancedForce() == pytest.approx((1 + 3 / 4) / 2, rel=1e-12)
    loop.setLoad(1, (0, force, 0))
    assert utils.unbalancedForce(useMaxForce=True) == pytest.approx(math.sqrt(2), rel=1e-12)


def test_a_force_that_is_gone_between_steps_is_not_taken_for_none():
    pair(before_newton=[wrapper.ForceEngine(ids=[0], force=(1, 0, 0))])
    grain_loop.use_grain_loop()
    disks.run(1)
    with pytest.raises(RuntimeError, match="needs the forces of ForceEngine, which are gone .* in a PyRunner between"):
        utils.unbalancedForce()


def test_without_contacts_it_is_nan_as_yades():
    disks.new_scene()
    disks.disk(0, 0)
    disks.loop()
    assert math.isnan(utils.unbalancedForce())
    grain_loop.use_grain_loop()
    assert math.isnan(utils.unbalancedForce()) and utils.avgNumInteractions() == 0


@pytest.mark.parametrize("name", REFUSED)
def test_what_reads_interactions_is_refused_by_name_under_grain_loop_alone(name):
    module = _utils if hasattr(_utils, name) else utils
    pair()
    disks.run(1)
    grain_loop.use_grain_loop()
    with pytest.raises(RuntimeError, match=f"{name} needs YADE's interactions .*(loop.|finds all).*use_yade_loop"):
        getattr(module, name)()
    assert getattr(utils, name) is getattr(module, name)


def test_exporters_of_interactions_are_refused(tmp_path):
    from yade import export, post2d

    pair()
    disks.run(1)
    exporter = export.VTKExporter(str(tmp_path / "out"))
    exporter.exportInteractions()
    grain_loop.use_grain_loop()
    before = [p.name for p in tmp_path.iterdir()]
    for name in interaction_helpers.EXPORTS:
        with pytest.raises(RuntimeError, match=f"{name} needs YADE's interactions"):
            getattr(exporter, name)()
    with pytest.raises(RuntimeError, match="post2d.data with intr=True needs"):
        post2d.data(lambda i: 1.0, post2d.AxisFlatten(axis=2), intr=True)
    assert len(before) == 1 and [p.name for p in tmp_path.iterdir()] == before
    speeds = post2d.data(lambda b: b.state.vel.norm(), post2d.AxisFlatten(axis=2))
    assert len(speeds["x"]) == 2


def test_on_yades_loop_yades_own_functions_answer():
    pair()
    loop = grain_loop.use_grain_loop()
    disks.run(1)
    expected = loop.presentContacts()["overlap"].max() / 0.5
    grain_loop.use_yade_loop()
    assert utils.maxOverlapRatio() == pytest.approx(expected, rel=1e-9)
    assert utils.getBodyIdsContacts(0) == [1] and utils.avgNumInteractions() == 1


def test_a_dead_grain_loop_moves_nothing():
    pair()
    disks.run(1)
    O.engines = O.engines + [engines.GrainLoop(dead=True)]
    assert utils.avgNumInteractions() == 1


@pytest.mark.parametrize("option", [dict(cutoff=0.1), dict(skipFree=True), dict(considerClumps=True)])
def test_coordination_numbers_of_another_kind_are_refused(option):
    pair()
    grain_loop.use_grain_loop()
    with pytest.raises(RuntimeError, match="avgNumInteractions with cutoff, skipFree or considerClumps needs"):
        utils.avgNumInteractions(**option)


def test_a_module_that_holds_yades_function_gets_the_new_one_and_others_keep_theirs(monkeypatch):
    import types

    original = _utils.getStress.__wrapped__
    holder, other = types.ModuleType("holder"), types.ModuleType("other")
    holder.getStress, other.getStress = original, len
    monkeypatch.setitem(sys.modules, "holder", holder)
    monkeypatch.setitem(sys.modules, "other", other)
    monkeypatch.setattr(_utils, "getStress", original)
    interaction_helpers.install()
    assert holder.getStress is _utils.getStress is not original and other.getStress is len
    monkeypatch.setattr(utils, "getStress", _utils.getStress)


def test_names_that_a_script_has_from_yade_are_the_new_ones():
    """As in the yade program: its names are defined first, then the user's script imports graindrive."""
    script = (
        "import yade; from yade.utils import *; old = getStress; import graindrive.engines;"
        " assert getStress is yade.utils.getStress is not old and getStress.__wrapped__ is old"
    )
    subprocess.run([sys.executable, "-c", script], env={**os.environ, "PYTHONPATH": ":".join(sys.path)}, check=True)


def test_installing_twice_wraps_once():
    first = _utils.getStress
    interaction_helpers.install()
    assert _utils.getStress is first and not hasattr(first.__wrapped__, "__wrapped__")
