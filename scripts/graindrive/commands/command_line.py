"""Turns `key=value` arguments and rows of YADE's batch tables into checked parameters, or into a one-line error."""

import os
import sys
from pathlib import Path

from pydantic import ValidationError

from ..accuracy import choice
from ..accuracy.told import measured_trade
from ..accuracy.words import shown
from ..base.columns import aligned
from ..base.errors import UsageError, one_line
from ..parameters import allowed, as_typed, choices, digest, plain_type
from ..study import house
from .batch_table import evaluated, read_row
from .naming import LONGEST, readable
from .parameter_values import argument_text, arguments_of, convert, nearest, refuse, require_key

HELP_WORDS = ("help", "--help", "-h", "-help")


def parameters_or_exit(study, arguments, environment=None):
    """Return the parameters of a `Study` for `key=value` arguments (without the script's name), or end the program.

    Sources of values, the strongest first: the command line and the row of YADE's batch table, a file of parameters (an
    argument @FILE), the levers that `accuracy` chooses, the values of the scale, the defaults of a preset study. `help` prints
    all keys and exits with code 0; a bad argument prints one line on stderr and exits with code 2. A key that is given on the
    command line or in the table, but that the run does not use, is a bad argument unless unused=allow; one of a file is not.
    """
    if any(argument in HELP_WORDS for argument in arguments):
        print(help_text(study))
        sys.exit(0)
    try:
        return parse(study, arguments, environment)
    except UsageError as error:
        print(f"{study.name}: error: {error}", file=sys.stderr)
        sys.exit(UsageError.exit_code)


def parse(study, arguments, environment=None):
    """Return the parameters of a `Study` for these arguments; raises UsageError for the first wrong one."""
    cls = study.parameters
    files = [argument[1:] for argument in arguments if argument.startswith("@")]
    given = from_batch_row(cls, os.environ if environment is None else environment)
    given = added(cls, given, [argument for argument in arguments if not argument.startswith("@")])
    typed = tuple(given)
    given = {**added(cls, {}, [a for file in files for a in arguments_of(Path(file), cls)]), **given}
    values = {key: convert(cls.__fields__[key], text) for key, text in given.items()}
    base = dict(study.defaults)
    scale = values.get("scale", base.get("scale", cls.__fields__["scale"].default))
    if scale not in study.presets:
        raise UsageError(
            f"{argument_text('scale', scale)} is not known to {study.name}; allowed: {', '.join(study.presets)}"
        )
    merged = {**base, **study.presets[scale], **values, "scale": scale}
    taken = choice_by_accuracy(study, merged, values, given) if merged.get("accuracy") else None
    merged.update(taken.levers if taken else {})
    if not merged.get("out"):
        merged["out"] = folder_name(
            study.name, scale, {k: v for k, v in given.items() if k not in ("scale", "out")}, cls
        )
    p = build(cls, merged, given)
    p._choice = taken
    p._given_in_vain = given_in_vain(p, given, typed)
    refuse_exports(study, p)
    return p


def refuse_exports(study, p):
    """Raise UsageError if the run is to export pictures of grains, of which the study keeps none."""
    if p.exports and not study.keeps_frames:
        asked = f"export={p.export}" if p.export else "vtk=1"
        raise UsageError(
            f"{asked} needs pictures of grains, and runs of {study.name} keep none; leave it out (run.h5 holds what was measured)"
        )


def given_in_vain(p, given, typed):
    """Return {key: its `Condition` that is not met} of the keys given that a run does not use.

    UsageError names the first of those `typed` by the user, unless unused=allow. A file of parameters may serve several runs
    that use different keys of it; its keys are only told.
    """
    found = {key: condition for key, condition in p.not_used().items() if key in given}
    for key, condition in found.items():
        if key in typed and p.unused == "refuse":
            raise UsageError(
                f"{argument_text(key, given[key])} has no effect: {key} is used only with {condition.rule}, and this run has"
                f" {condition.state(p)}; leave {key} out, or give unused=allow"
            )
    return found


def added(cls, given, arguments):
    """Return `given` ({key: text}) with further `key=value` arguments; UsageError for a key that is given twice."""
    given = dict(given)
    for argument in arguments:
        key, text = split(cls, argument)
        if key in given:
            raise UsageError(
                f"{key} is given twice: {key}={one_line(given[key])} and {argument_text(key, text)}; keep one"
            )
        given[key] = text
    return given


def choice_by_accuracy(study, merged, values, given):
    """Return the `Choice` of levers for the key accuracy; it leaves out levers that the user gave."""
    kept = {key: value for key, value in values.items() if key in study.levers}
    usual = {**merged, "out": merged.get("out") or "."}

    def made(levers):
        return build(study.parameters, {**usual, **levers, **kept}, given)

    return choice.chosen(study, merged["accuracy"], made, kept)


def from_batch_row(cls, environment):
    """Return {key: text} of the row of the batch table that `environment` names."""
    given = {}
    for heading, text in read_row(environment).items():
        key, _ = split(cls, f"{heading}=")
        given[key] = evaluated(text) if plain_type(cls.__fields__[key]) in (int, float) else text
    return given


