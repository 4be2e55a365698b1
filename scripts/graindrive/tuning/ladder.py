"""The settings that a study's levers can take, from the reference towards cheaper ones."""

from ..commands.command_line import parse
from ..base.errors import UsageError, one_line
from ..commands.parameter_values import argument
from ..parameters import plain_type

MOST_RUNGS = 5


def reference_of(study, given):
    """Return {lever: value} from which a tuning starts: what the user gives, else the lever's reference."""
    return {key: given.get(key, lever.reference) for key, lever in study.levers.items()}


def parameters_of(study, values):
    """Return the checked parameters for a dict of values, some of which may have no effect; UsageError for refused ones."""
    words = [argument(study.parameters, key, value) for key, value in {**values, "unused": "allow"}.items()]
    p = parse(study, words, environment={})
    study.check(p)
    return p


def rungs(study, values, key):
    """Return (values of the lever `key` that cost less than in the dict `values`, nearest first; why they end, in words).

    Numbers go by the lever's factor, at most `MOST_RUNGS` times; a value that the study refuses ends the ladder.
    """
    lever, found, start = study.levers[key], [], values[key]
    if start is None:
        start = parameters_of(study, values).taken()[key]
    for value in steps(lever, start, plain_type(study.parameters.__fields__[key]) is int):
        try:
            parameters_of(study, {**values, key: value})
        except UsageError as error:
            return found, one_line(error, 200)
        found.append(value)
    return found, ""


def steps(lever, start, whole):
    """Yield the values of a lever below or above `start`, in the direction that costs less."""
    if isinstance(lever.reference, str):
        words = (lever.reference, *lever.cheaper)
        yield from words[words.index(start) + 1 :] if start in words else ()
        return
    factor = lever.factor if lever.cheaper == "higher" else 1 / lever.factor
    value = start
    for _ in range(MOST_RUNGS):
        before, value = value, value * factor
        value = round(value) if whole else tidy(value)
        if value == before:
            return
        yield value


def tidy(value):
    """Return a number with the digits that ten halvings of a short number need, so that 0.3/2 is 0.15."""
    return float(f"{value:.12g}")
