"""The pages of the reference that are made of code: one for each room of the package, one for the engines."""

from .. import engines
from ..base import attribute_help
from .docstrings import as_rst, escaped

HEADING = ("attribute", "type", "unit", "default", "can be set", "meaning")
KINDS = (  # of classes, by the base that YADE knows them by
    ("Engine", "Engines, for O.engines"),
    ("LawFunctor", "Contact laws on YADE's loop"),
    ("Functor", "What makes contacts on YADE's loop"),
    ("", "Parts of bodies and contacts"),
)


def heading(text, mark):
    """Return the lines of a heading."""
    return [escaped(text), mark * (len(escaped(text)) + 1), ""]


# ---- engines ---------------------------------------------------------------------------------------------------------


def engines_page():
    """Return the page of all classes and functions of the compiled module, as text."""
    lines = heading("Engines", "=")
    lines += ["In ``graindrive.engines``. Words, switches and counts have no unit; ``-`` is that of a pure number.", ""]
    left = engines.classes()
    for base, title in KINDS:
        of_kind = [cls for cls in left if base in [b.__name__ for b in cls.__mro__] or not base]
        left = [cls for cls in left if cls not in of_kind]
        lines += heading(title, "-") + [line for cls in of_kind for line in class_lines(cls)]
    lines += heading("Functions", "-") + [line for name in functions() for line in function_lines(name)]
    return "\n".join(lines)


def class_lines(cls):
    """Return the lines on one class: what it is for, its attributes, its methods."""
    lines = [f".. py:class:: graindrive.engines.{cls.__name__}(attribute=value, ...)", "   :noindexentry:", ""]
    lines += indented(as_rst(cls.__doc__ or ""))
    attributes = attribute_help.attributes_of(cls)
    if attributes:
        lines += indented([".. list-table::", "   :header-rows: 1", "   :widths: auto", ""])
        lines += indented(row(HEADING)) + [line for a in attributes for line in indented(row(cells(a)))]
    for name, member in vars(cls).items():
        if not name.startswith("_") and callable(member) and member.__doc__:
            lines += ["", *indented([f".. py:method:: {name}(...)", ""]), *indented(indented(verbatim(member.__doc__)))]
    return [*lines, ""]


def cells(attribute):
    """Return the cells of an attribute's row."""
    default = f"``{attribute.default}``" if attribute.default else ""
    settable = "yes" if attribute.settable else "no"
    return attribute.name, attribute.type, in_cell(attribute.unit), default, settable, in_cell(attribute.meaning)


def in_cell(text):
    """Return a text as a cell in which nothing is markup, a dash at its start neither."""
    return ("\\" if text.startswith("-") else "") + escaped(text)


def row(texts):
    """Return the lines of a row of a list-table."""
    marks = ["   * - ", *["     - "] * (len(texts) - 1)]
    return [f"{mark}{' '.join(text.split())}".rstrip() for mark, text in zip(marks, texts)]


def functions():
    """Return the names of the compiled module's functions."""
    module = engines._engines
    return [n for n, f in vars(module).items() if callable(f) and not isinstance(f, type) and not n.startswith("_")]


def function_lines(name):
    """Return the lines on one function of the compiled module."""
    text = getattr(engines._engines, name).__doc__ or ""
    return [f".. py:function:: graindrive.engines.{name}(...)", "", *indented(verbatim(text)), ""]


def verbatim(text):
    """Return a text with its line breaks as a literal block."""
    return ["::", "", *(f"    {line}" for line in text.expandtabs().strip().splitlines()), ""]


def indented(lines):
    """Return lines three places to the right."""
    return [f"   {line}" if line else "" for line in lines]


# ---- the package -----------------------------------------------------------------------------------------------------


def rooms(modules):
    """Return {room: its modules}: `graindrive.beds.lid` is in beds, `graindrive.postproc.drum.flow` in postproc.drum."""
    found = {}
    for module in sorted(modules):
        parts = module.split(".")[1:]
        depth = 2 if parts[0] == "postproc" and len(parts) > 2 else 1
        found.setdefault(".".join(parts[:depth]), []).append(module)
    return found


def room_page(room, modules):
    """Return the page of a room, as text: every public function and class of its modules that has a docstring."""
    lines = heading(f"graindrive.{room}", "=")
    for module in modules:
        lines += heading(module, "-") + [f".. automodule:: {module}", "   :members:", ""]
    return "\n".join(lines)
