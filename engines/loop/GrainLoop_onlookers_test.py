"""Other engines that read or change bodies while GrainLoop runs: they read the present state, and changes act at once."""

import disks
import numpy as np
import pytest
from graindrive import engines
from graindrive.loops import grain_loop
from yade import O, wrapper


def bed():
    """Nine free disks that fall towards three frozen ones; return ids (frozen, free)."""
    disks.new_scene(dt=1e-3)
    frozen = [disks.disk(x, 0, frozen=True) for x in (0.0, 1.0, 2.0)]
    free = [disks.disk(1.1 * k, 3.0) for k in range(9)]
    disks.loop(disks.hertz(gamma_n=50, gamma_t=50), gravity=(0, -1))
    return frozen, free


def put_in(engine):
    O.engines = O.engines[:-1] + [engine, O.engines[-1]]


def both_loops(build, steps=300):
    seen = []
    for loop in ("yade", "grain"):
        build()
        if loop == "grain":
            grain_loop.use_grain_loop()
        disks.run(steps)
        seen.append(disks.everything())
    return seen


def assert_same_motion(seen, tolerance=1e-11):
    yade, grain = seen
    np.testing.assert_allclose(grain[:, 0:6], yade[:, 0:6], rtol=0, atol=tolerance)
    np.testing.assert_allclose(grain[:, 10:13], yade[:, 10:13], rtol=0, atol=tolerance)


def test_a_recorder_sees_free_disks_where_they_are():
    seen = []
    for loop in ("yade", "grain"):
        _, free = bed()
        heights = O.tags["heights"] = ""
        put_in(
            wrapper.PyRunner(
                command=f"O.tags['heights'] += repr(O.bodies[{free[0]}].state.pos[1]) + ' '", iterPeriod=7, initRun=True
            )
        )
        if loop == "grain":
            grain_loop.use_grain_loop()
        disks.run(100)
        heights = [float(word) for word in O.tags["heights"].split()]
        seen.append(heights)
    assert len(seen[1]) >= 14 and len(set(seen[1])) == len(seen[1])
    np.testing.assert_allclose(seen[1], seen[0], rtol=0, atol=1e-12)


@pytest.mark.parametrize(
    "what",
    [
        "s.vel = (0, 2, 0)",
        "s.angVel = (0, 0, 3); s.angMom = s.inertia[2] * s.angVel",
        "s.pos = (50, 7, 0)",
        "s.mass = 3 * s.mass; s.inertia = 3 * s.inertia",
        "s.blockedDOFs = 'xyzXYZ'; s.vel = (0, 0, 0)",
    ],
)
def test_what_a_runner_writes_into_a_free_disk_acts_from_that_step_on(what):
    def build():
        _, free = bed()
        put_in(wrapper.PyRunner(command=f"s = O.bodies[{free[4]}].state; {what}", firstIterRun=150, nDo=1))

    assert_same_motion(both_loops(build))


def test_what_python_writes_between_two_runs_is_heard():
    seen = []
    for loop in ("yade", "grain"):
        _, free = bed()
        if loop == "grain":
            grain_loop.use_grain_loop()
        disks.run(100)
        O.bodies[free[0]].state.vel = (1, 0, 0)
        O.bodies[free[1]].state.pos = (-40, 5, 0)
        disks.run(100)
        seen.append(disks.everything())
    assert_same_motion(seen)


def test_a_frozen_disk_set_in_motion_moves_from_that_step_on():
    def build():
        frozen, _ = bed()
        put_in(wrapper.PyRunner(command=f"O.bodies[{frozen[1]}].state.vel = (0, 1, 0)", firstIterRun=150, nDo=1))

    seen = both_loops(build, steps=160)
    assert_same_motion(seen)
    assert seen[1][1][1] == pytest.approx(10 * 1e-3, rel=1e-9)  # after ten steps, not after a hundred


def test_a_frozen_disk_put_elsewhere_is_met_there():
    def build():
        frozen, free = bed()
        put_in(wrapper.PyRunner(command=f"O.bodies[{frozen[0]}].state.pos = (8.8, 1.9, 0)", firstIterRun=150, nDo=1))

    assert_same_motion(both_loops(build, steps=600))


def test_a_kinematic_engine_of_yades_moves_frozen_disks():
    def build():
        frozen, _ = bed()
        put_in(wrapper.TranslationEngine(ids=frozen, translationAxis=(0, 1, 0), velocity=0.5))

    assert_same_motion(both_loops(build, steps=1500), tolerance=1e-9)  # with impacts


def speeds_of_a_disk_on_a_base_that_begins_to_slide(loop, place):
    """The speeds along x after each of ten steps, with TranslationEngine at that position among YADE's four engines."""
    disks.new_scene(dt=1e-4)
    base, disk = disks.disk(0, 0, frozen=True), disks.disk(0, 0.99)
    disks.loop(disks.hertz(), friction=0.4, gravity=(0, -10))
    disks.run(3)  # disks touch the base before it moves
    engine = wrapper.TranslationEngine(ids=[base], translationAxis=(1, 0, 0), velocity=0.1, dead=True)
    O.engines = O.engines[:place] + [engine] + O.engines[place:]
    if loop == "grain":
        grain_loop.use_grain_loop()
    O.step()
    engine.dead = False
    speeds = []
    for _ in range(10):
        O.step()
        speeds.append(O.bodies[disk].state.vel[0])
    return np.array(speeds)


