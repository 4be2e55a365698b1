"""What a case at an extreme is, and what comes out of it: the right answer, a guard, a documented bound, or a wrong answer."""

import math
from collections.abc import Callable
from dataclasses import dataclass, field

RIGHT, GUARD, BOUND, WRONG = "right", "guard", "bound", "wrong"
WORDS = (RIGHT, GUARD, BOUND, WRONG)
LOOPS, PRECISIONS = ("grain", "yade"), ("double", "single")


@dataclass(frozen=True)
class Setting:
    """How a case is run: `loop` and `precision` as in every study, `steps` of the bound pair, `strain` of the sheared cell."""

    loop: str = "grain"
    precision: str = "double"
    steps: int = 100_000
    strain: float = 2.0

    @property
    def single(self):
        """True where contacts are computed in single precision."""
        return self.precision == "single"


@dataclass(frozen=True)
class Outcome:
    """What came out: a `word` of WORDS, the number `measured`, the one `expected` by `source`, and how far apart they may be.

    Numbers are ratios or errors without a unit. `sentence` says what was tried and found; `trials` are columns (n,) of numbers
    or words, one row a trial, for figures.
    """

    word: str
    measured: float
    expected: float
    tolerance: float
    source: str
    sentence: str
    trials: dict = field(default_factory=dict)

    @property
    def error_over_bound(self):
        """How much of its tolerance the case uses up [-]; above 1 the answer is wrong."""
        return abs(self.measured - self.expected) / self.tolerance


@dataclass(frozen=True)
class Case:
    """One extreme: what it is in words, and the function of a `Setting` that returns its `Outcome`.

    `loops` and `precisions` are those that mean something to it.
    """

    meaning: str
    run: Callable
    loops: tuple = LOOPS
    precisions: tuple = PRECISIONS


def judged(word, measured, expected, tolerance, source, sentence, trials=None):
    """Return the `Outcome` with this word if the number is as expected, else with `wrong`."""
    holds = math.isfinite(measured) and abs(measured - expected) <= tolerance
    measured = measured if math.isfinite(measured) else 1e30  # a number that tells against any claim
    return Outcome(word if holds else WRONG, measured, expected, tolerance, source, sentence, trials or {})


def largest(holds, low, high, resolution):
    """Return the largest number for which `holds`, by bisection in the logarithm: true at `low`, not at `high`.

    Returns nan if it does not hold at `low`, infinity if it holds at `high`; the result is sharp to a part `resolution`.
    """
    if not holds(low):
        return math.nan
    if holds(high):
        return math.inf
    while high / low > 1 + resolution:
        middle = math.sqrt(low * high)
        low, high = (middle, high) if holds(middle) else (low, middle)
    return math.sqrt(low * high)
