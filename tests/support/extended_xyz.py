"""A strict reader of extended XYZ after its specification, https://github.com/libAtoms/extxyz, for tests of what is written."""

import re

import numpy as np

PAIR = re.compile(r'\s*([A-Za-z_][A-Za-z0-9_-]*)=("(?:[^"\\]|\\.)*"|[^\s"=,\[\]{}\\]+)')
INTEGER, REAL = re.compile(r"[+-]?(0|[1-9]\d*)\Z"), re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?\Z")


def read(text):
    """Return a list of (settings, columns) of the frames of a text; ValueError if it violates the specification."""
    lines, frames = text.split("\n"), []
    if lines.pop() != "":
        raise ValueError("the last line does not end")
    while lines:
        count = lines.pop(0)
        if not re.fullmatch(r"\s*[1-9]\d*\s*", count):
            raise ValueError(f"a frame begins with the number of its atoms, got {count!r}")
        settings = settings_of(lines.pop(0))
        rows, lines = lines[: int(count)], lines[int(count) :]
        if len(rows) != int(count):
            raise ValueError(f"{count} atoms are announced, {len(rows)} follow")
        frames.append((settings, columns_of(rows, settings["Properties"])))
    return frames


def settings_of(line):
    """Return the key=value pairs of a comment line; Lattice as (3, 3) vectors, Origin (3,), pbc as booleans, Time as float."""
    found, at = {}, 0
    while line[at:].strip():
        pair = PAIR.match(line, at)
        if pair is None or pair.group(1) in found:
            raise ValueError(f"no key=value, or a key twice, at {line[at:]!r}")
        found[pair.group(1)] = pair.group(2).strip('"')
        at = pair.end()
    lattice = [real(word) for word in found["Lattice"].split()]
    found["Lattice"] = np.array(lattice).reshape(3, 3)  # rows are the vectors a, b, c
    found["Origin"] = np.array([real(word) for word in found["Origin"].split()]).reshape(3)
    found["pbc"] = [{"T": True, "F": False}[word] for word in found["pbc"].split()]
    found["Time"] = real(found["Time"])
    return found


def columns_of(rows, properties):
    """Return {name: array} of the rows of a frame, as the key Properties declares them."""
    words = properties.split(":")
    if len(words) % 3:
        raise ValueError(f"Properties come in threes, name:type:count, got {properties}")
    declared = [(name, kind, int(count)) for name, kind, count in zip(words[::3], words[1::3], words[2::3])]
    cells, width = [row.split() for row in rows], sum(count for *_, count in declared)
    if any(len(row) != width for row in cells):
        raise ValueError(f"every row must have {width} columns")
    columns, at = {}, 0
    for name, kind, count in declared:
        convert = {"I": whole, "R": real, "S": str}[kind]
        block = np.array([[convert(word) for word in row[at : at + count]] for row in cells])
        columns[name], at = block[:, 0] if count == 1 else block, at + count
    return columns


def whole(word):
    """Return an integer that has the form of the specification."""
    if not INTEGER.match(word):
        raise ValueError(f"not an integer: {word}")
    return int(word)


def real(word):
    """Return a real number that has the form of the specification, never nan or inf."""
    if not REAL.match(word):
        raise ValueError(f"not a real number: {word}")
    return float(word)
