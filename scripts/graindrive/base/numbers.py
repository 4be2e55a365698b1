"""A number with its standard error in words: the one way in which figures, tables, reports and messages write both."""

import math

SIGNIFICANT = 2  # digits of an error
PLAIN = 1e-3, 1e6  # sizes that are written without a power of ten
EXACT = 1e-9  # of the value: an error below this is round-off
SUPERSCRIPTS = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


def with_error(value, error):
    """Return "10.9 ± 4.0": the error with two significant digits, the value with as many decimals as the error.

    Very small and very large numbers have a power of ten, "(1.23 ± 0.45) × 10⁻⁶"; minus signs are true ones. A value without
    error (0, or round-off) stands alone with four significant digits, one whose error is not finite says so.
    """
    if not math.isfinite(value):
        return "no data"
    if error is None or not math.isfinite(error):
        return minus(f"{value:.4g} (error unknown)")
    if error <= EXACT * abs(value):
        return minus(f"{value:.4g}")
    size = max(abs(value), error)
    if PLAIN[0] <= size < PLAIN[1]:
        return rounded_alike(value, error)
    power = decade(size)
    return f"({rounded_alike(value / 10.0**power, error / 10.0**power)}) × 10" + str(power).translate(SUPERSCRIPTS)


def rounded_alike(value, error):
    """Return both numbers with the decimals that the error's two significant digits need; beyond the point they end in zeros."""
    decimals = SIGNIFICANT - 1 - decade(error)
    value, error = round(value, decimals) + 0.0, round(error, decimals)
    shown = max(decimals, 0)
    return minus(f"{value:.{shown}f} ± {error:.{shown}f}")


def decade(number):
    """Return the power of ten of a number > 0 as it is after rounding to two significant digits: 0.0996 has -1."""
    return int(f"{number:.{SIGNIFICANT - 1}e}".partition("e")[2])


def minus(text):
    """Return text with true minus signs."""
    return text.replace("-", "−")
