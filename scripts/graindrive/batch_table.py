"""Rows of YADE's batch tables (`yade-batch table study.py`), read by YADE's own reader."""

import math

from .errors import UsageError, one_line


def read_row(environment):
    """Return {heading: text} of the row that yade-batch chose (`YADE_BATCH=table:line`), empty outside a batch.

    The format is YADE's: a line of headings, `=` repeats the value above, `*` takes the default, `!NAME` columns belong
    to yade-batch, words may stand in quotes. Raises UsageError if the table or the line cannot be read.
    """
    table, _, line = environment.get("YADE_BATCH", "").rpartition(":")
    if not table:
        return {}
    from yade.utils import TableParamReader

    try:
        row = TableParamReader(table).paramDict()[int(line)]
    except (OSError, KeyError, ValueError, IndexError, UnicodeError) as error:
        reason = error.strerror if isinstance(error, OSError) else one_line(error)
        raise UsageError(f"line {one_line(line)} of batch table {one_line(table)} cannot be read: {reason}") from None
    return {
        heading.rstrip("!"): text.strip("'\"")
        for heading, text in row.items()
        if heading != "description" and not heading.startswith("!") and text != "*"
    }


def evaluated(text):
    """Return the text of a number with its arithmetic done (`pi/4`), as YADE does; other text unchanged."""
    try:
        return repr(eval(text, {"__builtins__": {}, **math.__dict__}))  # the user's own table, and YADE's own rule
    except Exception:
        return text
