"""Report of a drum campaign."""

from ..campaign.planned import Report

REPORT = Report("drum", "Drum", {}, ())
