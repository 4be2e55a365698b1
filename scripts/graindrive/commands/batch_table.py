"""Reads rows of YADE's batch tables (`yade-batch table study.py`), whose numbers may be arithmetic expressions."""

import ast
import math
import operator
from pathlib import Path

from ..base.errors import UsageError, one_line

OPERATORS = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.Div: operator.truediv,
    ast.FloorDiv: operator.floordiv,
    ast.Mod: operator.mod,
    ast.Pow: math.pow,
    ast.UAdd: operator.pos,
    ast.USub: operator.neg,
}
FUNCTIONS = (  # of `math`; none of them takes long for arguments that fit into a short text
    *("sqrt", "exp", "log", "log2", "log10", "pow", "hypot", "fabs", "floor", "ceil", "degrees", "radians"),
    *("sin", "cos", "tan", "asin", "acos", "atan", "atan2", "sinh", "cosh", "tanh"),
)


def read_row(environment):
    """Return {heading: text} of the row that yade-batch chose (`YADE_BATCH=table:line`), empty outside a batch.

    The format is YADE's: a line of headings, `=` repeats the value above, `*` takes the default, `!NAME` columns belong
    to yade-batch, words may stand in quotes, `#` begins a comment. Raises UsageError if table or line cannot be read.
    We do not use YADE's reader, because it drops the last character of a table without a newline at its end, surplus values,
    and the first of two columns with the same name.
    """
    table, _, line = environment.get("YADE_BATCH", "").rpartition(":")
    if not table:
        return {}
    try:
        row = row_of(Path(table).read_text(encoding="utf-8"), line)
    except OSError as error:
        raise unreadable(table, line, error.strerror) from None
    except ValueError as error:
        raise unreadable(table, line, one_line(error, 200)) from None
    return {
        heading.rstrip("!"): text.strip("'\"")
        for heading, text in row.items()
        if heading != "description" and not heading.startswith("!") and text != "*"
    }


def unreadable(table, line, reason):
    """Return the UsageError that says why a line of a table cannot be read."""
    return UsageError(f"line {one_line(line)} of batch table {one_line(table)} cannot be read: {reason}")


def row_of(text, line):
    """Return {heading: text} of the row in line number `line`, counted from 1, of a table's text; ValueError if there is none."""
    split = {
        number: words for number, full in enumerate(text.splitlines(), 1) if (words := full.partition("#")[0].split())
    }
    headings, *rows = split.items() or [(0, [])]
    if not line.isdecimal() or int(line) not in dict(rows):
        raise ValueError(f"its rows are in lines {', '.join(str(number) for number, _ in rows) or '(none)'}")
    bare = [heading.rstrip("!") for heading in headings[1]]
    if len(set(bare)) < len(bare):
        raise ValueError(f"two columns have the same name, {' '.join(headings[1])}; keep one")
    found = {}
    for number, words in rows:
        if len(words) != len(bare):
            raise ValueError(
                f"line {number} has {len(words)} values for {len(bare)} columns; write * for a default value"
            )
        if "=" in words and not found:
            raise ValueError(f"'=' in line {number} has no value above it to repeat")
        found = {heading: found[heading] if word == "=" else word for heading, word in zip(headings[1], words)}
        if number == int(line):
            return found


def evaluated(text):
    """Return the value of an arithmetic expression (`pi/4`, `2*sqrt(3)`) as text, as YADE does; other text unchanged."""
    try:
        return repr(value_of(ast.parse(text, mode="eval").body))
    except (ArithmeticError, MemoryError, RecursionError, SyntaxError, TypeError, ValueError):
        return text


def value_of(node):
    """Return the value of an expression of numbers, operators and functions of `math`; ValueError for any other expression."""
    if isinstance(node, ast.Constant) and type(node.value) in (int, float):
        return node.value
    if isinstance(node, ast.Name) and isinstance(getattr(math, node.id, None), float):
        return getattr(math, node.id)
    if isinstance(node, ast.BinOp) and type(node.op) in OPERATORS:
        return OPERATORS[type(node.op)](value_of(node.left), value_of(node.right))
    if isinstance(node, ast.UnaryOp) and type(node.op) in OPERATORS:
        return OPERATORS[type(node.op)](value_of(node.operand))
    if (
        isinstance(node, ast.Call)
        and isinstance(node.func, ast.Name)
        and node.func.id in FUNCTIONS
        and not node.keywords
    ):
        return getattr(math, node.func.id)(*map(value_of, node.args))
    raise ValueError("not arithmetic")
