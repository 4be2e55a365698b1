"""A case at an extreme and its outcome: the right answer, a guard, a documented bound, or a wrong answer."""

import math
from collections.abc import Callable
from dataclasses import dataclass, field

RIGHT, GUARD, BOUND, WRONG = "right", "guard", "bound", "wrong"
WORDS = (RIGHT, GUARD, BOUND, WRONG)
LOOPS, PRECISIONS = ("grain", "yade"), ("double", "single")


@dataclass(frozen=True)
class Setting:
    """Settings of a case: `loop` and `precision` as in every study, `steps` of the bound pair, `strain` of the sheared cell."""

    loop: str = "grain"
    precision: str = "double"
    steps: int = 100_000
    strain: float = 2.0

    @property
    def single(self):
        """True if contacts are computed in single precision."""
        return self.precision == "single"


@dataclass(frozen=True)
class Outcome:
    """Outcome of a case: a `word` of WORDS, the number `measured`, the number `expected` by `source`, and the tolerance.

    Numbers are ratios or errors without a unit. `sentence` describes the test and its result; `trials` are columns (n,) of
    numbers or words, one row per trial, for figures.
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
        """Difference of measured and expected number over the tolerance [-]; above 1 the answer is wrong."""
        return abs(self.measured - self.expected) / self.tolerance


@dataclass(frozen=True)
class Case:
    """One extreme: its description, and the function that takes a `Setting` and returns its `Outcome`.

    `loops` and `precisions` are those to which it applies.
    """

    meaning: str
    run: Callable
    loops: tuple = LOOPS
    precisions: tuple = PRECISIONS


def judged(word, measured, expected, tolerance, source, sentence, trials=None):
    """Return the `Outcome` with this word if the number is as expected, else with `wrong`."""
    holds = math.isfinite(measured) and abs(measured - expected) <= tolerance
    measured = measured if math.isfinite(measured) else 1e30  # finite, but outside of every tolerance
    return Outcome(word if holds else WRONG, measured, expected, tolerance, source, sentence, trials or {})


def largest(holds, low, high, resolution):
    """Return the largest number for which `holds`, by bisection in the logarithm: true at `low`, not at `high`.

    Returns nan if it does not hold at `low`, infinity if it holds at `high`; `resolution` is the relative accuracy.
    """
    if not holds(low):
        return math.nan
    if holds(high):
        return math.inf
    while high / low > 1 + resolution:
        middle = math.sqrt(low * high)
        low, high = (middle, high) if holds(middle) else (low, middle)
    return math.sqrt(low * high)
