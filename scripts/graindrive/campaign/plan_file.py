"""The YAML file of a campaign: its keys, each of the right kind."""

from ..base.errors import UsageError, one_line
from ..commands.parameter_values import nearest
from ..base.plain_yaml import read, shortened

KEYS = ("study", "report", "common", "sweeps")


def read_plan_file(path):
    """Return the mapping that the campaign's file holds; UsageError if it cannot be one."""
    content = read(path, "the YAML file of a campaign")
    if not isinstance(content, dict):
        raise UsageError(f"{path} must hold the keys {', '.join(KEYS)}, got {shortened(content)}")
    check_keys(path, content)
    return content


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
