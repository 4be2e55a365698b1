"""Converts values from the command line and from files to the type that their key declares, or refuses them by name."""

import difflib
import math
import os
import re

from ..base.errors import UsageError, one_line
from ..parameters import allowed, choices, plain_type
from ..base.plain_yaml import read, shortened
from ..study import house

SWITCH = {"1": True, "true": True, "yes": True, "on": True, "0": False, "false": False, "no": False, "off": False}


def require_key(cls, key):
    """Raise UsageError with a hint (keys that hold the word, studies that have it, a spelling) unless the class has `key`."""
    if key not in cls.__fields__:
        word = str(key).lstrip("-").replace("-", "_").strip().lower()
        hint = longer(word, cls.__fields__) + elsewhere(word) or nearest(word, cls.__fields__, "did you mean ", "? ")
        raise UsageError(f"there is no key '{one_line(key)}'; {hint}allowed: {' '.join(cls.__fields__)}")


def longer(word, keys):
    """Return a question after the keys of which `word` is a part, as `spin` of spin_ratio; "" if there are none."""
    found = [key for key in keys if f"_{word}_" in f"_{key}_"] if word.strip("_") else []
    return f"did you mean {enumerated(found, 'or')}? " if found else ""


def elsewhere(key):
    """Return which studies of this checkout have a key, in words; "" if none has it. Their files are searched, not run."""
    declared = re.compile(rf"^    {re.escape(key)}: .*= quantity\(", re.MULTILINE) if key.isidentifier() else None
    found = [name for name, file in house().items() if declared and declared.search(file.read_text(encoding="utf-8"))]
    return f"{enumerated(found, 'and')} {'have' if len(found) > 1 else 'has'} it; " if found else ""


def enumerated(words, last):
    """Return words as one writes them in a sentence, with "and" or "or" as `last`."""
    return f" {last} ".join(filter(None, [", ".join(words[:-1]), *words[-1:]]))


def nearest(word, words, before, after):
    """Return the word of `words` closest to `word`, between `before` and `after`, or "" if none is close."""
    found = difflib.get_close_matches(str(word).lower(), list(map(str, words)), n=1, cutoff=0.5)
    return f"{before}{found[0]}{after}" if found else ""


def argument_text(key, value):
    """Return `key=value` as the user typed it, on one line."""
    return f"{key}={one_line(value)}"


def refuse(field, text):
    """Raise the UsageError for a value that `field` does not take."""
    hint = nearest(text, choices(field), " (did you mean ", "?)")
    raise UsageError(
        f"{argument_text(field.name, text)} is not allowed: {field.name} is {allowed(field)}{hint}"
        f" - {field.field_info.description}"
    )


def convert(field, text):
    """Return a value, given as text, as the type that `field` declares; raises UsageError."""
    if field.allow_none and text.lower() == "auto":
        return None
    kind = plain_type(field)
    try:
        if kind is bool:
            return SWITCH[text.lower()]
        if kind is int:
            return whole(text)
        if kind is float:
            return finite(float(text))
    except (ValueError, KeyError, OverflowError):
        refuse(field, text)
    if kind is str and any(not c.isprintable() for c in text):
        refuse(field, text)
    return text


def finite(number):
    """Return `number`; raises ValueError if it is infinite or not a number."""
    if not math.isfinite(number):
        raise ValueError("not finite")
    return number


def whole(text):
    """Return the integer that `text` stands for; 1e5 is allowed too."""
    try:
        return int(text)
    except ValueError:
        number = float(text)
        if not number.is_integer():
            raise ValueError("not whole") from None
        return int(number)


# ---- files -----------------------------------------------------------------------------------------------------------


def argument(parameters, key, value):
    """Return a value of a file as an argument of the command line; UsageError if its type is not that of its key."""
    require_key(parameters, key)
    field = parameters.__fields__[key]
    if isinstance(value, (dict, list)):
        raise UsageError(f"{one_line(key)} must be a number, a word or a switch, got {shortened(value)}")
    if hasattr(value, "dtype") and getattr(value, "ndim", 1) == 0:  # of NumPy, which help does not import
        value = value.item()
    elif isinstance(value, os.PathLike):
        value = os.fspath(value)
    if value is None and not field.allow_none:
        raise UsageError(f"{key} has no value; leave it out for its default")
    if field.allow_none and value in (None, "auto"):
        return f"{key}=auto"
    if not is_of_kind(plain_type(field), value):
        refuse(field, f"'{value}'" if isinstance(value, str) and is_number(value) else as_written(value))
    return f"{key}={int(value) if isinstance(value, bool) else value}"


def is_of_kind(kind, value):
    """True if a value of a file has the type that a key takes: bool, int, float, str, or None for a choice of words."""
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
    """Return a value as it is written in the file."""
    return str(value).lower() if isinstance(value, bool) else str(value)


def arguments_of(path, parameters):
    """Return the `key: value` lines of a YAML file of parameters as `key=value` arguments; UsageError for any other file."""
    content = read(path, "a file of parameters, key: value on each line")
    if not isinstance(content, dict):
        raise UsageError(f"{path} must hold key: value on each line, got {shortened(content)}")
    try:
        return [argument(parameters, key, value) for key, value in content.items()]
    except UsageError as error:
        raise UsageError(f"{path}: {error}") from None
