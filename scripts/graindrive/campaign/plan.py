"""The plan of a campaign: turns a YAML file of values into checked, named runs; this module runs and writes nothing.

    study: magnus                    # of studies/, or a file beside this one
    report: magnus                   # the study's report; may be left out
    common: {mu: 0.5, width: 100}    # keys of the study, for all runs
    sweeps:                          # each a grid, or a list of grids: lists of values are crossed
      speed: {phi: [0.352, 0.818], v0: [0.5, 1, 2], seed: [1, 2]}
      spin:
        - {phi: 0.352, spin_ratio: [0, 1, 10]}
        - {phi: 0.818, spin_ratio: [0, 10]}
"""

import contextlib
import itertools
import math
from dataclasses import dataclass, field
from pathlib import Path

from ..commands import headless
from ..commands.command_line import parse
from ..base.errors import UsageError, one_line
from ..commands.naming import readable
from ..commands.parameter_values import argument, nearest
from ..commands.started import study_file
from ..parameters import StudyParameters
from ..base.plain_yaml import shortened
from ..study import loaded
from .plan_file import read_plan_file

OWN_KEYS = {  # keys of a study that only the campaign sets, with the reason
    "out": "the campaign names its run folders",
    "resume": "a campaign always resumes",
    "redo": "remove a run folder to have it made again",
    "unused": "a campaign refuses keys that none of its runs uses",
}
ALLOW_UNUSED = ["unused=allow"]  # a key may stand beside several models of which one uses it
MOST_RUNS = 100_000


@dataclass
class PlannedRun:
    """One run: its folder's `name`, the study's `arguments` (key=value), its `parameters` and the sweeps it is for."""

    name: str
    arguments: list
    parameters: object
    sweeps: list = field(default_factory=list)


@dataclass(frozen=True)
class Plan:
    """A campaign.

    `file` is the path from the top of the checkout if it lies there; files that values name are relative to the folder `origin`;
    `study` is a `Study` and `report` its `Report`, None if no report is asked for; the runs are in the order of the YAML file.
    """

    name: str
    file: str
    origin: Path
    study: object
    study_file: Path
    report: object
    runs: list


def read_plan(path):
    """Return the checked `Plan` of the campaign file `path`; UsageError names the first mistake."""
    path = Path(path)
    content = read_plan_file(path)
    study_file = find_study(path, content["study"])
    study = loaded_for(path, study_file)
    report = report_of(path, study, content.get("report") or "", content["sweeps"])
    with contextlib.chdir(path.parent):  # file names in values (an outline) are relative to the campaign's file
        runs = planned_runs(path, content, study)
    return Plan(path.stem, named_in_house(path), path.resolve().parent, study, study_file, report, runs)


def named_in_house(path):
    """Return the file's name from the top of this checkout; its bare name if it lies elsewhere."""
    top = Path(__file__).resolve().parents[3]
    return str(path.resolve().relative_to(top)) if path.resolve().is_relative_to(top) else path.name


# ---- study and report ------------------------------------------------------------------------------------------------


def find_study(path, name):
    """Return the file of the study: below studies/ of this checkout, or a .py file named relative to the campaign's."""
    try:
        with contextlib.chdir(path.parent):
            return study_file(name)
    except UsageError as error:
        raise UsageError(f"{path}: {error}") from None


def loaded_for(path, study_file):
    """Return the `Study` of a file; UsageError in the name of the campaign's file if it makes none."""
    try:
        return loaded(study_file)
    except UsageError as error:
        raise UsageError(f"{path}: {error}") from None


def report_of(path, study, name, sweeps):
    """Return the study's `Report` of that name, None for no name; refuse unknown reports, and sweeps that the report ignores."""
    report = study.report
    if not name:
        return None
    if report is None or name != report.name:
        has = f"has {report.name}" if report else "has none"
        raise UsageError(f"{path}: there is no report '{one_line(name)}': study {study.name} {has}")
    for sweep in sweeps:
        if sweep not in report.sweeps:
            hint = nearest(sweep, report.sweeps, "did you mean ", "? ")
            raise UsageError(
                f"{path}: report {name} knows no sweep '{one_line(sweep)}'; {hint}it uses: {' '.join(report.sweeps)}"
            )
    return report


# ---- runs ------------------------------------------------------------------------------------------------------------


