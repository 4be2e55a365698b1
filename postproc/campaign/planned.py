"""What papers say, as a report: figures of sweeps, each with the claims that it tests; nothing is read or drawn here."""

from dataclasses import dataclass

from .. import figures


@dataclass(frozen=True)
class Report:
    """What a study has papers claim: `name` as a campaign's file gives it, `title`, and the `PlannedFigure`s.

    `sweeps` maps the names of sweeps that the figures look at to what such a sweep should hold; `pooled` names quantities
    whose errors the report widens to the scatter of repeats over the whole campaign.
    """

    name: str
    title: str
    sweeps: dict
    figures: tuple
    pooled: tuple = ()


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

    `claims(campaign, rows)` tests the paper's claims on the sweep's rows, `draw(campaign, rows)` returns the figure.
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
        figures.save_as(self.draw(campaign, rows), campaign.folder / "figures", f"{campaign.plan['name']}-{self.name}")
        return Section(self.title, self.name, self.caption, claims)
