"""Parameters of a study: each with unit, default, meaning and range, checked before anything is computed or written."""

import hashlib
import json
from dataclasses import dataclass
from typing import ClassVar, Literal, Union

from pydantic import BaseModel, Field, PrivateAttr, validator

EXPORTS = (
    "vtk",
    "xyz",
    "lammps",
    "xyz.gz",
    "lammps.gz",
)  # for ParaView; for OVITO and ASE; for LAMMPS and OVITO; compressed
LIMITS = {"gt": ">", "ge": ">=", "lt": "<", "le": "<="}
LEAST, MOST = 1e-30, 1e30  # sizes of a number: products of a few stay far from what double precision can hold


@dataclass(frozen=True)
class Lever:
    """A parameter that trades accuracy for speed.

    At `reference` a run has the study's full accuracy; None stands for `auto`, the value that the study derives. If the
    parameter is a number, it costs less in the direction `cheaper`, "higher" or "lower", and is tried in steps of `factor`.
    If it is a choice between words, `cheaper` is the tuple of the words that cost less, the most accurate first.
    """

    reference: Union[float, str, None]
    cheaper: Union[str, tuple]
    factor: float = 2.0

    def __post_init__(self):
        words = isinstance(self.reference, str)
        if words and not (isinstance(self.cheaper, tuple) and self.cheaper):
            raise ValueError(
                f"cheaper must be a tuple of words, as reference={self.reference!r} is one; got {self.cheaper!r}"
            )
        if not words and self.cheaper not in ("higher", "lower"):
            raise ValueError(f"cheaper must be 'higher' or 'lower', got {self.cheaper!r}")
        if not self.factor > 1:
            raise ValueError(f"factor must be above 1, got {self.factor:g}")


class Condition:
    """A condition on the values of a run: it says in which runs a parameter has an effect. `a & b`, `a | b` combine two."""

    def __or__(self, other):
        return AnyOf((self, other))

    def __and__(self, other):
        return AllOf((self, other))

    def broken(self, p):
        """Return the part of the condition that the parameters `p` do not meet, None if they meet all."""
        return None if self.holds(p) else self


@dataclass(frozen=True)
class When(Condition):
    """Met where the parameter `key` has one of `values`, or none of `never`; without both, where it is above 0.

    None among the values stands for `auto`. A value that is compared with 0 may be `auto`: then the derived one counts.
    """

    key: str
    values: tuple = ()
    never: tuple = ()

    def holds(self, p):
        """True if the parameters `p` meet the condition."""
        value = getattr(p, self.key)
        if self.values or self.never:
            return value in self.values if self.values else value not in self.never
        return p.taken()[self.key] > 0

    @property
    def rule(self):
        """The condition in words: "model=dem or both"."""
        words = " or ".join(briefly(value) for value in self.values or self.never)
        if self.values:
            return f"{self.key}={words}"
        return f"another {self.key} than {words}" if self.never else f"{self.key} above 0"

    def state(self, p):
        """Return what the parameters `p` have: "model=continuum"."""
        return f"{self.key}={briefly(p.taken()[self.key])}"


@dataclass(frozen=True)
class AnyOf(Condition):
    """Met where one of several conditions is."""

    parts: tuple

    def holds(self, p):
        """True if the parameters `p` meet one of the conditions."""
        return any(part.holds(p) for part in self.parts)

    @property
    def rule(self):
        """The conditions in words: "model=continuum or both, or with grains=auto"."""
        return ", or with ".join(part.rule for part in self.parts)

    def state(self, p):
        """Return what the parameters `p` have for each of the conditions."""
        return " and ".join(part.state(p) for part in self.parts)


@dataclass(frozen=True)
class AllOf(Condition):
    """Met where all of several conditions are."""

    parts: tuple

    def broken(self, p):
        """Return the first part that the parameters `p` do not meet, None if they meet all."""
        return next((broken for part in self.parts if (broken := part.broken(p))), None)

    def holds(self, p):
        """True if the parameters `p` meet all conditions."""
        return self.broken(p) is None

    @property
    def rule(self):
        """The conditions in words: "model=dem or both, and with loop=grain"."""
        return ", and with ".join(part.rule for part in self.parts)


def briefly(value):
    """Return a value as the user would type it, a number without superfluous digits."""
    return f"{value:g}" if isinstance(value, float) else as_typed(value)


