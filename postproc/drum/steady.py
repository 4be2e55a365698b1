"""When a drum's flow counts as steady: the slope of the grains, seen in their centre of mass, no longer drifts."""

import numpy as np

TOLERANCE = 0.5  # degrees
STRETCHES = 3  # the turn before the averages is seen in so many parts, of which the last two must agree
FEWEST_ROWS = 4  # in a part


def centre_angle(x, y, mass):
    """Return by how much the centre of mass of grains (n,) is turned counter-clockwise from below the axis [degrees].

    Of a half disk with a plane surface it is the surface's angle.
    """
    return float(np.degrees(np.arctan2(np.sum(mass * x), -np.sum(mass * y))))


def is_steady(turn, angle, least):
    """True if the angles (n,) of the centre of mass no longer drift, by rows over the drum's `turn` (n,), both in degrees.

    The means over the last part and over the part before, each `least`/`STRETCHES` of turn, must agree within `TOLERANCE`. It
    is False before a turn of `least`, and with fewer than `FEWEST_ROWS` rows in a part.
    """
    turn, angle = np.asarray(turn, dtype=float), np.asarray(angle, dtype=float)
    if len(turn) == 0 or turn[-1] < least * (1 - 1e-9):
        return False
    part = least / STRETCHES
    back = turn[-1] - turn
    last, before = angle[back < part], angle[(back >= part) & (back < 2 * part)]
    if min(len(last), len(before)) < FEWEST_ROWS:
        return False
    return bool(abs(last.mean() - before.mean()) <= TOLERANCE)
