"""Extremes: scenes at the limits of what is allowed give the right number, an error that names the cause, or a known bound.

One run is one `case`: a scene of one to some hundred grains, or a small continuum drum, compared with a closed form. Cases are
the largest stable step of every law in two and three dimensions, restitution 0.01 to 1, friction 0 to 10, spin ratios to 1000,
speeds up to the overlap limit and beyond, radii 1:50, masses 1e6, springs 1e-12 to 1e24, a position 1e6 d from the origin, a
bound pair for `pair_steps` steps, area fractions from 0.01 to jamming, a cell sheared for `strain` strains, and the drum's
largest viscosity. The table in `graindrive/extremes/table.py` lists the cases: name, description, function.

The outcome is a word. `right`: the number agrees with the closed form within the tolerance. `guard`: a check stopped the run
where it should, and said why. `bound`: the number agrees with a limit that users must know. `wrong`: none of these; such a run
ends normally but does not reproduce its claim. `summary.json` has the number, the expected number, the tolerance, the source and
a sentence.

Some cases allow only some loops and precisions; for example, YADE's loop has no guards of GrainLoop. A loop or precision that
does not apply is refused by name. Each case has its own time step, so dt_factor is refused too.

Cost: a second or less per case. Exceptions are the bound pair with some 0.6 us a step (the paper's 1e8 steps take a minute), and
the sheared cell and the drums with some seconds each.

    scripts/run extremes case=friction_2d
    scripts/run extremes case=far_3d precision=single
    scripts/campaign studies/campaigns/extremes.yaml          all cases, and the table in studies/RESULTS.md
"""

import os
import sys
from typing import Literal

if __name__ == "__main__":  # `yade` runs scripts by exec: __file__ is YADE's own
    sys.path.insert(0, os.path.dirname(os.path.abspath(sys.argv[0])))

import house  # noqa: E402, F401

import numpy as np  # noqa: E402

from graindrive.commands import headless  # noqa: E402
from graindrive.base.errors import UsageError  # noqa: E402
from graindrive.extremes.outcome import Setting  # noqa: E402
from graindrive.extremes.table import CASES  # noqa: E402
from graindrive.lazily import Lazily  # noqa: E402
from graindrive.parameters import Lever, StudyParameters, When, quantity  # noqa: E402
from graindrive.study import Cost, Observable, Study  # noqa: E402

LONG = "bound_pair"  # the case that uses `pair_steps`
STEP_SECONDS, STRAIN_SECONDS, OTHERS = 6e-7, 0.06, 2.0  # of one core, measured

# Parameters -----------------------------------------------------------------------------------------------------------


class ExtremesParameters(StudyParameters):
    """The parameters of the study of extremes."""

    case: Literal[tuple(CASES)] = quantity("friction_2d", "-", "which extreme")
    pair_steps: int = quantity(
        1_000_000,
        "-",
        "steps of the bound pair",
        ge=100,
        lever=Lever(100_000_000, "lower", 10.0),
        only=When("case", ("bound_pair_2d", "bound_pair_3d")),
    )
    strain: float = quantity(
        100.0,
        "-",
        "total strain of the sheared cell",
        gt=0.1,
        le=1e4,
        lever=Lever(100, "lower"),
        only=When("case", ("shear_strains",)),
    )


PRESETS = {
    "smoke": dict(pair_steps=100_000, strain=2.0),
    "demo": {},
    "paper": dict(pair_steps=100_000_000),
}


def check(p):
    """Refuse a loop or a precision that does not apply to the case, and any dt_factor or seed."""
    case = CASES[p.case]
    for key, words in (("loop", case.loops), ("precision", case.precisions)):
        if getattr(p, key) not in words:
            raise UsageError(
                f"{key}={getattr(p, key)} does not apply to case={p.case} ({case.meaning}); leave {key} out"
            )
    if p.loop == "yade" and p.precision == "single":
        raise UsageError("precision=single exists only in GrainLoop, not with loop=yade; leave one of them out")
    if p.seed != 1:
        raise UsageError(f"seed={p.seed}: the cases have their own random numbers, the same each time; leave seed out")
    if p.dt_factor != 1:
        raise UsageError(
            f"dt_factor={p.dt_factor:g}: every case has its own time step, and its bound holds for that step; leave dt_factor out"
        )


# Run ------------------------------------------------------------------------------------------------------------------


def run(p, folder):
    """Run the case; store its outcome and its trials."""
    check(p)
    found = CASES[p.case].run(Setting(loop=p.loop, precision=p.precision, steps=p.pair_steps, strain=p.strain))
    print(f"extremes: {p.case}: {found.word}; {found.sentence}: {found.measured:.6g}, expected {found.expected:.6g}")
    if found.trials:
        folder.write("trials", {name: (column(values), "-") for name, values in found.trials.items()})
    folder.summarize(
        outcome=found.word,
        meaning=CASES[p.case].meaning,
        measured=(found.measured, "-"),
        expected=(found.expected, "-"),
        bound=(found.tolerance, "-"),
        error_over_bound=found.error_over_bound,
        source=found.source,
        sentence=found.sentence,
    )


def column(values):
    """Return a column of trials as HDF5 holds it: numbers, or words as bytes."""
    return np.array(values, dtype="S" if isinstance(values[0], str) else float)


# Study ----------------------------------------------------------------------------------------------------------------


def core_seconds(p):
    """Return the time of a run on one core [s]."""
    if p.case.startswith(LONG):
        return OTHERS + STEP_SECONDS * p.pair_steps
    return OTHERS + (STRAIN_SECONDS * p.strain if p.case == "shear_strains" else 0)


STUDY = Study(
    name="extremes",
    parameters=ExtremesParameters,
    presets=PRESETS,
    observables=(
        Observable("error_over_bound", "-", "|measured - expected|/bound; above 1 the answer is wrong", headline=True),
        Observable("measured", "-", "the number that the case measures, a ratio or an error"),
        Observable("expected", "-", "the number that the case's source predicts"),
        Observable("bound", "-", "how far apart they may be"),
    ),
    cost=Cost(core_seconds, 1.0, "core-seconds"),
    check=check,
    run=run,
    keeps_frames=False,
    figure=Lazily("graindrive.postproc.extremes.figure", "draw"),
    report=Lazily("graindrive.postproc.extremes.campaign", "REPORT"),
)

if __name__ == "__main__":
    headless.main(STUDY)
