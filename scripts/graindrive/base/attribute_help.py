"""What the attributes of an engine are: type, unit, default, whether they can be set; for `help()` and for the HTML reference."""

import re
from dataclasses import dataclass, replace

UNIT = re.compile(r"\[([^\[\]]*)\]")


@dataclass(frozen=True)
class Attribute:
    """An attribute of a class: its `name`, its `meaning` with its unit in brackets, its `unit` ("" where none is told).

    `type` and `default` are words, "" where a new object has no value; `settable` is False for what can only be read.
    """

    name: str
    meaning: str
    unit: str
    type: str
    default: str
    settable: bool

    def in_words(self):
        """Return type, default and whether it can be set as one line."""
        told = [f"type {self.type}", f"default {self.default}"] if self.type else []
        return ", ".join([*told, "can be set" if self.settable else "read only"])


def attributes_of(cls):
    """Return the `Attribute`s of a bound class, in the order of its `attributes(visit)`; those of its bases are left out."""
    fresh = cls()
    return [attribute(fresh, name, member) for name, member in vars(cls).items() if isinstance(member, property)]


def attribute(fresh, name, member):
    """Return the `Attribute` that a property is, with the value of a fresh object as its default."""
    try:
        value = getattr(fresh, name)
        kind, default = type(value).__name__, repr(value)
    except (RuntimeError, ValueError):  # of an engine that must stand in O.engines, or have done something, to answer
        kind, default = "", ""
    told = Attribute(name, "", "", kind, default, member.fset is not None)
    meaning = " ".join((member.__doc__ or "").split()).removesuffix(f"({told.in_words()})").strip()
    unit = UNIT.search(meaning)
    return replace(told, meaning=meaning, unit=unit[1] if unit else "")


def extend(classes):
    """Add type, default and whether it can be set to the docstring of every attribute of the classes, where `help()` shows it."""
    for cls in classes:
        for told in attributes_of(cls):
            vars(cls)[told.name].__doc__ = f"{told.meaning}\n({told.in_words()})".lstrip()
