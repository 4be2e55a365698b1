"""Claims of a paper and what a measurement says of them: reproduced, not reproduced, or not decided.

A verdict follows from a rule that is stated beside it. All rules work with the interval of two standard errors about
the measured value, 95 % for normal errors. A measurement whose error is unknown, or too large to tell the claim from
its opposite, decides nothing.
"""

from dataclasses import dataclass
from enum import Enum

import numpy as np

from ..measured import Limit, Measured

SIGMAS = 2


class Verdict(Enum):
    """What a measurement says of a claim."""

    REPRODUCED = "reproduced"
    NOT_REPRODUCED = "not reproduced"
    NOT_DECIDED = "not decided"


def interval(measured):
    """Return (low, high), two standard errors about the value."""
    return measured.value - SIGMAS * measured.error, measured.value + SIGMAS * measured.error


def is_known(measured):
    """True if both value and error are finite numbers."""
    return bool(np.isfinite(measured.value) and np.isfinite(measured.error) and measured.error >= 0)


@dataclass(frozen=True)
class Agrees:
    """The value is `expected`, within two standard errors and the `tolerance` with which the paper can be read.

    Agreement counts only if two standard errors are not above `resolution`, the smallest difference that would matter;
    without this any measurement would agree if it were bad enough. All three in the unit of the value.
    """

    expected: float
    tolerance: float
    resolution: float

    def judge(self, measured):
        """Return the verdict; a `Limit` can only tell against the claim."""
        if isinstance(measured, Limit):
            out = measured.excludes(self.expected - self.tolerance, self.expected + self.tolerance)
            return Verdict.NOT_REPRODUCED if out else Verdict.NOT_DECIDED
        if not is_known(measured):
            return Verdict.NOT_DECIDED
        if abs(measured.value - self.expected) > self.tolerance + SIGMAS * measured.error:
            return Verdict.NOT_REPRODUCED
        return Verdict.REPRODUCED if SIGMAS * measured.error <= self.resolution else Verdict.NOT_DECIDED

    def __str__(self):
        within = f"{self.tolerance:g} + 2σ" if self.tolerance else "2σ"
        return f"within {within} of {self.expected:g}, if 2σ ≤ {self.resolution:g}"


@dataclass(frozen=True)
class Between:
    """The value lies between `low` and `high`, with two standard errors to spare; one of them may be infinite."""

    low: float
    high: float

    def judge(self, measured):
        """Return the verdict."""
        if isinstance(measured, Limit):
            return self.judge_limit(measured)
        low, high = interval(measured)
        if not is_known(measured):
            return Verdict.NOT_DECIDED
        if self.low < low and high < self.high:
            return Verdict.REPRODUCED
        return Verdict.NOT_REPRODUCED if high < self.low or low > self.high else Verdict.NOT_DECIDED

    def judge_limit(self, limit):
        """Return the verdict on a number of which only a bound is known."""
        if limit.excludes(self.low, self.high):
            return Verdict.NOT_REPRODUCED
        open_side = self.high if limit.side == ">" else -self.low
        within = limit.value >= self.low if limit.side == ">" else limit.value <= self.high
        return Verdict.REPRODUCED if np.isinf(open_side) and within else Verdict.NOT_DECIDED

    def __str__(self):
        if np.isinf(self.high):
            return f"above {self.low:g} by 2σ"
        return (
            f"below {self.high:g} by 2σ" if np.isinf(self.low) else f"between {self.low:g} and {self.high:g}, 2σ inside"
        )


def above(bound):
    """Return the rule that the value is significantly above `bound`."""
    return Between(bound, float("inf"))


def below(bound):
    """Return the rule that the value is significantly below `bound`."""
    return Between(float("-inf"), bound)


@dataclass(frozen=True)
class Claim:
    """One claim: its `text`, the `source` in the paper, what is `expected` in words, what was `measured`, the `rule`.

    `settings` says of which runs it is, `runs` are their names.
    """

    text: str
    source: str
    expected: str
    measured: Measured
    rule: object
    settings: str = ""
    runs: tuple = ()

    @property
    def verdict(self):
        """What the measurement says of the claim, by the rule."""
        return self.rule.judge(self.measured)

    @property
    def number(self):
        """The measured number with its error, in words."""
        return str(self.measured) if np.isfinite(self.measured.value) else "no data"

    def __str__(self):
        return f"{self.text}: {self.number}, {self.verdict.value}"


def tally(claims):
    """Return in words how many claims got which verdict."""
    counts = [(verdict, sum(claim.verdict is verdict for claim in claims)) for verdict in Verdict]
    return ", ".join(f"{count} {verdict.value}" for verdict, count in counts)
