"""Campaigns: a YAML of values becomes runs, made by Snakemake, one rule per run folder, then a table and a report."""
