"""`studies/RESULTS.md`, made of the reports of campaigns and of comparisons with other programs.

Called by `python3 -m graindrive.postproc.campaign.results FOLDER …`. RESULTS.md keeps one section per campaign, between two
comments that name it. Publishing a campaign replaces its section and its figures in studies/figures/, and leaves the others
as they are.
"""

import re
import shutil
import sys
from pathlib import Path

from ...base.whole_files import write_text, written
from ..reader import RunError
from .folder import Campaign

HEADING = """# Results

What campaigns of this checkout measured, beside what the papers say. Made by `scripts/results FOLDER …` from the reports
that `scripts/campaign` and `scripts/compare_lift` leave; not written by hand. Errors are standard errors. A verdict
follows from the rule beside it, σ being the standard error; a measurement that cannot tell a claim from its opposite is
*not decided*.
"""
SECTION = "<!-- campaign {name} -->\n{text}\n<!-- end of {name} -->\n"
SECTIONS = re.compile(r"<!-- campaign (?P<name>[^\n]+?) -->\n(?P<text>.*?)\n<!-- end of (?P=name) -->\n", re.DOTALL)


def publish(folders, studies):
    """Put the reports in campaign `folders` into `studies`/RESULTS.md and their PNG figures into `studies`/figures."""
    target = Path(studies) / "RESULTS.md"
    sections = stored_sections(target)
    for folder in map(Path, folders):
        name, text = report_of(folder)
        sections[name] = text
        copy_figures(folder, Path(studies) / "figures")
    body = "\n".join(SECTION.format(name=name, text=text) for name, text in sorted(sections.items()))
    write_text(target, f"{HEADING}\n{body}")
    return target


def report_of(folder):
    """Return (name, Markdown) of the report in a folder; RunError if there is none.

    The name is the campaign's; a comparison with another program, which is none, is named by its folder.
    """
    try:
        text = (folder / "report.md").read_text(encoding="utf-8").strip()
        return Campaign.of(folder).plan["name"] if (folder / "campaign.json").exists() else folder.resolve().name, text
    except FileNotFoundError:
        raise RunError(f"{folder} holds no report.md: call scripts/campaign first") from None


def stored_sections(target):
    """Return {campaign's name: Markdown} of the sections of RESULTS.md; empty if there is none yet."""
    text = target.read_text(encoding="utf-8") if target.exists() else ""
    return {match["name"]: match["text"] for match in SECTIONS.finditer(text)}


def copy_figures(folder, target):
    """Copy the PNG figures of a campaign, each in one step."""
    target.mkdir(exist_ok=True)
    for source in sorted((folder / "figures").glob("*.png")):
        with written(target / source.name) as temporary:
            shutil.copyfile(source, temporary)


def main(arguments):
    """Publish the campaigns that the arguments name; return the exit code: 0, or 2 after one line on stderr."""
    if not arguments or {"help", "-h", "--help"} & set(arguments):
        print("usage: scripts/results CAMPAIGN-FOLDER …   (puts their reports into studies/RESULTS.md)")
        return 0 if arguments else 2
    try:
        print(f"graindrive: see {publish(arguments, Path(__file__).resolve().parents[2] / 'studies')}", file=sys.stderr)
        return 0
    except (RunError, OSError, UnicodeError) as error:
        print(f"graindrive.postproc.campaign.results: error: {' '.join(str(error).split())}", file=sys.stderr)
        return 2


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
