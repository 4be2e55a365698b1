"""`campaign.json`: the plan in a campaign's folder, written for Snakemake and for the report."""

import json
from pathlib import Path

from ..base import whole_files

FILE = "campaign.json"
NEEDED = {"name", "runs", "report"}  # keys that every plan has


class PlanError(Exception):
    """A campaign's folder has no plan that can be read; the message is one line that says why."""


def write(folder, plan, program):
    """Leave a `Plan` in the campaign's folder, whole or not at all; `program` is the command that runs a study file."""
    runs = [
        {"name": run.name, "arguments": run.arguments, "sweeps": run.sweeps, "digest": run.parameters.digest()}
        for run in plan.runs
    ]
    content = {
        "name": plan.name,
        "file": plan.file,
        "origin": str(plan.origin),
        "study": plan.study.name,
        "study_file": str(plan.study_file),
        "program": program,
        "report": plan.report.name if plan.report else "",
        "runs": runs,
    }
    whole_files.write_text(folder / FILE, json.dumps(content, indent=1) + "\n")


def read(folder):
    """Return the dict that `write` stored in a folder; PlanError if there is none."""
    try:
        plan = json.loads((Path(folder) / FILE).read_text())
    except (FileNotFoundError, NotADirectoryError):
        raise PlanError(f"{folder} is not the folder of a campaign: it holds no {FILE}") from None
    except (OSError, ValueError, RecursionError) as error:
        raise PlanError(f"{folder}/{FILE} cannot be read ({' '.join(str(error).split())})") from None
    if not isinstance(plan, dict) or not NEEDED <= set(plan):
        raise PlanError(f"{folder}/{FILE} is no plan of a campaign; a call of scripts/campaign writes it anew")
    return plan
