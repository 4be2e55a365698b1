"""The operators of surfaces, `a | b`, `a & b`, `a - b`, `~a`, and `a.placed(…)`, on the recipes that surfaces are made of."""

import math

import numpy as np

from .._engines import Surface
from .recipes import number, vector, words


def install():
    """Give the compiled `Surface` its operators."""
    Surface.__or__, Surface.__and__, Surface.__invert__, Surface.__sub__ = _or, _and, _not, _minus
    Surface.placed = _placed
    _placed.__name__, _placed.__qualname__ = "placed", "Surface.placed"


def _or(a, b):
    return _joined("union", a, b)


def _and(a, b):
    return _joined("intersection", a, b)


def _not(a):
    first, _, rest = a.recipe.partition(" ")
    return Surface(rest if first == "complement" else "complement " + a.recipe)


def _minus(a, b):
    return _and(a, _not(b)) if isinstance(b, Surface) else NotImplemented


def _placed(self, at=(0, 0, 0), axis=(0, 0, 1), angle=0.0):
    """The solid turned about `axis` through the origin by `angle` [rad], then shifted by `at` [m]."""
    axis, angle = vector("axis", axis), number("angle", angle)
    length = np.linalg.norm(axis)
    if not (0 < length < math.inf and math.isfinite(angle)):
        raise ValueError(
            f"axis and angle must be finite and the axis not zero, got {axis.tolist()} and {angle}; correct them"
        )
    turn = math.cos(angle / 2), *(math.sin(angle / 2) / length * axis)
    return Surface(words("placed", vector("at", at), turn) + " " + self.recipe)


def _joined(kind, a, b):
    """Make one union of all parts in place of nested unions: it is faster, and has exact distances at all edges."""
    if not isinstance(b, Surface):
        return NotImplemented
    parts = [_parts_of(kind, s.recipe) for s in (a, b)]
    return Surface(f"{kind} {sum(n for n, _ in parts)} " + " ".join(recipes for _, recipes in parts))


def _parts_of(kind, recipe):
    first, *rest = recipe.split(" ", 2)
    return (int(rest[0]), rest[1]) if first == kind else (1, recipe)
