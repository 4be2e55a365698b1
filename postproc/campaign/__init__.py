"""Campaigns: their runs as a table, claims with verdicts, figures with captions, reports, and RESULTS.md."""
