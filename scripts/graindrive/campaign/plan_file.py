"""Reading the YAML file of a campaign: plain values by the core schema of YAML 1.2, no key twice, no more than a plan needs.

PyYAML follows YAML 1.1, where `yes` is a switch, `1:30` is 90, `010` is 8, `1e-9` is text and `2026-01-02` a date.
"""

import re
import reprlib

import yaml

from ..command_line import nearest
from ..errors import UsageError, one_line

KEYS = ("study", "report", "common", "sweeps")
MOST_BYTES = 4_000_000  # a plan of 100,000 runs written out in full; the parser needs a minute for as much
PLAIN_VALUES = (  # (kind, what is read as that, from text to the value), first match first
    ("null", r"~|null|Null|NULL|", lambda text: None),
    ("bool", r"true|True|TRUE|false|False|FALSE", lambda text: text.lower() == "true"),
    ("int", r"[-+]?[0-9]+", int),
    ("float", r"[-+]?(\.[0-9]+|[0-9]+(\.[0-9]*)?)([eE][-+]?[0-9]+)?", float),
)
TAG = "tag:yaml.org,2002:"
brief = reprlib.Repr()
brief.maxlevel, brief.maxdict, brief.maxlist, brief.maxstring, brief.maxother = 2, 3, 3, 60, 60


class StrictLoader(yaml.SafeLoader):
    """YAML of mappings, lists and plain values alone; a key that a mapping holds twice is refused, its first value was lost."""

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
    """Return PyYAML's constructor of a plain value that matches `pattern` and that `convert` makes of its text."""

    def construct(loader, node):
        text = loader.construct_scalar(node)
        try:
            if pattern.match(text):
                return convert(text)
        except ValueError:  # Python reads at most 4300 digits
            pass
        raise UsageError(
            f"{place(node)}: {one_line(text)} is no {node.tag.removeprefix(TAG)} that can be read; write another"
        )

    return construct


def teach(loader):
    """Have `loader` know plain values, text, lists and mappings, and no other tags."""
    for kind, expression, convert in PLAIN_VALUES:
        pattern = re.compile(f"(?:{expression})$")
        loader.add_implicit_resolver(TAG + kind, pattern, None)
        loader.add_constructor(TAG + kind, plain_value(pattern, convert))
    loader.add_constructor(f"{TAG}str", yaml.constructor.BaseConstructor.construct_scalar)
    loader.add_constructor(f"{TAG}seq", yaml.SafeLoader.construct_yaml_seq)
    loader.add_constructor(f"{TAG}map", yaml.SafeLoader.construct_yaml_map)


teach(StrictLoader)


def place(node):
    """Return in words where a node of the file stands."""
    return f"line {node.start_mark.line + 1}"


def shortened(value):
    """Return a value on one short line, also where lists of lists name each other a million times."""
    return one_line(brief.repr(value) if isinstance(value, (dict, list)) else value)


def read_plan_file(path):
    """Return the mapping that the campaign's file holds; UsageError if it cannot be one."""
    try:
        content = yaml.load(text_of(path), StrictLoader)  # noqa: S506 (derived from SafeLoader)
    except UsageError as error:
        raise UsageError(f"{path}: {error}") from None
    except OSError as error:
        raise UsageError(f"{path} cannot be read ({error.strerror}); give the YAML file of a campaign") from None
    except RecursionError:
        raise UsageError(f"{path} is nested too deeply; a campaign needs four levels") from None
    except (yaml.YAMLError, ValueError) as error:
        raise UsageError(f"{path} is not YAML: {one_line(error, 200)}") from None
    if not isinstance(content, dict):
        raise UsageError(f"{path} must hold the keys {', '.join(KEYS)}, got {shortened(content)}")
    check_keys(path, content)
    return content


def text_of(path):
    """Return the text of a file of sensible size; a device or a pipe is not asked, it might never end."""
    if path.exists() and not path.is_file():
        raise UsageError("this is not a file; give the YAML file of a campaign")
    if path.stat().st_size > MOST_BYTES:
        raise UsageError(
            f"the file has {path.stat().st_size} bytes, more than {MOST_BYTES}; give lists of values, or split it"
        )
    return path.read_text(encoding="utf-8")


def check_keys(path, content):
    """Refuse keys that are unknown, missing or of the wrong kind."""
    for key in content:
        if key not in KEYS:
            hint = nearest(key, KEYS, "did you mean ", "? ")
            raise UsageError(f"{path}: there is no key '{one_line(key)}'; {hint}allowed: {' '.join(KEYS)}")
    for key, kind, words in (("study", str, "the name of a study"), ("sweeps", dict, "names with grids of values")):
        if not isinstance(content.get(key), kind) or not content[key]:
            raise UsageError(f"{path}: {key} must be {words}, got {shortened(content.get(key))}")
    if not isinstance(content.get("common", {}) or {}, dict):
        raise UsageError(f"{path}: common must be keys of the study with values, got {shortened(content['common'])}")
    if not isinstance(content.get("report") or "", str):
        raise UsageError(f"{path}: report must be the name of a report, got {shortened(content['report'])}")
    for sweep in content["sweeps"]:
        if not sweep or len(sweep.split()) != 1:
            raise UsageError(f"{path}: the name of a sweep must be one word, got '{one_line(sweep)}'")
