"""The plan of a campaign: from a YAML of values to checked, named runs; nothing is run or written here.

    study: magnus                    # of studies/, or a file beside this one
    report: magnus                   # graindrive.postproc.magnus.campaign; may be left out
    common: {mu: 0.5, width: 100}    # keys of the study, for all runs
    sweeps:                          # each a grid, or a list of grids: lists of values are crossed
      speed: {phi: [0.352, 0.818], v0: [0.5, 1, 2], seed: [1, 2]}
      spin:
        - {phi: 0.352, spin_ratio: [0, 1, 10]}
        - {phi: 0.818, spin_ratio: [0, 10]}
"""

import contextlib
import importlib
import importlib.util
import itertools
import math
from dataclasses import dataclass, field
from pathlib import Path

from .. import headless
from ..command_line import nearest, parse, refuse, require_key
from ..errors import UsageError, one_line
from ..parameters import plain_type
from .plan_file import read_plan_file, shortened

OWN_KEYS = {  # of a study, which a campaign sets itself
    "out": "the campaign names its run folders",
    "resume": "a campaign always resumes",
    "redo": "remove a run folder to have it made again",
}
LONGEST_NAME = 120
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

    `file` is named from the top of the checkout if it lies there; `origin` is the folder from which values name files;
    `report` is "" for none; the runs stand in the order of the YAML.
    """

    name: str
    file: str
    origin: Path
    study: str
    study_file: Path
    report: str
    runs: list


def read_plan(path):
    """Return the checked `Plan` of the campaign file `path`; UsageError names the first thing that is wrong."""
    path = Path(path)
    content = read_plan_file(path)
    study_file = find_study(path, content["study"])
    report = content.get("report") or ""
    check_report(path, report, content["sweeps"])
    study = declared(study_file)
    with contextlib.chdir(path.parent):  # files that values name (an outline) are named from the campaign's file
        runs = planned_runs(path, content, study)
    return Plan(path.stem, named_in_house(path), path.resolve().parent, study.name, study_file, report, runs)


def named_in_house(path):
    """Return the file's name from the top of this checkout; its bare name if it lies elsewhere."""
    top = studies_folder().parent
    return str(path.resolve().relative_to(top)) if path.resolve().is_relative_to(top) else path.name


# ---- study and report ------------------------------------------------------------------------------------------------


def find_study(path, name):
    """Return the file of the study: below studies/ of this checkout, or a .py file named relative to the campaign's."""
    if name.endswith(".py"):
        file = path.parent / name
        if not file.is_file():
            raise UsageError(f"{path}: study={one_line(name)}: there is no file {file}")
        return file.resolve()
    folder = studies_folder()
    known = sorted(p.stem for p in folder.glob("[!_]*.py") if p.stem != "house")
    if name not in known:
        hint = nearest(name, known, "did you mean ", "? ")
        raise UsageError(f"{path}: there is no study '{one_line(name)}'; {hint}there are: {' '.join(known)}")
    return folder / f"{name}.py"


def studies_folder():
    """Return the folder of the studies of this checkout."""
    return Path(headless.__file__).resolve().parents[2] / "studies"


def check_report(path, report, sweeps):
    """Refuse a report that is not there, and sweeps that it would not look at."""
    if not report:
        return
    module = report_module(report)
    if module is None:
        raise UsageError(f"{path}: there is no report '{one_line(report)}': no graindrive.postproc.{report}.campaign")
    for sweep in sweeps:
        if sweep not in module.SWEEPS:
            hint = nearest(sweep, module.SWEEPS, "did you mean ", "? ")
            raise UsageError(
                f"{path}: report {report} knows no sweep '{one_line(sweep)}'; {hint}it uses: {' '.join(module.SWEEPS)}"
            )


def report_module(report):
    """Return the module of the report named `report`; None if there is none."""
    package = f"graindrive.postproc.{report}"
    known = str(report).isidentifier() and importlib.util.find_spec(package)
    inside = known and known.submodule_search_locations and importlib.util.find_spec(f"{package}.campaign")
    return importlib.import_module(f"{package}.campaign") if inside else None


def declared(study_file):
    """Return what the study declares; UsageError if the file is no study."""
    try:
        return headless.declaration_of(study_file)
    except RuntimeError as error:
        raise UsageError(str(error)) from None


# ---- runs ------------------------------------------------------------------------------------------------------------


def planned_runs(path, content, study):
    """Return the `PlannedRun`s of all sweeps, each run once however many sweeps need it."""
    runs, common = {}, content.get("common") or {}
    for sweep, place, grid in grids_of(path, content["sweeps"], common):
        for values in crossed(grid):
            run = planned_run(place, values, study)
            known = runs.setdefault(run.name, run)
            known.sweeps += [] if sweep in known.sweeps else [sweep]
    return list(runs.values())


def grids_of(path, sweeps, common):
    """Return [(sweep, its place in words, {key: list of values})] of all grids, checked for what they hold and how many runs."""
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
    """Return a mapping with each value as a list; UsageError if `grid` is none, or a list is empty."""
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
        p = parse(study.parameters, arguments, study.presets, study=study.name, defaults=study.defaults, environment={})
        study.check(p)
    except UsageError as error:
        raise UsageError(f"{place}: {error}") from None
    return PlannedRun(run_name(p, study), arguments, p)


def argument(parameters, key, value):
    """Return a value of the file as the study's command line takes it; UsageError where it is of another kind than its key."""
    require_key(parameters, key)
    field = parameters.__fields__[key]
    if isinstance(value, (dict, list)):
        raise UsageError(f"{one_line(key)} must be a number, a word or a switch, got {shortened(value)}")
    if value is None or (field.allow_none and value == "auto"):
        return f"{key}=auto"
    if not is_of_kind(plain_type(field), value):
        refuse(field, f"'{value}'" if isinstance(value, str) and is_number(value) else as_written(value))
    return f"{key}={int(value) if isinstance(value, bool) else value}"


def is_of_kind(kind, value):
    """True if a value of the file is what a key of that kind takes: bool, int, float, str, or None for a choice of words."""
    if kind is bool:
        return isinstance(value, (bool, int)) and value in (0, 1)
    if kind in (int, float):
        return isinstance(value, (int, float)) and not isinstance(value, bool)
    return isinstance(value, str)


def is_number(text):
    """True for text that would be a number without its quotes."""
    try:
        return math.isfinite(float(text))
    except ValueError:
        return False


def as_written(value):
    """Return a value as it stands in the file."""
    return str(value).lower() if isinstance(value, bool) else str(value)


def run_name(p, study):
    """Return the name of a run's folder: what differs from the study's own values, and the digest of all.

    It depends on the parameters alone, so a campaign that is extended, or reordered, finds its runs again.
    """
    usual = study.parameters(**{**study.defaults, **study.presets[p.scale], "scale": p.scale}).identity()
    told = [
        f"{key}_{shortly(value)}"
        for key, value in sorted(p.identity().items())
        if key in study.parameters.__fields__ and value != usual.get(key)
    ]
    text = "".join(c if c.isalnum() or c in "-_.+" else "_" for c in "-".join([study.name, *told]))
    return f"{text[: LONGEST_NAME - 13]}-{p.digest()}"


def shortly(value):
    """Return a value for a folder's name: numbers without needless digits, switches as 0 and 1."""
    return f"{value:g}" if isinstance(value, (int, float)) else str(value)
