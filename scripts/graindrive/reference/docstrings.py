"""Docstrings, which are plain English, as reStructuredText: nothing in them is markup but code between backticks."""

import re

CODE = re.compile(r"(`+)([^`]+)\1")
SPECIAL = re.compile(r"([\\*|_`<>])")
# Paragraphs whose line breaks matter: formulas, lists, tables.
VERBATIM = re.compile(r"^(\s|[-+*#.:=~>]|(\d+|[A-Za-z])[.)]\s)", re.MULTILINE)


def as_rst(text):
    """Return the text of a docstring as lines of reStructuredText."""
    lines = []
    for paragraph in re.split(r"\n\s*\n", text.strip("\n").expandtabs()):
        if not paragraph.strip():
            continue
        if VERBATIM.search(paragraph):
            lines += ["::", "", *(f"    {line}" for line in paragraph.splitlines()), ""]
        else:
            lines += [*escaped(paragraph).splitlines(), ""]
    return lines


def escaped(text):
    """Return a text in which nothing is markup but code between backticks."""
    parts, end = [], 0
    for code in CODE.finditer(text):
        parts += [SPECIAL.sub(r"\\\1", text[end : code.start()]), f"``{' '.join(code[2].split())}``"]
        end = code.end()
        if not text[end : end + 1].isspace():  # an escaped blank ends the code; before a blank it would take that away
            parts.append("\\ ")
    return "".join([*parts, SPECIAL.sub(r"\\\1", text[end:])])


def in_autodoc(_app, _what, _name, _obj, _options, lines):
    """Turn the lines of a docstring into reStructuredText where they are; a handler of Sphinx's autodoc-process-docstring."""
    lines[:] = as_rst("\n".join(lines))
