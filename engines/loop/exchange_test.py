"""The exchange of engines: their order in both directions, the scene of an exchange, and labels of removed engines."""

import builtins

import disks
import numpy as np
import pytest
from graindrive import engines
from graindrive.loops import grain_loop, take_over
from graindrive.base.errors import UsageError
from yade import O, wrapper
from yade.minieigenHP import Vector3


def scene(dt=1e-3):
    """Two free disks far from each other, which fall."""
    disks.new_scene(dt=dt)
    disks.disk(0, 0), disks.disk(10, 0)
    disks.loop(disks.hertz(), gravity=(0, -1))


def runner(label, command="pass"):
    return wrapper.PyRunner(command=command, iterPeriod=1, initRun=True, label=label)


def put(engine, place):
    """Position 0 to 4: before ForceResetter, collider, contacts, integrator, or behind all."""
    O.engines = O.engines[:place] + [engine] + O.engines[place:]


def order():
    return [getattr(e, "label", "") or type(e).__name__ for e in O.engines]


def one_runner_everywhere():
    scene()
    O.engines = [e for pair in zip([runner(f"r{k}") for k in range(4)], O.engines) for e in pair] + [runner("r4")]


# ---- order -----------------------------------------------------------------------------------------------------------


def test_engines_behind_the_integrator_stand_behind_grain_loop():
    one_runner_everywhere()
    grain_loop.use_grain_loop()
    assert order() == ["r0", "r1", "r2", "r3", "GrainLoop", "r4"]


@pytest.mark.parametrize("loaded", [False, True])
def test_the_order_of_before_comes_back(loaded):
    one_runner_everywhere()
    before = order()
    grain_loop.use_grain_loop()
    if loaded:
        O.saveTmp("order")
        O.loadTmp("order")
    grain_loop.use_yade_loop()
    assert order() == before


def test_engines_that_were_moved_or_added_stay_on_their_side():
    one_runner_everywhere()
    loop = grain_loop.use_grain_loop()
    O.engines = [O.engines[0], O.engines[5], runner("new"), loop, O.engines[1]]
    grain_loop.use_yade_loop()
    four = ["ForceResetter", "collider", "contacts"]
    assert order() == four + ["r0", "r4", "new", "newton", "r1"]


@pytest.mark.parametrize("place", [3, 4], ids=["before", "behind"])
def test_a_runner_records_the_state_on_its_side_of_the_step(place):
    """Free fall from rest: v = -g dt times the steps made; a runner behind the integrator reads it one step earlier."""
    seen = []
    for loop in ("yade", "grain"):
        scene()
        O.tags["speeds"] = ""
        put(runner("record", "O.tags['speeds'] += repr(O.bodies[0].state.vel[1]) + ' '"), place)
        if loop == "grain":
            grain_loop.use_grain_loop()
        disks.run(20)
        seen.append([float(word) for word in O.tags["speeds"].split()])
    np.testing.assert_allclose(seen[1], seen[0], rtol=1e-12)
    np.testing.assert_allclose(seen[0], -1e-3 * (np.arange(20) + place - 3), rtol=1e-12)


PUSHES = {
    "AxialGravityEngine": dict(axisPoint=(5, 5, 0), axisDirection=(0, 0, 1), acceleration=1),
    "CentralConstantAccelerationEngine": dict(centralBody=1, accel=1),
    "DragEngine": dict(ids=[0], Rho=1),
    "ForceEngine": dict(ids=[0], force=(1, 0, 0)),
    "GravityEngine": dict(gravity=(1, 0, 0)),
    "HarmonicForceEngine": dict(ids=[0], A=(1, 0, 0), f=(1, 0, 0), fi=(0, 0, 0)),
    "InterpolatingDirectedForceEngine": dict(ids=[0], times=[0, 1], magnitudes=[1, 1], direction=(1, 0, 0)),
    "LinearDragEngine": dict(ids=[0], nu=1),
    "RadialForceEngine": dict(ids=[0], axisPt=(5, 5, 0), axisDir=(0, 0, 1), fNorm=1),
    "TorqueEngine": dict(ids=[0], moment=(0, 0, 1)),
}


@pytest.mark.parametrize("kind", PUSHES)
@pytest.mark.parametrize("place", [0, 4], ids=["before", "behind"])
def test_forces_that_yade_erases_are_refused(kind, place):
    """At these places forces act in no step or only in the first on YADE's loop; before the integrator (3) they act in all."""

    def change(at):
        disks.new_scene(dt=1e-3)
        disks.disk(0, 0, velocity=(0.5, 0)), disks.disk(10, 0)
        disks.loop()
        if at is not None:
            put(getattr(wrapper, kind)(**PUSHES[kind]), at)
        for _ in range(100):
            O.step()
        state = O.bodies[0].state
        return (state.vel - Vector3(0.5, 0, 0)).norm() + abs(state.angVel[2])

    assert change(None) == 0
    assert change(place) <= 0.02 * change(3) and change(3) > 0
    scene()
    put(getattr(wrapper, kind)(**PUSHES[kind]), place)
    with pytest.raises(UsageError, match=f"{kind} stands (before ForceResetter|behind NewtonIntegrator)"):
        grain_loop.use_grain_loop()


def test_all_engines_known_to_add_forces_are_tried():
    assert {*PUSHES, "HdapsGravityEngine"} == set(take_over.ADD_FORCES)  # that one reads a laptop's sensor


@pytest.mark.parametrize("place", [0, 2, 4])
@pytest.mark.parametrize("kind", take_over.DRIVES_AND_MEASURES)
def test_drives_and_measures_stand_between_contacts_and_integrator(kind, place):
    scene()
    put(getattr(engines, kind)(), place)
    with pytest.raises(
        UsageError, match=f"{kind} stands (before InteractionLoop|behind NewtonIntegrator); put it between"
    ):
        grain_loop.use_grain_loop()