def as_typed(value):
    """Return a value as the user would type it."""
    if value is None:
        return "auto"
    return str(int(value)) if isinstance(value, bool) else str(value)


def quantity(default, unit, meaning, *, identity=True, lever=None, watches=False, only=None, **limits):
    """Declare one parameter of a study.

    `unit` is text ("d", "sqrt(d/g)", "-" for a pure number), `meaning` one line for the help table, `limits` any of
    gt, ge, lt, le. `identity=False` marks a key that changes how a run is made but not its result: such keys
    are ignored when runs are compared. `lever` is the parameter's `Lever`, if it is one. `watches=True` marks a key that only
    decides what a run records or when it is stopped (frames, fields, guards) and does not change the motion. `only` is the
    `Condition` under which the parameter has an effect: in other runs a value given by the user is refused.
    """
    if set(limits) - set(LIMITS):
        raise TypeError(f"limits are {', '.join(LIMITS)}, got {', '.join(limits)}")
    about = dict(unit=unit, identity=identity, lever=lever, watches=watches, only=only)
    return Field(default, description=meaning, **about, **limits)


class StudyParameters(BaseModel):
    """The parameters of every study; a study derives its own class from this one and adds its fields with `quantity`.

    A parameter is a number (0, or of a size between 1e-30 and 1e30), a word or a switch; conditions between parameters are
    pydantic root validators whose ValueError is one plain sentence. If the value None is allowed, it means `auto`: the study
    derives the value from the others, in `auto_values`.
    """

    _choice = PrivateAttr(None)  # what `accuracy` took, a `tuning.choice.Choice`
    _given_in_vain = PrivateAttr({})  # {key: `Condition` not met} of keys that the user gave

    unit_system: ClassVar[str] = ""  # of postproc.quantities, SI or GRAIN; empty where a study has units of its own
    only: ClassVar[
        dict
    ] = {}  # {key of the class above: `Condition`}, further conditions of parameters that a study inherits

    scale: Literal["smoke", "demo", "paper"] = quantity(
        "demo", "-", "size of the run: under 30 s; 1-3 minutes; the paper's own", identity=False
    )
    seed: int = quantity(1, "-", "seed of everything random", ge=0, le=2**31 - 1)
    loop: Literal["grain", "yade"] = quantity("grain", "-", "time loop: GrainLoop, or YADE's own loop as the reference")
    precision: Literal["double", "single"] = quantity(
        "double",
        "-",
        "number type of contact forces in GrainLoop",
        lever=Lever("double", ("single",)),
        only=When("loop", ("grain",)),
    )
    dt_factor: float = quantity(
        1.0, "-", "time step, as a multiple of the study's own choice", gt=0, lever=Lever(1.0, "higher")
    )
    accuracy: str = quantity(
        "",
        "-",
        "use the cheapest levers whose measured error is below this: 5%, or NAME:5% for another observable",
        identity=False,
    )
    out: str = quantity("", "-", "run folder to write; empty: named after the study and the keys given", identity=False)
    resume: bool = quantity(False, "-", "continue an interrupted run of the same parameters", identity=False)
    checkpoint_seconds: float = quantity(
        60.0, "s", "wall time between two checkpoints; 0: after every block of steps", identity=False, ge=0
    )
    redo: bool = quantity(False, "-", "run again even if the run folder exists already", identity=False)
    vtk: bool = quantity(False, "-", "also write files for ParaView, like export=vtk", identity=False)
    export: str = quantity(
        "", "-", f"also write files for other programs: a comma list of {', '.join(EXPORTS)}", identity=False
    )
    film: bool = quantity(False, "-", "also film the run's frames, as animation.mp4; frames=200 or so", identity=False)
    unused: Literal["refuse", "allow"] = quantity(
        "refuse", "-", "keys given that this run does not use: refuse them, or name them and go on", identity=False
    )

    class Config:
        extra = "forbid"
        validate_all = True
        allow_mutation = False

    @validator("*", pre=True)
    def _whole(cls, value, field):
        if plain_type(field) is int and isinstance(value, float) and not value.is_integer():
            raise ValueError("not whole")
        return value

    @validator("*")
    def _sized(cls, value):
        return sized(value) if isinstance(value, float) else value

    @validator("export")
    def _known_formats(cls, value):
        known_formats(value)
        return value

    @property
    def exports(self):
        """Formats of EXPORTS in which the run's frames are written."""
        return known_formats(self.export + ",vtk" * self.vtk)

    @classmethod
    def unit(cls, key):
        """Return the unit of parameter `key` as text."""
        return cls.__fields__[key].field_info.extra.get("unit", "-")

    @classmethod
    def levers(cls):
        """Return {key: `Lever`} of the parameters that trade accuracy for speed."""
        found = {key: field.field_info.extra.get("lever") for key, field in cls.__fields__.items()}
        return {key: lever for key, lever in found.items() if lever is not None}

    @property
    def choice(self):
        """The levers that the key accuracy chose, a `tuning.choice.Choice`; None without that key."""
        return self._choice

    @classmethod
    def watching(cls):
        """Return the keys that only decide what a run records or when it is stopped."""
        return {key for key, field in cls.__fields__.items() if field.field_info.extra.get("watches")}

    @property
    def given_in_vain(self):
        """{key: the `Condition` that is not met} of keys that the user gave, but that this run does not use."""
        return self._given_in_vain

    @classmethod
    def condition(cls, key):
        """Return the `Condition` under which a parameter has an effect; None for one that every run uses."""
        parts = [part for part in (cls.only.get(key), cls.__fields__[key].field_info.extra.get("only")) if part]
        return AllOf(tuple(parts)) if len(parts) > 1 else next(iter(parts), None)

    def not_used(self):
        """Return {key: the `Condition` that is not met} of the parameters that this run does not use."""
        found = {key: self.condition(key) for key in self.__fields__}
        broken = {key: condition.broken(self) for key, condition in found.items() if condition}
        return {key: condition for key, condition in broken.items() if condition}

    def auto_values(self):
        """Return {key: value to use} for the keys that are `auto`; a study that has such keys overrides this."""
        return {}

    def taken(self):
        """Return the dict of all parameters, with the derived values in place of `auto`."""
        return {**self.dict(), **self.auto_values()}

    def identity(self):
        """Return the dict of all parameters that decide the result: two runs are the same if these dicts are equal.

        It holds the derived values in place of `auto`, so a run is the same whether such a value was given or derived.
        """
        return {
            key: value
            for key, value in self.taken().items()
            if self.__fields__[key].field_info.extra.get("identity", True)
        }

    def digest(self):
        """Return 12 hexadecimal characters, a digest of `identity()`."""
        return digest(self.identity())


