"""Builds the texts of surfaces' recipes from checked numbers."""

import numpy as np


def vector(name, value):
    """Return three numbers as an array; ValueError with `name` for anything else."""
    try:
        numbers = np.asarray(value, dtype=float)
    except (TypeError, ValueError):
        numbers = None
    if numbers is None or numbers.shape != (3,):
        raise ValueError(f"{name} must be three numbers, got {value!r}; give (x, y, z)")
    return numbers


def number(name, value):
    """Return a number as a float; ValueError with `name` for anything else."""
    try:
        return float(value)
    except (TypeError, ValueError):
        raise ValueError(f"{name} must be a number, got {value!r}; give one in metres or radians") from None


def words(kind, *parts):
    """Return the text of a recipe; repr writes enough digits to restore the same bits."""
    found = [kind]
    for part in parts:
        values = np.atleast_1d(np.asarray(part)).ravel().tolist()
        found += [repr(value) for value in values]
    return " ".join(found)
