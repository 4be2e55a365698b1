"""A study as one object: its parameters, observables and cost, its functions to run and to draw it, and the papers' claims.

A study file makes one, named STUDY, and passes it to `headless.main`; `loaded` returns it without running the study.
"""

import contextlib
import dataclasses
import importlib.util
import io
import math
import sys
import threading
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Optional, Union

from .base.errors import UsageError
from .parameters import StudyParameters
from .postproc import quantities

LOADING = threading.RLock()  # held while a study is loaded, which may load another
NAME = "STUDY"  # name of the object in a study file
NO_STUDIES = ("house",)  # files in the folder of the studies that are not studies


@dataclass(frozen=True)
class Observable:
    """A quantity of summary.json that the study measures; one of them is the `headline`."""

    name: str
    unit: str
    meaning: str
    headline: bool = False


@dataclass(frozen=True)
class Constant:
    """A number that the study fixes: every run folder holds it with its unit and its meaning."""

    value: float
    unit: str
    meaning: str


@dataclass(frozen=True)
class Cost:
    """The cost of a run without the packing: `work(p)` [`unit`]; one core does `rate` of it per second, a number or `rate(p)`."""

    work: Callable
    rate: Union[float, Callable]
    unit: str = "particle-steps"

    def core_seconds(self, p):
        """Return the seconds that a run of the parameters `p` takes one core."""
        return float(self.work(p) / (self.rate(p) if callable(self.rate) else self.rate))

    def in_words(self, p):
        """Return the work of a run and its time on one core: "7.9e+08 particle-steps, 9 s"."""
        return f"{self.work(p):.2g} {self.unit}, {duration(self.core_seconds(p))}"


def nothing_to_check(_p):
    """Accept all values: the parameters of the study have no conditions between them."""


@dataclass(frozen=True)
class Study:
    """A study; raises ValueError if its parts are inconsistent, and says which part and why.

    `run(p, folder)` does the work with checked parameters `p`, an instance of `parameters`, and an open `RunFolder`.
    `presets` maps scales to the values that they change, `defaults` are the values of a preset study. `check(p)` raises
    UsageError for values that cannot be combined, before anything runs. `observables` are the quantities that the study
    measures, `cost` is the cost of a run. `figure(path, frame=-1)` draws a finished run folder, `film(path)` makes a film of it.
    `report` (a `postproc.campaign.planned.Report`) holds the claims of papers, and the figures with which campaigns test them.
    `constants`, {name: Constant}, are written into every run folder. `family` is the name of the study of which this one is a
    preset; without one it is the study's own name. `keeps_frames=False` says that runs keep no pictures of grains: they refuse
    `export=`.
    """

    name: str
    parameters: type
    presets: dict
    run: Callable
    observables: tuple = ()
    cost: Optional[Cost] = None
    check: Callable = nothing_to_check
    figure: Optional[Callable] = None
    film: Optional[Callable] = None
    report: Any = None
    constants: dict = field(default_factory=dict)
    defaults: dict = field(default_factory=dict)
    family: str = ""
    keeps_frames: bool = True

    def __post_init__(self):
        object.__setattr__(self, "family", self.family or self.name)
        self.check_keys()
        names = [observable.name for observable in self.observables]
        headlines = [observable.name for observable in self.observables if observable.headline]
        if len(set(names)) < len(names):
            raise ValueError(f"study {self.name}: observables must have different names, got {', '.join(names)}")
        if names and len(headlines) != 1:
            raise ValueError(
                f"study {self.name}: one observable must be the headline, got {', '.join(headlines) or 'none'}"
            )

    def check_keys(self):
        """Raise ValueError if presets or defaults name keys that the class of parameters does not have."""
        if not (isinstance(self.parameters, type) and issubclass(self.parameters, StudyParameters)):
            raise ValueError(f"study {self.name}: parameters must be a class derived from StudyParameters")
        if not self.presets:
            raise ValueError(f"study {self.name}: presets must name at least one scale")
        for part, values in {**self.presets, "defaults": self.defaults}.items():
            unknown = sorted(set(values) - set(self.parameters.__fields__))
            if unknown:
                raise ValueError(
                    f"study {self.name}: {part} sets {', '.join(unknown)}, which are not keys of the study"
                )

    @property
    def headline(self):
        """The main `Observable` of the study; None for a study without observables."""
        return next((observable for observable in self.observables if observable.headline), None)

    @property
    def levers(self):
        """{key: Lever} of the parameters that trade accuracy for speed."""
        return self.parameters.levers()

    def preset(self, name, **defaults):
        """Return the same study under another name, with other default values, which a user may still change."""
        return dataclasses.replace(self, name=name, defaults={**self.defaults, **defaults})

    def usual(self, scale):
        """Return the default parameters of a run of that scale."""
        return self.parameters(**{**self.defaults, **self.presets[scale], "scale": scale})


def observables(system, headline, names, **meanings):
    """Return the `Observable`s of names, separated by spaces, with units and meanings from `postproc.quantities`.

    `meanings`, {name: text}, are what quantities mean in this study that other studies have, too.
    """
    known = quantities.QUANTITIES["summary"]
    units = {name: quantities.unit_of("summary", name, system) or "" for name in names.split()}
    if unknown := sorted(set(meanings) - set(units)):
        raise ValueError(f"meanings of {', '.join(unknown)}, which are no names of observables")
    told = {name: meanings.get(name, known[name].meaning) for name in units}
    return tuple(Observable(name, unit, told[name], name == headline) for name, unit in units.items())


def loaded(path):
    """Return the `Study` that the file `path` defines, without running it; UsageError if it defines none.

    The file is imported under a name other than `__main__`, and can import modules of its own folder.
    """
    with LOADING:
        return loaded_alone(Path(path).resolve())


def loaded_alone(path):
    """Load a study as `loaded` does; sys.path and sys.stdout are the whole process's, so one thread at a time may."""
    spec = importlib.util.spec_from_file_location(f"study_{path.stem}", path)
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module  # where pydantic looks up the types that a class of parameters names
    sys.path.insert(0, str(path.parent))
    try:
        with contextlib.redirect_stdout(io.StringIO()):  # YADE's greeting
            spec.loader.exec_module(module)
    finally:
        sys.path.remove(str(path.parent))
    study = getattr(module, NAME, None)
    if not isinstance(study, Study):
        raise UsageError(f"{path} defines no {NAME}, so it is not a study; see studies/guides/study.md")
    return study


def house():
    """Return {name: file} of the studies of this checkout, sorted; empty where the package is installed without them."""
    folder = Path(__file__).resolve().parents[2] / "studies"
    return {path.stem: path for path in sorted(folder.glob("[!_]*.py")) if path.stem not in NO_STUDIES}


def duration(seconds):
    """Return a duration in words: "40 s", "12 min", "3.5 h", "12 days"."""
    for unit, size in (("days", 86400), ("h", 3600), ("min", 60)):
        if seconds >= 2 * size:
            number = seconds / size
            return f"{number:.1f} {unit}" if number < 10 else f"{number:.0f} {unit}"
    return f"{math.ceil(seconds)} s"
