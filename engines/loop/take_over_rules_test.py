"""Scenes that YADE's engines support and GrainLoop does not: each rule refuses by name, and the scene stays unchanged."""

import disks
import pytest
from graindrive import engines
from graindrive.loops import grain_loop, take_over
from graindrive.base.errors import UsageError
from yade import O, wrapper


def pair():
    """Two free disks that overlap by a tenth of a radius."""
    disks.new_scene(dt=1e-3)
    disks.disk(1, 1), disks.disk(1.95, 1)
    disks.loop(disks.hertz(gamma_n=50, gamma_t=50), friction=0.3)


# One obstacle for each rule, by the rule's name: the change of the scene, and a part of the message.
OBSTACLES = {
    "dead": (lambda: setattr(disks.engine("contacts"), "dead", True), "InteractionLoop.dead is True"),
    "newton_mask": (lambda: setattr(disks.engine("newton"), "mask", 2), "NewtonIntegrator.mask=2 leaves out body 0"),
    "self_interaction": (
        lambda: setattr(disks.engine("collider"), "avoidSelfInteractionMask", 1),
        "avoidSelfInteractionMask=1 keeps body 0",
    ),
    "geometry": (lambda: contacts_with(geometry=[wrapper.Ig2_Facet_Sphere_ScGeom()]), "needs Ig2_Sphere_Sphere_ScGeom"),
    "distant_contacts": (
        lambda: contacts_with(geometry=[wrapper.Ig2_Sphere_Sphere_ScGeom(interactionDetectionFactor=1.5)]),
        "interactionDetectionFactor is 1.5",
    ),
    "one_functor_each": (
        lambda: contacts_with(laws=[disks.hertz(), wrapper.Law2_ScGeom_FrictPhys_CundallStrack()]),
        "one Law2_ functor",
    ),
    "callbacks": (
        lambda: setattr(disks.engine("contacts"), "callbacks", [wrapper.SumIntrForcesCb()]),
        "callbacks holds SumIntrForcesCb",
    ),
    "energy_of_yade": (lambda: setattr(O, "trackEnergy", True), "O.trackEnergy is True"),
    "recorded_contacts": (
        lambda: setattr(O, "engines", [wrapper.VTKRecorder(recorders=["spheres", "intr"], dead=True)] + O.engines),
        "VTKRecorder is to record 'intr'",
    ),
    "order_of_the_four": (
        lambda: setattr(O, "engines", [O.engines[-1]] + O.engines[:-1]),
        "its engines is NewtonIntegrator, ForceResetter, InsertionSortCollider, InteractionLoop; it must be ForceResetter",
    ),
    "forces_that_are_erased": (
        lambda: setattr(O, "engines", O.engines + [wrapper.ForceEngine()]),
        "ForceEngine stands behind NewtonIntegrator, .*put it between InteractionLoop and NewtonIntegrator",
    ),
    "misplaced_drives_and_measures": (
        lambda: setattr(O, "engines", O.engines + [engines.ContactForceBinner(body=0)]),
        "ContactForceBinner stands behind NewtonIntegrator; put it between",
    ),
}


def contacts_with(geometry=None, laws=None):
    """Put an InteractionLoop with these functors in place of the scene's."""
    made = wrapper.InteractionLoop(
        geometry or [wrapper.Ig2_Sphere_Sphere_ScGeom()],
        [engines.Ip2_FrictMat_FrictMat_ContactPhys(friction=0.3)],
        laws or [disks.hertz()],
        label="contacts",
    )
    O.engines = [made if type(e).__name__ == "InteractionLoop" else e for e in O.engines]


@pytest.mark.parametrize("rule", [rule.name for rule in take_over.RULES])
def test_every_obstacle_of_the_list_is_named_and_nothing_is_changed(rule):
    pair()
    put, words = OBSTACLES[rule]
    put()
    before = [type(e).__name__ for e in O.engines]
    try:
        with pytest.raises(UsageError, match=words):
            grain_loop.use_grain_loop()
    finally:
        O.trackEnergy = False
    assert [type(e).__name__ for e in O.engines] == before


@pytest.mark.parametrize("name", take_over.REPLACED)
@pytest.mark.parametrize("count", [0, 2])
def test_each_of_yades_engines_must_be_there_once(name, count):
    pair()
    others = [e for e in O.engines if type(e).__name__ != name]
    O.engines = others + [getattr(wrapper, name)() for _ in range(count)]
    with pytest.raises(UsageError, match=f"must hold (a|one) {name}"):
        grain_loop.use_grain_loop()
