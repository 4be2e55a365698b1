"""Reports of campaigns as Markdown, and `studies/RESULTS.md` made of them: `python3 -m graindrive.postproc.results FOLDER …`.

RESULTS.md keeps one section per campaign, between two comments that name it. Publishing a campaign replaces its
section and its figures in studies/figures/, and leaves the others as they are.
"""

import os
import re
import shutil
import sys
from dataclasses import dataclass
from pathlib import Path

from . import figures
from .reader import RunError
from .verdicts import tally

HEADING = """# Results

What campaigns of this checkout measured, beside what the papers say. Made by `scripts/results FOLDER …` from the reports
that `scripts/campaign` leaves; not written by hand. Errors are standard errors. A verdict follows from the rule beside it,
σ being the standard error; a measurement that cannot tell a claim from its opposite is *not decided*.
"""
SECTION = "<!-- campaign {name} -->\n{text}\n<!-- end of {name} -->\n"
SECTIONS = re.compile(r"<!-- campaign (?P<name>\S+) -->\n(?P<text>.*?)\n<!-- end of (?P=name) -->\n", re.DOTALL)


@dataclass(frozen=True)
class Section:
    """One figure of a report: title, file below the campaign's `figures/` (without ending), caption, claims."""

    title: str
    figure: str
    caption: str
    claims: tuple


@dataclass(frozen=True)
class PlannedFigure:
    """How a figure of a report is made: its file's `name`, the `sweep` that it shows, title, caption, and two functions.

    `claims(campaign, rows)` tests the paper's claims on the sweep's rows, `draw(campaign, rows, claims)` returns the figure.
    """

    name: str
    sweep: str
    title: str
    caption: str
    claims: object
    draw: object

    def made(self, campaign):
        """Draw the figure into the campaign's folder `figures`; return its `Section`."""
        rows = campaign.sweep(self.sweep)
        claims = tuple(self.claims(campaign, rows))
        figures.save_as(
            self.draw(campaign, rows, claims), campaign.folder / "figures", f"{campaign.plan['name']}-{self.name}"
        )
        return Section(self.title, self.name, self.caption, claims)


def write_text(path, text):
    """Write a text file in one step: a reader sees the old one or the new one."""
    temporary = path.with_name(f".{path.name}.tmp")
    temporary.write_text(text, encoding="utf-8")
    os.replace(temporary, path)


# ---- one campaign ----------------------------------------------------------------------------------------------------


def as_markdown(campaign, title, sections):
    """Return the report of a `Campaign`: what was run, at what cost, then figures, claims and verdicts."""
    claims = [claim for section in sections for claim in section.claims]
    parts = [
        f"## {title} (`{campaign.plan['name']}`)",
        settings(campaign),
        f"Of {len(claims)} claims: {tally(claims)}.",
    ]
    return "\n\n".join(parts + [section_text(campaign, section) for section in sections]) + "\n"


def settings(campaign):
    """Return the paragraphs that say what was run, with what keys, on what, at what cost, and how to repeat it."""
    table, plan = campaign.table, campaign.plan
    common = ", ".join(f"{key} {number(value)}" for key, value in campaign.common(table).items())
    varied = ", ".join(f"{key} {values(table[key])}" for key in campaign.varied(table))
    missing = len(plan["runs"]) - len(table)
    return "\n\n".join(
        [
            f"{len(table)} runs of `{plan['study']}`" + (f" ({missing} more are missing)" if missing else "") + "; "
            f"{cost(table)}. Repeat: `scripts/campaign {plan['file']}`.",
            f"Varied: {varied or 'nothing'}. The same in all runs: {common}.",
        ]
    )


def cost(table):
    """Return in words what the runs of a table cost, on which processors, by which code."""
    steps = (table["steps"] * table["n_grains"]).sum()
    processors = ", ".join(sorted(set(table["cpu"].dropna())))
    versions = ", ".join(sorted(set(table["code_version"].dropna())))
    return f"{core_seconds(table):.0f} core-seconds, {steps:.3g} particle-steps, on {processors}; code {versions}"


def core_seconds(table):
    """Return the wall times of the runs times their threads, summed [s]."""
    return float((table["wall_s"] * table["threads"].fillna(1)).sum())


def values(column):
    """Return the different values of a column in words."""
    return ", ".join(number(value) for value in sorted(column.unique()))


def number(value):
    """Return a value of a table in words."""
    return f"{value:g}" if isinstance(value, (int, float)) and not isinstance(value, bool) else str(value)


def section_text(campaign, section):
    """Return one figure with its caption and its claims as Markdown."""
    image = f"![{section.title}](figures/{campaign.plan['name']}-{section.figure}.png)"
    heading = "| claim | source | expected | measured | rule | verdict | settings | runs, core-s |"
    rows = [claim_row(campaign.table, claim) for claim in section.claims]
    return "\n\n".join([f"### {section.title}", image, section.caption, "\n".join([heading, "|---" * 8 + "|", *rows])])


def claim_row(table, claim):
    """Return one claim as a row of a Markdown table."""
    runs = table[table["run"].isin(claim.runs)]
    verdict = f"**{claim.verdict.value}**"
    cells = [claim.text, claim.source, claim.expected, claim.number, claim.rule, verdict, claim.settings]
    cells.append(f"{len(runs)}, {core_seconds(runs):.0f}" if len(runs) else "none")
    return "| " + " | ".join(str(cell).replace("|", "\\|") for cell in cells) + " |"


# ---- all campaigns ---------------------------------------------------------------------------------------------------


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
    """Return (campaign's name, Markdown) of the report in a campaign's folder; RunError if there is none."""
    from .campaigns import Campaign

    try:
        return Campaign.of(folder).plan["name"], (folder / "report.md").read_text(encoding="utf-8").strip()
    except FileNotFoundError:
        raise RunError(
            f"{folder} holds no report.md: call scripts/campaign first, with a `report:` in its file"
        ) from None


def stored_sections(target):
    """Return {campaign's name: Markdown} of the sections of RESULTS.md; empty if there is none yet."""
    text = target.read_text(encoding="utf-8") if target.exists() else ""
    return {match["name"]: match["text"] for match in SECTIONS.finditer(text)}


def copy_figures(folder, target):
    """Copy the PNG figures of a campaign, each in one step."""
    target.mkdir(exist_ok=True)
    for source in sorted((folder / "figures").glob("*.png")):
        temporary = target / f".{source.name}.tmp"
        shutil.copyfile(source, temporary)
        os.replace(temporary, target / source.name)


def main(arguments):
    """Publish the campaigns that the arguments name; return the exit code: 0, or 2 after one line on stderr."""
    if not arguments or {"help", "-h", "--help"} & set(arguments):
        print("usage: scripts/results CAMPAIGN-FOLDER …   (puts their reports into studies/RESULTS.md)")
        return 0 if arguments else 2
    try:
        print(f"graindrive: see {publish(arguments, Path(__file__).resolve().parents[1] / 'studies')}", file=sys.stderr)
        return 0
    except (RunError, OSError) as error:
        print(f"graindrive.postproc.results: error: {error}", file=sys.stderr)
        return 2


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
