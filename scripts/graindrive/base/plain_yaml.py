"""Reads YAML: plain values follow the core schema of YAML 1.2, no key may appear twice, and the size of files is limited.

PyYAML follows YAML 1.1, where `yes` is a switch, `1:30` is 90, `010` is 8, `1e-9` is text and `2026-01-02` a date.
"""

import re
import reprlib

import yaml

from .errors import UsageError, one_line

MOST_BYTES = 4_000_000  # the size of a plan that lists 100,000 runs one by one; the parser takes a minute for it
PLAIN_VALUES = (  # (type, pattern of its texts, function from text to value); the first match counts
    ("null", r"~|null|Null|NULL|", lambda text: None),
    ("bool", r"true|True|TRUE|false|False|FALSE", lambda text: text.lower() == "true"),
    ("int", r"[-+]?[0-9]+", int),
    ("float", r"[-+]?(\.[0-9]+|[0-9]+(\.[0-9]*)?)([eE][-+]?[0-9]+)?", float),
)
TAG = "tag:yaml.org,2002:"
brief = reprlib.Repr()
brief.maxlevel, brief.maxdict, brief.maxlist, brief.maxstring, brief.maxother = 2, 3, 3, 60, 60


class StrictLoader(yaml.SafeLoader):
    """Loader of mappings, lists and plain values only; refuses a key that a mapping holds twice (one value would be lost)."""

    yaml_implicit_resolvers = {}
    yaml_constructors = {None: yaml.SafeLoader.construct_undefined}

    def construct_mapping(self, node, deep=False):
        seen = set()
        for key_node, _ in node.value:
            key = self.construct_object(key_node, deep=True)
            if not isinstance(key, str):
                raise UsageError(f"{place(key_node)}: a key must be a word, got {shortened(key)}; put quotes around it")
            if key in seen:
                raise UsageError(f"{place(key_node)}: {one_line(key)} is given twice; keep one")
            seen.add(key)
        return yaml.constructor.BaseConstructor.construct_mapping(self, node, deep)


def plain_value(pattern, convert):
    """Return PyYAML's constructor for plain values: their text must match `pattern`, and `convert` makes the value."""

    def construct(loader, node):
        text = loader.construct_scalar(node)
        try:
            if pattern.match(text):
                return convert(text)
        except ValueError:  # Python reads at most 4300 digits
            pass
        raise UsageError(
            f"{place(node)}: {one_line(text)} is no {node.tag.removeprefix(TAG)} that can be read; give another value"
        )

    return construct


def teach(loader):
    """Make `loader` accept plain values, text, lists and mappings, and no other tags."""
    for kind, expression, convert in PLAIN_VALUES:
        pattern = re.compile(f"(?:{expression})$")
        loader.add_implicit_resolver(TAG + kind, pattern, None)
        loader.add_constructor(TAG + kind, plain_value(pattern, convert))
    loader.add_constructor(f"{TAG}str", yaml.constructor.BaseConstructor.construct_scalar)
    loader.add_constructor(f"{TAG}seq", yaml.SafeLoader.construct_yaml_seq)
    loader.add_constructor(f"{TAG}map", yaml.SafeLoader.construct_yaml_map)


teach(StrictLoader)


def place(node):
    """Return the place of a node in the file, in words."""
    return f"line {node.start_mark.line + 1}"


def shortened(value):
    """Return a value as one short line, even if lists refer to other lists a million times."""
    return one_line(brief.repr(value) if isinstance(value, (dict, list)) else value)


def read(path, what):
    """Return the content of a YAML file; UsageError if it cannot be read. `what` is the expected kind: "the file of a plan"."""
    try:
        return yaml.load(text_of(path, what), StrictLoader)  # noqa: S506 (derived from SafeLoader)
    except UsageError as error:
        raise UsageError(f"{path}: {error}") from None
    except OSError as error:
        raise UsageError(f"{path} cannot be read ({error.strerror}); give {what}") from None
    except RecursionError:
        raise UsageError(f"{path} is nested too deeply; {what} needs four levels at most") from None
    except (yaml.YAMLError, ValueError) as error:
        raise UsageError(f"{path} is not YAML: {one_line(error, 200)}") from None


def text_of(path, what):
    """Return the text of a file of limited size; devices and pipes are not opened, because they might never end."""
    if path.exists() and not path.is_file():
        raise UsageError(f"this is not a file; give {what}")
    if path.stat().st_size > MOST_BYTES:
        raise UsageError(
            f"the file has {path.stat().st_size} bytes, more than {MOST_BYTES}; give lists of values, or split it"
        )
    return path.read_text(encoding="utf-8")
