"""Measured settings of a study: written by a tuning, shipped in `studies/data`, and read by whoever asks for an accuracy.

A book is a JSON file: `study`, `command`, `code_version`, `cpu`; `reference` {lever: value}; `same` {key: value} and `cover`
{key: [lowest, highest] or words} of the scenes that were measured; `scenes`, the keys that were given for each; `settings`,
each with its `levers` {lever: value} where they differ from the reference, `cost_factor` of measured over estimated processor
time, `core_seconds` and `memory` [MB] of a run on average, `runs`, and `effects` {observable: Effect}.
"""

import dataclasses
import functools
import json
import math
from dataclasses import dataclass
from pathlib import Path

from ..base import whole_files
from ..base.errors import UsageError, one_line
from .effects import Effect

FOLDER = Path(__file__).resolve().parents[3] / "studies" / "data"
RUN_KEYS = ("seed", "accuracy")  # which say nothing of the scene


@dataclass(frozen=True)
class Setting:
    """One measured setting of a book."""

    levers: dict
    effects: dict
    cost_factor: float
    core_seconds: float
    memory: float
    runs: int


@dataclass(frozen=True)
class Book:
    """Measured settings of one study over the scenes of `same` and `cover`."""

    study: str
    command: str
    code_version: str
    cpu: str
    reference: dict
    same: dict
    cover: dict
    scenes: list
    settings: tuple
    file: str = ""

    def outside(self, p):
        """Return in words the first key by which parameters, with this book's reference, lie outside its scenes; "" inside."""
        values = scene_of(p, self.reference)
        for key, value in self.same.items():
            if not alike(values.get(key), value):
                return f"{key}={values.get(key)}, measured at {value}"
        for key, allowed in self.cover.items():
            value = values.get(key)
            if all(isinstance(a, (int, float)) for a in allowed):
                if value is None or not allowed[0] * (1 - 1e-9) <= value <= allowed[1] * (1 + 1e-9):
                    return f"{key}={value}, measured from {allowed[0]:g} to {allowed[1]:g}"
            elif value not in allowed:
                return f"{key}={value}, measured for {', '.join(map(str, allowed))}"
        return ""

    def levers_of(self, setting):
        """Return all levers of a setting, those at the reference too."""
        return {**self.reference, **setting.levers}

    def in_words(self):
        """Return in words which scenes the book covers."""
        ranges = [
            f"{key} {allowed[0]:g} to {allowed[1]:g}"
            if isinstance(allowed[0], (int, float))
            else f"{key} {', '.join(allowed)}"
            for key, allowed in self.cover.items()
        ]
        return "; ".join(ranges) or "one scene"


def scene_of(p, levers):
    """Return {key: value taken} of the keys that say what happens, levers, seed and what is only watched aside."""
    aside = {*levers, *RUN_KEYS, *p.watching()}
    return {key: value for key, value in p.identity().items() if key not in aside}


def alike(one, other):
    """True for equal values, numbers to rounding."""
    if isinstance(one, (int, float)) and isinstance(other, (int, float)):
        return math.isclose(one, other, rel_tol=1e-9)
    return one == other


def cover_of(scenes):
    """Return (same, cover) of a list of dicts by key; keys with different values have ranges, of words lists."""
    same, cover = {}, {}
    for key in scenes[0]:
        values = list(dict.fromkeys(scene[key] for scene in scenes))
        if len(values) == 1:
            same[key] = values[0]
        elif all(isinstance(value, (int, float)) for value in values):
            cover[key] = [min(values), max(values)]
        else:
            cover[key] = values
    return same, cover


def as_json(book):
    """Return the text of a book."""
    content = dataclasses.asdict(book)
    del content["file"]
    return json.dumps(finite(content), indent=1, allow_nan=False) + "\n"


def finite(value):
    """Return nested values with numbers that JSON has no word for as text."""
    if isinstance(value, dict):
        return {key: finite(inner) for key, inner in value.items()}
    if isinstance(value, (list, tuple)):
        return [finite(inner) for inner in value]
    return repr(value) if isinstance(value, float) and not math.isfinite(value) else value


def write(path, book):
    """Write a book, whole or not at all."""
    whole_files.write_text(path, as_json(book))


def read(path):
    """Return the `Book` of a file; UsageError where it is none."""
    try:
        content = json.loads(Path(path).read_text(encoding="utf-8"))
        settings = [
            Setting(**{**s, "effects": {name: Effect(**numbers(effect)) for name, effect in s["effects"].items()}})
            for s in content.pop("settings")
        ]
        return Book(**content, settings=tuple(settings), file=Path(path).name)
    except (OSError, ValueError, TypeError, KeyError, AttributeError) as error:
        raise UsageError(
            f"{path} holds no measured settings ({one_line(error)}); scripts/tune writes such files"
        ) from None


def numbers(effect):
    """Return an effect's numbers, those that JSON has no word for too."""
    return {key: float(value) if isinstance(value, str) else value for key, value in effect.items()}


@functools.lru_cache(maxsize=None)
def shipped(folder=FOLDER):
    """Return the tuple of the books in a folder, by name."""
    return tuple(read(path) for path in sorted(Path(folder).glob("*.json")))


def of_study(study, folder=None):
    """Return the books of a study's family."""
    return [book for book in shipped(FOLDER if folder is None else folder) if book.study == study.family]
