"""Claims on the runs of a campaign's table, with the settings of those runs in words."""

from .runs import names
from .verdicts import Claim


def claim_on(symbols, rows, text, source, expected, measured, rule):
    """Return a `Claim` on the runs of `rows`; `symbols` as in `settings`."""
    return Claim(text, source, expected, measured, rule, settings(symbols, rows), names(rows))


def settings(symbols, rows):
    """Return in words of which runs a claim is, by the keys of `symbols`: {key: (its symbol, its unit)}."""
    if rows.empty:
        return ""
    return ", ".join(f"{symbol} {span(rows[key])}{unit}".lstrip() for key, (symbol, unit) in symbols.items())


def span(column):
    """Return the values of a key in words: "0, 10", or "0.5 to 2" where there are more than three; names one and all."""
    found = list(dict.fromkeys(column))
    if isinstance(found[0], str):
        return ", ".join(found)
    found.sort()
    return ", ".join(f"{v:g}" for v in found) if len(found) <= 3 else f"{found[0]:g} to {found[-1]:g}"