def planned_runs(path, content, study):
    """Return the `PlannedRun`s of all sweeps, each run once however many sweeps need it."""
    runs, common, used = {}, content.get("common") or {}, set()
    for sweep, place, grid in grids_of(path, content["sweeps"], common):
        here = set()
        for values in crossed(grid):
            run = planned_run(place, values, study)
            refuse_repeats(place, grid, run.parameters)
            here |= set(values) - set(run.parameters.given_in_vain)
            known = runs.setdefault(run.name, run)
            if known.parameters.identity() != run.parameters.identity():
                raise UsageError(
                    f"{place}: two different runs got the same name {run.name}; give one of them another seed"
                )
            known.sweeps += [] if sweep in known.sweeps else [sweep]
        refuse_unused(place, [key for key in grid if key not in common and key not in here], run.parameters)
        used |= here
    refuse_unused(f"{path}: common", [key for key in common if key not in used], run.parameters)
    return list(runs.values())


def refuse_unused(place, keys, p):
    """Raise UsageError for the first of `keys` that no run uses; `p` are the parameters of one of the runs."""
    for key in keys:
        broken = p.given_in_vain[key]
        raise UsageError(
            f"{place}: {key} has no effect in any run: it is used only with {broken.rule}, and the runs have"
            f" {broken.state(p)}; leave it out"
        )


def refuse_repeats(place, grid, p):
    """Raise UsageError if a key has several values in a grid, but a run of it with the parameters `p` does not use the key.

    There would be several such runs with one result. A single value may stand beside several models, of which one uses it.
    """
    for key, broken in p.given_in_vain.items():
        if len(grid.get(key, ())) > 1:
            raise UsageError(
                f"{place}: {key} has {len(grid[key])} values, but its runs with {broken.state(p)} do not use it and would be the"
                f" same; give them a grid of their own ({key} needs {broken.rule})"
            )


def grids_of(path, sweeps, common):
    """Return [(sweep, its place for messages, {key: list of values})] of all grids, with checked content and number of runs."""
    found = []
    for sweep, grids in sweeps.items():
        place = f"{path}: sweep {one_line(sweep)}"
        if grids == []:
            raise UsageError(f"{place} has no grid; give keys with values")
        for grid in grids if isinstance(grids, list) else [grids]:
            found.append((sweep, place, {**lists_of(place, common), **lists_of(place, grid)}))
            if not grid:
                raise UsageError(f"{place} has an empty grid; give at least one key with a value")
            if sum(math.prod(map(len, axes.values())) for *_, axes in found) > MOST_RUNS:  # parsing takes minutes
                raise UsageError(f"{place} makes more than {MOST_RUNS} runs; give fewer values")
    return found


def lists_of(place, grid):
    """Return a mapping with each value as a list; UsageError if `grid` is no mapping, or a list is empty."""
    if not isinstance(grid, dict):
        raise UsageError(f"{place} must be keys with values or lists of values, got {shortened(grid)}")
    for key, values in grid.items():
        if values == []:
            raise UsageError(f"{place}: {one_line(key)} has no values; give at least one")
    return {key: value if isinstance(value, list) else [value] for key, value in grid.items()}


def crossed(axes):
    """Yield a dict of single values for each combination of the lists in `axes`."""
    for combination in itertools.product(*axes.values()):
        yield dict(zip(axes, combination))


def planned_run(place, values, study):
    """Return the `PlannedRun` for a dict of single values, checked by the study's class of parameters and its own check."""
    for key, reason in OWN_KEYS.items():
        if key in values:
            raise UsageError(f"{place}: {key} is not for campaigns: {reason}; leave it out")
    try:
        arguments = [argument(study.parameters, key, value) for key, value in values.items()]
        p = parse(study, [*arguments, *ALLOW_UNUSED], environment={})
        study.check(p)
        if p.film:
            headless.films().require_possible(study, p)
    except UsageError as error:
        raise UsageError(f"{place}: {error}") from None
    arguments += ALLOW_UNUSED if p.given_in_vain else []
    return PlannedRun(run_name(p, study), arguments, p)


def run_name(p, study):
    """Return the name of a run's folder: the values that differ from the study's defaults, and the digest of all values.

    It depends only on the parameters, so an extended or reordered campaign finds its runs again. Keys that do not change the
    motion (`watches`) are in the digest, but not in the text; keys of the study come first, keys of every study last.
    """
    usual, identity = study.usual(p.scale).identity(), p.identity()
    keys = [key for key in study.parameters.__fields__ if key in identity and key not in p.watching()]
    keys.sort(key=lambda key: key in StudyParameters.__fields__)
    told = [(key, shortly(identity[key])) for key in keys if identity[key] != usual.get(key)]
    return readable(study.name, told, p.digest())


def shortly(value):
    """Return a value for a folder's name: numbers without superfluous digits, switches as 0 and 1."""
    return f"{value:g}" if isinstance(value, (int, float)) else str(value)
