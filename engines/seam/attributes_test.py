"""What Python may set on the classes that Graindrive adds to YADE: only what they have, all or nothing, and checked."""

import pytest
from graindrive import engines
from yade.wrapper import Serializable

CLASSES = [
    engines.OscillationDrive,
    engines.SpinTranslateDrive,
    engines.DrumDrive,
    engines.ShearDrive,
    engines.ContactForceBinner,
    engines.FieldAverager,
    engines.GrainLoop,
    engines.ContactPhys,
    engines.Ip2_FrictMat_FrictMat_ContactPhys,
    engines.Law2_ScGeom_ContactPhys_HertzHistory,
    engines.Law2_ScGeom_ContactPhys_HertzRestitution,
    engines.Law2_ScGeom_ContactPhys_SpringDashpot,
    engines.Solid,
    engines.Bo1_Solid_Aabb,
    engines.Ig2_Solid_Sphere_ScGeom,
]
each_class = pytest.mark.parametrize("cls", CLASSES)


def test_every_class_is_looked_at():
    ours = {c for c in vars(engines).values() if isinstance(c, type) and issubclass(c, Serializable)}
    assert ours == set(CLASSES)


@each_class
@pytest.mark.parametrize("set_it", ["assignment", "updateAttrs", "constructor"])
def test_a_name_that_does_not_exist_is_refused(cls, set_it):
    made = cls()
    with pytest.raises(
        AttributeError, match=f"{cls.__name__} has no attribute 'boddy'; did you mean '.+'\\? Its attributes are .+"
    ):
        if set_it == "assignment":
            made.boddy = 3
        elif set_it == "updateAttrs":
            made.updateAttrs({"boddy": 3})
        else:
            cls(boddy=3)
    assert not hasattr(made, "boddy")


@pytest.mark.parametrize(
    "cls, wrong, right",
    [
        (engines.OscillationDrive, "boddy", "body"),
        (engines.OscillationDrive, "Amplitude", "amplitude"),
        (engines.SpinTranslateDrive, "angularvelocity", "velocity"),
        (engines.DrumDrive, "angularvelocity", "angularVelocity"),
        (engines.ContactForceBinner, "evry", "every"),
        (engines.GrainLoop, "frction", "friction"),
        (engines.GrainLoop, "labl", "label"),
        (engines.Law2_ScGeom_ContactPhys_HertzHistory, "leverarm", "leverArm"),
    ],
)
def test_the_nearest_name_is_told(cls, wrong, right):
    with pytest.raises(AttributeError, match=f"; did you mean '{right}'\\? Its attributes are "):
        setattr(cls(), wrong, 1)


@pytest.mark.parametrize("cls", CLASSES[:6])
def test_what_every_engine_of_yade_has_stays_assignable(cls):
    made = cls()
    made.label, made.dead, made.ompThreads = "mine", True, 2
    made.updateAttrs({"label": "yours", "dead": False})
    assert (made.label, made.dead, made.ompThreads) == ("yours", False, 2)
    with pytest.raises(AttributeError, match="setter|set"):
        made.timingDeltas = 3


def test_a_functor_has_a_label():
    law = engines.Law2_ScGeom_ContactPhys_HertzHistory(label="law")
    law.label = "other"
    assert law.label == "other"


def test_a_result_cannot_be_assigned():
    with pytest.raises(AttributeError, match="setter|set"):
        engines.ContactForceBinner().angles = [1]


def test_a_class_of_the_users_own_may_have_attributes_of_its_own():
    class Marked(engines.OscillationDrive):
        pass

    made = Marked(period=3)
    made.note = "the left one"
    assert made.note == "the left one" and made.period == 3


@pytest.mark.parametrize("update", [lambda made, d: made.updateAttrs(d), Serializable.updateAttrs])
@pytest.mark.parametrize(
    "cls, wrong, rule",
    [
        (engines.OscillationDrive, {"amplitude": 3, "period": -1}, "period must be positive, got -1"),
        (engines.SpinTranslateDrive, {"velocity": (1, 0, 0), "dofs": "q"}, "takes letters of 'xyzXYZ', got q"),
        (engines.DrumDrive, {"angularVelocity": (0, 0, float("nan"))}, "angularVelocity must be finite"),
        (engines.ContactForceBinner, {"every": 0}, "every must be at least 1, got 0"),
        (engines.FieldAverager, {"every": 0}, "every"),
        (engines.GrainLoop, {"threads": 0}, "threads must lie in 1..256, got 0"),
        (engines.Law2_ScGeom_ContactPhys_HertzHistory, {"normalStiffness": 0}, "normalStiffness must be positive"),
        (engines.Law2_ScGeom_ContactPhys_HertzRestitution, {"poisson": 0.6}, "poisson must lie in"),
        (engines.Law2_ScGeom_ContactPhys_SpringDashpot, {"restitution": 1.5}, "restitution must lie in"),
    ],
)
def test_values_that_are_refused_are_taken_back(cls, wrong, rule, update):
    made = cls()
    before = {name: getattr(made, name) for name in wrong}
    with pytest.raises(ValueError, match=rule):
        update(made, wrong)
    kept = {name: getattr(made, name) for name in wrong}
    if update is Serializable.updateAttrs:  # YADE's own goes one by one
        before["amplitude"], kept["amplitude"] = None, None
        before["velocity"], kept["velocity"] = None, None
    assert kept == before


def test_all_or_none_is_taken():
    drive = engines.OscillationDrive(amplitude=1, period=2, label="a")
    before = drive.dict()
    for wrong, kind, words in (
        ({"label": "b", "dead": True, "amplitude": 5, "period": "fast"}, TypeError, "period cannot be made from fast"),
        ({"label": "b", "amplitude": 5, "period": 0}, ValueError, "period must be positive, got 0"),
        ({"amplitude": 5, "phase": 1, "periode": 3}, AttributeError, "no attribute 'periode'; did you mean 'period'"),
    ):
        with pytest.raises(kind, match=words):
            drive.updateAttrs(wrong)
        assert drive.dict() == before


def test_values_that_are_right_together_are_taken_in_any_order():
    binner = engines.ContactForceBinner()
    binner.updateAttrs({"kernel": "gaussian", "count": 8, "label": "b", "width": 0.8})
    assert (binner.kernel, binner.count, binner.width, binner.label) == ("gaussian", 8, 0.8, "b")