def sized(number):
    """Return a float, a zero without its sign; ValueError if its size is neither 0 nor from 1e-30 to 1e30."""
    if not (number == 0 or LEAST <= abs(number) <= MOST):
        raise ValueError(
            f"the size of a number must be 0 or lie between {LEAST:g} and {MOST:g}; mind the unit of its key"
        )
    return number + 0.0


def known_formats(text):
    """Return the formats that a comma list names, a tuple in the order of EXPORTS; ValueError for an unknown one."""
    names = [name.strip() for name in text.split(",") if name.strip()]
    for name in names:
        if name not in EXPORTS:
            raise ValueError(f"export is a comma list of {', '.join(EXPORTS)}, got {name!r}")
    return tuple(name for name in EXPORTS if name in names)


def plain_type(field):
    """Return bool, int, float or str for a pydantic `ModelField`; None if it is a choice between words."""
    if not isinstance(field.type_, type):
        return None
    return next(kind for kind in (bool, int, float, str) if issubclass(field.type_, kind))


def choices(field):
    """Return the tuple of words that a pydantic `ModelField` takes; empty if it is not a choice."""
    return getattr(field.type_, "__args__", ())


def digest(values):
    """Return 12 hexadecimal characters, a digest of a dict of plain values (the order of keys does not matter)."""
    text = json.dumps(values, sort_keys=True, default=repr, allow_nan=False)
    return hashlib.sha256(text.encode()).hexdigest()[:12]


def allowed(field):
    """Return a description of the allowed values of a parameter, from its pydantic `ModelField`: "a number > 0 [d]"."""
    if choices(field):
        return "one of " + ", ".join(map(str, choices(field)))
    info = field.field_info
    kind = {bool: "0 or 1", int: "a whole number", float: "a number", str: "text"}[plain_type(field)]
    bounds = [f"{sign} {getattr(info, name)}" for name, sign in LIMITS.items() if getattr(info, name) is not None]
    unit = info.extra.get("unit", "-")
    words = [kind, " and ".join(bounds), f"[{unit}]" if unit != "-" else "", "or auto" if field.allow_none else ""]
    return " ".join(word for word in words if word)
