"""Objects under the labels of engines that GrainLoop replaced: reading or setting their attributes raises an error.

YADE makes each label a name in Python's builtins. Without this, `newton.gravity = …` would set an engine that is not used.
"""

import builtins

from ..base.errors import UsageError

NEAREST = {  # attribute of YADE's engines and functors -> attribute of GrainLoop with another name
    "verletDist": "skin",
    "betan": "normalDampingRatio",
    "betas": "tangentialDampingRatio",
    "frictAngle": "friction",
}


class StandIn:
    """An object that refuses every use and names the alternative; `label` and `name` are those of the replaced engine."""

    def __init__(self, label, name):
        object.__setattr__(self, "_is", (label, name))

    def __repr__(self):
        label, name = object.__getattribute__(self, "_is")
        return f"<{label}: {name}, which GrainLoop replaced>"

    def __getattribute__(self, key):
        if key.startswith("_"):  # attributes that Python itself reads, such as the class
            return object.__getattribute__(self, key)
        raise refusal(self, key, "read")

    def __setattr__(self, key, value):
        raise refusal(self, key, "assign")

    def __call__(self, *args, **keys):
        raise refusal(self, "", "call")


def refusal(stand_in, key, verb):
    """Return the UsageError that names the label, the engine and the attribute of GrainLoop to use instead."""
    label, name = object.__getattribute__(stand_in, "_is")
    return UsageError(f"{label} is {name}, which GrainLoop replaced: {way_out(key, verb)}")


def way_out(key, verb):
    """Return advice on what to do instead of reading or assigning an attribute."""
    from yade.wrapper import Engine

    from ..engines import GrainLoop

    taken = NEAREST.get(key, key)
    if key and hasattr(GrainLoop, taken) and not hasattr(Engine, taken):
        return f"{verb} loop.{taken}, where loop is what use_grain_loop returned"
    return "use_yade_loop() brings it back"


def put(loop):
    """Put stand-ins under the labels of a `take_over.Loop` and of its functors; O.engines = … restores the labels."""
    for label, engine in labelled(loop).items():
        if getattr(builtins, label, None) == engine:
            setattr(builtins, label, StandIn(label, type(engine).__name__))


def labelled(loop):
    """Return the engines and functors of a `take_over.Loop` that have a label: dict label -> engine."""
    dispatchers = (
        loop.collider.boundDispatcher,
        loop.contacts.geomDispatcher,
        loop.contacts.physDispatcher,
        loop.contacts.lawDispatcher,
    )
    parts = [*loop, *dispatchers, *(functor for dispatcher in dispatchers for functor in dispatcher.functors)]
    return {part.label: part for part in parts if part.label}