def split(cls, argument):
    """Return (key, text) of one `key=value` argument; UsageError suggests the nearest correct spelling."""
    key, sign, text = argument.partition("=")
    key = key.strip()
    bare = key.lstrip("-").replace("-", "_")
    if not sign:
        owner = next((k for k, f in cls.__fields__.items() if bare in choices(f)), None)
        hint = f"{owner}={bare}" if owner else nearest(bare, cls.__fields__, "", "=…")
        way_out = f"did you mean {hint}?" if hint else "help lists the keys"
        raise UsageError(f"'{one_line(argument)}' is not of the form key=value; {way_out}")
    require_key(cls, key)
    return key, text.strip()


def build(cls, merged, given):
    """Return `cls(**merged)`; UsageError for the first value out of range, or for a violated condition between values."""
    try:
        return cls(**merged)
    except ValidationError as error:
        first = error.errors()[0]
        key = first["loc"][0]
        if key in cls.__fields__ and first["type"] != "value_error":
            refuse(cls.__fields__[key], given.get(key, merged.get(key)))
        prefix = f"{argument_text(key, given.get(key, merged.get(key)))}: " if key in cls.__fields__ else ""
        raise UsageError(prefix + one_line(first["msg"], 400)) from None


def folder_name(study, scale, given, cls):
    """Return the default run folder: the study, its scale and the keys given, in the order of help."""
    kept = {
        k: v for k, v in given.items() if k == "accuracy" or cls.__fields__[k].field_info.extra.get("identity", True)
    }
    told = sorted(kept.items(), key=lambda item: list(cls.__fields__).index(item[0]))
    whole = f"{study}-{scale}" + "".join(f"-{key}={value}" for key, value in told)
    return readable(f"{study}-{scale}", told, digest(kept) if len(whole) > LONGEST else "")


def help_text(study):
    """Return the help text of a `Study`: its keys, then its levers, its observables and its cost."""
    parts = [f"usage: {called(study)} [key=value …]", help_table(study)]
    return "\n\n".join(
        part
        for part in [*parts, levers_in_words(study), observables_in_words(study), costs(study), measured_trade(study)]
        if part
    )


def called(study, environment=None):
    """Return how the user calls a study: by the command that started it, else in the two ways that there are.

    `scripts/run` and `graindrive run` leave their name and the study's in $GRAINDRIVE_CALLED.
    """
    own = (os.environ if environment is None else environment).get("GRAINDRIVE_CALLED", "")
    file = next((word for word in sys.argv[:1] if Path(word).stem == study.name), f"{study.name}.py")
    name = study.name if study.name in house() else file
    return one_line(own, 200) or f"scripts/run {name} [key=value …]   or   yade -n -x {file}"


def help_table(study):
    """Return the table of keys: key, unit, default (and values of scales), meaning and allowed values."""
    cls, presets, defaults = study.parameters, study.presets, study.defaults
    rows = [("key", "unit", "default", "meaning")]
    runs = {scale: study.usual(scale) for scale in presets}

    def default_of(key):
        usual = as_typed(defaults.get(key, cls.__fields__[key].default))
        found = {
            scale: taken_text(runs[scale], key) or as_typed(values.get(key, usual)) for scale, values in presets.items()
        }
        changed = [f"{scale}: {text}" for scale, text in found.items() if key in presets[scale] or text != usual]
        return ", ".join(changed) if len(changed) == len(presets) else ", ".join([usual] + changed)

    for key, field in cls.__fields__.items():
        condition = cls.condition(key)
        rule = f"{allowed(field)}; only with {condition.rule}" if condition else allowed(field)
        rows.append((key, cls.unit(key), default_of(key), f"{field.field_info.description} ({rule})"))
    return aligned(rows)


def levers_in_words(study):
    """Return the paragraph of help on the parameters that trade accuracy for speed."""
    unit = study.parameters.unit
    rows = [
        (
            f"  {key}",
            f"{shown(lever.reference)} {unit(key)}".removesuffix(" -"),
            lever.cheaper if isinstance(lever.cheaper, str) else ", ".join(lever.cheaper),
        )
        for key, lever in study.levers.items()
    ]
    return aligned([("levers", "most accurate", "costs less when"), *rows]) if rows else ""


def observables_in_words(study):
    """Return the paragraph of help on the study's observables; a star marks the headline."""
    rows = [(f"{'*' if o.headline else ' '} {o.name}", o.unit, o.meaning) for o in study.observables]
    return aligned([("observables of summary.json (* the headline)", "unit", "meaning"), *rows]) if rows else ""


def costs(study):
    """Return the line of help on the cost of a run of each scale."""
    if study.cost is None:
        return ""
    words = [f"{scale} {study.cost.in_words(study.usual(scale))}" for scale in study.presets]
    return f"cost on one core, without the packing: {'; '.join(words)}"


def taken_text(p, key):
    """Return the derived value of a key that is `auto` as "auto (46.2)"; "" for any other key."""
    taken = p.taken()[key]
    return f"auto ({as_typed(taken)})" if getattr(p, key) is None and taken is not None else ""