# ---- whose exchange --------------------------------------------------------------------------------------------------


def test_a_second_take_over_says_that_there_was_one():
    scene()
    grain_loop.use_grain_loop()
    with pytest.raises(UsageError, match="O.engines holds a GrainLoop already"):
        grain_loop.use_grain_loop()


def test_a_grain_loop_of_another_kind_in_the_same_scene_is_not_taken_for_ours():
    scene()
    ours = grain_loop.use_grain_loop()
    O.engines = [engines.GrainLoop()]
    with pytest.raises(UsageError, match="was not made for this scene by use_grain_loop"):
        grain_loop.use_yade_loop()
    O.engines = [ours]
    grain_loop.use_yade_loop()
    assert order() == ["ForceResetter", "collider", "contacts", "newton"]


def other_scene_by_reset():
    O.reset()


def other_scene_by_switching():
    O.switchToScene(O.addScene())


@pytest.mark.parametrize("other", [other_scene_by_reset, other_scene_by_switching])
def test_engines_of_another_scene_are_not_put_into_this_one(other):
    scene()
    grain_loop.use_grain_loop()
    try:
        other()
        O.engines = [engines.GrainLoop()]
        with pytest.raises(UsageError, match="was not made for this scene by use_grain_loop"):
            grain_loop.use_yade_loop()
    finally:
        O.resetAllScenes()


def test_two_scenes_go_back_to_their_own_engines():
    try:
        scene()
        first, own = O.engines[-1], []
        grain_loop.use_grain_loop()
        O.switchToScene(O.addScene())
        O.dt = 1e-3
        disks.disk(0, 0)
        disks.loop(disks.hertz(), gravity=(0, -2))
        second = O.engines[-1]
        grain_loop.use_grain_loop()
        for number in (0, 1):
            O.switchToScene(number)
            grain_loop.use_yade_loop()
            own.append(O.engines[-1])
        assert own == [first, second] and [n.gravity[1] for n in own] == [-1, -2]
    finally:
        O.resetAllScenes()


def test_a_loaded_scene_goes_back_in_the_same_session():
    scene()
    grain_loop.use_grain_loop(label="loop")
    disks.run(10)
    O.saveTmp("loaded")
    O.reset()
    O.loadTmp("loaded")
    grain_loop.use_yade_loop()
    disks.run(10)
    assert O.bodies[0].state.vel[1] == pytest.approx(-20e-3, rel=1e-12)


def test_exchanges_of_scenes_that_are_gone_do_not_pile_up():
    for _ in range(grain_loop.KEPT + 3):
        scene()
        grain_loop.use_grain_loop()
    assert len(grain_loop.exchanged) <= grain_loop.KEPT


# ---- labels ----------------------------------------------------------------------------------------------------------


def assign_gravity():
    newton.gravity = (5, 0, 0)  # noqa: F821, a label


def assign_skin():
    collider.verletDist = 1  # noqa: F821


def assign_a_new_name():
    newton.nonsense = 1  # noqa: F821


LABELLED = {
    "newton is NewtonIntegrator, which GrainLoop replaced: assign loop.gravity": assign_gravity,
    "newton is NewtonIntegrator, which GrainLoop replaced: read loop.damping": lambda: newton.damping,  # noqa: F821
    "newton is NewtonIntegrator, .*: use_yade_loop": assign_a_new_name,
    "newton .*use_yade_loop": lambda: newton.dead,  # noqa: F821
    "collider is InsertionSortCollider, .*: assign loop.skin": assign_skin,
    "collider .*use_yade_loop": lambda: collider(),  # noqa: F821
    "contacts is InteractionLoop, .*use_yade_loop": lambda: contacts.callbacks,  # noqa: F821
    "law is Law2_ScGeom_ContactPhys_HertzHistory, .*: read loop.normalStiffness": lambda: law.normalStiffness,  # noqa: F821
}


@pytest.mark.parametrize("words", LABELLED)
def test_a_label_of_what_is_gone_is_refused_with_the_way_out(words):
    disks.new_scene()
    disks.disk(0, 0)
    disks.loop(disks.hertz(label="law"))
    builtins.law = O.engines[2].lawDispatcher.functors[0]  # as YADE does when it loads a scene
    grain_loop.use_grain_loop()
    with pytest.raises(UsageError, match=words):
        LABELLED[words]()


def test_labels_come_back_with_yades_loop():
    scene()
    real = builtins.newton
    grain_loop.use_grain_loop()
    assert builtins.newton != real and repr(builtins.newton) == "<newton: NewtonIntegrator, which GrainLoop replaced>"
    grain_loop.use_yade_loop()
    assert builtins.newton == real
    builtins.newton.gravity = (0, -3, 0)


def test_a_label_that_the_user_gave_to_something_else_is_left_alone():
    scene()
    builtins.newton = "mine"
    grain_loop.use_grain_loop()
    assert builtins.newton == "mine"


def test_a_take_over_that_is_refused_leaves_labels_as_they_are():
    scene()
    O.bodies[0].bounded = False
    real = builtins.newton
    with pytest.raises(ValueError, match="bounded"):
        grain_loop.use_grain_loop()
    assert builtins.newton is real


# ---- runners ---------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("there", [True, False])
def test_where_a_runner_stands_one_line_says_that_interactions_are_empty(there, capsys):
    scene()
    if there:
        put(runner("look"), 3)
    grain_loop.use_grain_loop()
    assert capsys.readouterr().err.count("under GrainLoop O.interactions is empty") == there