def test_what_sets_frozen_disks_in_motion_behind_the_contacts_is_felt_as_on_yades_loop():
    yade, grain = (speeds_of_a_disk_on_a_base_that_begins_to_slide(loop, 3) for loop in ("yade", "grain"))
    np.testing.assert_allclose(grain, yade, rtol=1e-9, atol=1e-15)
    assert yade[0] == 0 and yade[1] > 0


def test_what_sets_frozen_disks_in_motion_before_the_contacts_is_felt_one_step_later_than_on_yades_loop():
    yade, grain = (speeds_of_a_disk_on_a_base_that_begins_to_slide(loop, 2) for loop in ("yade", "grain"))
    assert yade[0] > 0 and grain[0] == 0
    np.testing.assert_allclose(grain[1:], yade[:-1], rtol=0.02)  # the normal force grows by a percent a step


def test_one_step_shows_all_disks():
    _, free = bed()
    grain_loop.use_grain_loop()
    O.step()
    O.step()
    assert O.bodies[free[0]].state.vel[1] == pytest.approx(-2e-3, rel=1e-9)


def test_a_body_that_python_turns_is_turned():
    disks.new_scene(dt=1e-3)
    clump, members = disks.clump([(-0.3, 0), (0.3, 0)])
    disks.disk(10, 10)
    disks.loop()
    loop = grain_loop.use_grain_loop()
    disks.run(1)
    O.bodies[clump].state.ori = O.bodies[clump].state.ori * quarter_turn()
    disks.run(1)
    row = list(loop.ids).index(members[1])
    np.testing.assert_allclose(loop.positions[row], (0, 0.3), rtol=0, atol=1e-12)


def quarter_turn():
    from yade.minieigenHP import Quaternion, Vector3

    return Quaternion(Vector3(0, 0, 1), np.pi / 2)


@pytest.mark.parametrize(
    "engine", [wrapper.GlobalStiffnessTimeStepper, wrapper.ForceRecorder, wrapper.ServoPIDController]
)
def test_an_engine_that_needs_interactions_is_refused_by_name(engine):
    bed()
    put_in(engine())
    before = [type(e).__name__ for e in O.engines]
    with pytest.raises(RuntimeError, match=f"does not know what {engine.__name__} needs"):
        grain_loop.use_grain_loop()
    assert [type(e).__name__ for e in O.engines] == before


def test_a_trusted_engine_may_stand():
    bed()
    put_in(wrapper.ServoPIDController(dead=False))
    grain_loop.use_grain_loop(trusted=["ServoPIDController"])
    assert type(O.engines[0]).__name__ == "ServoPIDController"


def test_an_engine_added_later_is_looked_at():
    bed()
    grain_loop.use_grain_loop()
    disks.run(5)
    O.engines = [wrapper.GlobalStiffnessTimeStepper()] + O.engines
    with pytest.raises(RuntimeError, match="does not know what GlobalStiffnessTimeStepper needs"):
        O.engines[-1]()


def test_measures_make_nobody_write_all_bodies():
    """Graindrive's own engines read from the loop, so YADE's bodies are not written for them, which would cost time."""
    _, free = bed()
    put_in(engines.ContactForceBinner(body=free[0]))
    loop = grain_loop.use_grain_loop()
    disks.run(2)
    shown = O.bodies[free[3]].state.pos[1]
    height = loop.positions[list(loop.ids).index(free[3])][1]
    assert shown == height


@pytest.mark.parametrize("what", ["added", "erased"])
def test_bodies_that_come_or_go_between_sync_and_read_do_so_as_on_yades_loop(what):
    seen = []
    for kind in ("yade", "grain"):
        _, free = bed()
        loop = grain_loop.use_grain_loop() if kind == "grain" else None
        disks.run(100)
        if loop:
            loop.sync()
        if what == "added":
            disks.disk(0.5, 6.0)
        else:
            O.bodies.erase(free[1])
        if loop:
            loop.read()
        disks.run(1500)
        seen.append(np.array([[*b.state.pos, *b.state.vel] for b in O.bodies if b]))
    np.testing.assert_allclose(seen[1], seen[0], rtol=0, atol=1e-9)  # with impacts


@pytest.mark.parametrize("what", ["added", "erased"])
def test_a_body_that_came_or_went_unsaid_stops_the_run_until_it_is_repaired(what):
    _, free = bed()
    loop = grain_loop.use_grain_loop()
    disks.run(100)
    if what == "added":
        disks.disk(0.5, 6.0)
    else:
        O.bodies.erase(free[1])
    for _ in range(2):
        with pytest.raises(RuntimeError, match="read\\(\\) after"):
            O.step()
    loop.read()
    disks.run(100)
    assert O.bodies[free[0]].state.vel[1] == pytest.approx(-0.2, rel=1e-9)


