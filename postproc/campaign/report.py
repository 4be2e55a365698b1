"""The report of a campaign as Markdown: what was run at what cost, then figures with captions, claims and verdicts."""

import sys
from dataclasses import replace
from urllib.parse import quote

from ...base.whole_files import write_text
from .. import figures
from ..reader import RunError
from .folder import Campaign
from .verdicts import tally


def write_report(folder, report=None):
    """Write `table.csv` and, with a `Report` and runs, its figures and `report.md`; return the last written."""
    campaign = Campaign.of(folder)
    table = campaign.folder / "table.csv"
    write_text(table, campaign.with_units(campaign.as_measured).to_csv(index=False))
    if report is None:
        return table
    campaign = replace(campaign, pooled=report.pooled)
    if campaign.table.empty:
        return table
    (campaign.folder / "figures").mkdir(exist_ok=True)
    write_text(
        campaign.folder / "report.md", as_markdown(campaign, report.title, sections_of(campaign, report.figures))
    )
    return campaign.folder / "report.md"


def sections_of(campaign, planned_figures):
    """Draw the figures that the campaign's runs allow, into its folder `figures`; return their `Section`s.

    A figure that needs a run which cannot be read is left out, with a line that names the run.
    """
    made = []
    with figures.plt.rc_context(figures.STYLE):
        for planned in planned_figures:
            try:
                made += [] if campaign.sweep(planned.sweep).empty else [planned.made(campaign)]
            except RunError as error:
                print(f"campaign: figure {planned.name} is left out: {error}", file=sys.stderr)
    return made


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
            *(
                f"Repeats of `{name}` scatter {factor:.2f} times as much as the runs' own errors say, over all settings together;"
                " its errors are those of the runs times this."
                for name, factor in campaign.widened.items()
            ),
        ]
    )


def cost(table):
    """Return in words what the runs of a table cost, on which processors, by which code."""
    processors = ", ".join(sorted(set(table["cpu"].dropna())))
    versions = ", ".join(sorted(set(table["code_version"].dropna())))
    parts = [f"{core_seconds(table):.0f} core-seconds", work(table), f"on {processors}; code {versions}"]
    return ", ".join(filter(None, parts))


def work(table):
    """Return in words the work of the runs of a table: particle-steps, of a study without grains its steps, "" if none counts."""
    if "steps" not in table:
        return ""
    if "n_grains" in table:
        return f"{(table['steps'] * table['n_grains']).sum():.3g} particle-steps"
    return f"{table['steps'].sum():.3g} steps"


def core_seconds(table):
    """Return the wall times of the runs times their threads, summed [s]."""
    return float((table["wall_s"] * table["threads"].fillna(1)).sum())


def values(column):
    """Return the different values of a column in words."""
    return ", ".join(number(value) for value in sorted(column.unique(), key=lambda v: (isinstance(v, str), v)))


def number(value):
    """Return a value of a table in words."""
    return f"{value:g}" if isinstance(value, (int, float)) and not isinstance(value, bool) else str(value)


def section_text(campaign, section):
    """Return one figure with its caption and its claims as Markdown."""
    image = f"![{section.title}](figures/{quote(campaign.plan['name'])}-{section.figure}.png)"
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
