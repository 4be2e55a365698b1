"""The report of a campaign as Markdown: what was run at what cost, then figures with captions, claims and verdicts."""

import sys
from dataclasses import replace
from urllib.parse import quote

from ...base.whole_files import write_text
from .. import figures
from ..reader import RunError
from . import plain
from .folder import Campaign
from .verdicts import tally
from .what_was_run import core_seconds, settings, table_of


def write_report(folder, report=None, observables=()):
    """Write `table.csv` and, where there are runs, figures and `report.md`; return the last written.

    A `Report` makes them of a paper's claims. Without one the `observables` of the study, or all quantities of its summary
    that have an error, are drawn against the keys that were varied.
    """
    campaign = Campaign.of(folder)
    table = campaign.folder / "table.csv"
    write_text(table, campaign.with_units(campaign.as_measured).to_csv(index=False))
    if campaign.as_measured.empty:
        return table
    (campaign.folder / "figures").mkdir(exist_ok=True)
    written = campaign.folder / "report.md"
    write_text(written, claims_of_papers(campaign, report) if report else plain.as_markdown(campaign, observables))
    return written


def claims_of_papers(campaign, report):
    """Return a `Report` as Markdown; draws its figures."""
    campaign = replace(campaign, pooled=report.pooled)
    return as_markdown(campaign, report.title, sections_of(campaign, report.figures))


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


def section_text(campaign, section):
    """Return one figure with its caption and its claims as Markdown."""
    image = f"![{section.title}](figures/{quote(campaign.plan['name'])}-{section.figure}.png)"
    heading = ["claim", "source", "expected", "measured", "rule", "verdict", "settings", "runs, core-s"]
    rows = [claim_cells(campaign.table, claim) for claim in section.claims]
    return "\n\n".join([f"### {section.title}", image, section.caption, table_of(heading, rows)])


def claim_cells(table, claim):
    """Return the cells of one claim in a report's table."""
    runs = table[table["run"].isin(claim.runs)]
    cost = f"{len(runs)}, {core_seconds(runs):.0f}" if len(runs) else "none"
    verdict = f"**{claim.verdict.value}**"
    return [claim.text, claim.source, claim.expected, claim.number, claim.rule, verdict, claim.settings, cost]