def held_clump_and_a_disk_that_falls_on_it(held, large):
    disks.new_scene(dt=2e-4)
    ident = disks.disk(0, 0, 1.0) if large else disks.clump([(-0.3, 0), (0.3, 0)], mass=2.0)[0]
    O.bodies[ident].state.blockedDOFs = "xyzXYZ" if held else "zXY"
    falling = disks.disk(0, 2.0, velocity=(0, -1))
    disks.disk(20, 0), disks.disk(25, 0)
    disks.loop(disks.hertz(gamma_n=500))
    return ident, falling


@pytest.mark.parametrize("held, large", [(True, False), (False, False), (False, True)])
def test_a_body_that_is_held_or_freed_counts_so_in_the_damping_of_later_contacts(held, large):
    rebounds = []
    for loop in ("yade", "grain"):
        ident, falling = held_clump_and_a_disk_that_falls_on_it(held, large)
        if loop == "grain":
            grain_loop.use_grain_loop()
        disks.run(50)
        O.bodies[ident].state.blockedDOFs = "zXY" if held else "xyzXYZ"
        disks.run(8000)
        rebounds.append(O.bodies[falling].state.vel[1])
    assert rebounds[0] > 0.1
    assert rebounds[1] == pytest.approx(rebounds[0], abs=1e-9)


@pytest.mark.parametrize("by_runner", [False, True])
def test_a_clump_that_becomes_heavier_answers_so_at_once(by_runner):
    seen = []
    for loop in ("yade", "grain"):
        disks.new_scene(dt=1e-3)
        ident, _ = disks.clump([(-0.3, 0), (0.3, 0)], at=(0, 5))
        disks.disk(10, 0)
        disks.loop()
        O.forces.setPermF(ident, (1, 0, 0))
        O.forces.setPermT(ident, (0, 0, 1))
        heavier = f"s = O.bodies[{ident}].state; s.mass *= 10; s.inertia = s.inertia * 10"
        if by_runner:
            put_in(wrapper.PyRunner(command=heavier, firstIterRun=100, nDo=1, iterPeriod=1))
        if loop == "grain":
            grain_loop.use_grain_loop()
        disks.run(100)
        if not by_runner:
            exec(heavier)
        disks.run(100)
        seen.append(disks.everything())
    assert_same_motion(seen)


def test_a_body_that_shall_not_be_damped_is_refused_in_mid_run():
    bed()
    disks.engine("newton").damping = 0.3
    grain_loop.use_grain_loop()
    disks.run(10)
    O.bodies[len(O.bodies) - 1].state.isDamped = False
    with pytest.raises(ValueError, match="state.isDamped=False"):
        O.engines[-1]()


def test_a_body_without_shape_is_refused():
    _, free = bed()
    grain_loop.use_grain_loop()
    disks.run(10)
    shape, O.bodies[free[0]].shape = O.bodies[free[0]].shape, None
    with pytest.raises(RuntimeError, match=f"body {free[0]} has lost its shape"):
        O.engines[-1]()
    O.bodies[free[0]].shape = shape
    disks.run(10)


def test_members_lie_beside_their_clump_wherever_that_is_put():
    disks.new_scene(dt=1e-3, period=(12, 40, 12))
    ident, members = disks.clump([(-0.3, 0), (0.3, 0)], at=(5, 5))
    disks.disk(1, 1)
    disks.loop()
    grain_loop.use_grain_loop()
    disks.run(10)
    O.bodies[ident].state.pos += (12, 0, 0)
    disks.run(300)  # a search wraps grains into the box
    centre = O.bodies[ident].state.pos
    for member, side in zip(members, (-1, 1)):
        assert O.bodies[member].state.pos[0] - centre[0] == pytest.approx(0.3 * side, abs=1e-9)


@pytest.mark.parametrize("start", ["frozen", "clump"])
def test_contacts_of_the_step_that_sets_a_body_in_motion_do_not_feel_it_yet(start):
    """YADE's forces of a step are computed before an engine behind them moves something."""

    def build():
        disks.new_scene(dt=1e-3)
        if start == "frozen":
            moved = disks.disk(0, 0, frozen=True)
        else:
            moved = disks.clump([(-0.2, 0), (0.2, 0)], at=(0, 0), radius=0.4)[0]
            O.bodies[moved].state.blockedDOFs = "xyzXYZ"
        disks.disk(1.5, 0, frozen=True)
        disks.disk(0.75, 0.6 if start == "frozen" else 0.7)
        disks.loop(disks.hertz(gamma_n=500, gamma_t=500), friction=0.5, gravity=(0, -10))
        put_in(wrapper.TranslationEngine(ids=[moved], translationAxis=(1, 0, 0), velocity=0.5, dead=True))
        O.engines = (
            O.engines[:-2]
            + [wrapper.PyRunner(command="O.engines[-2].dead = O.iter < 20", iterPeriod=1)]
            + O.engines[-2:]
        )

    # Round-off of sums and of the clump's members, grown in 60 steps.
    assert_same_motion(both_loops(build, steps=60), tolerance=1e-11)
