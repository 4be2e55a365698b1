"""What a campaign ran, in words: its keys, its runs, what they cost, and how to repeat it."""


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


def table_of(heading, rows):
    """Return a Markdown table of a heading and rows, each a sequence of cells."""
    return "\n".join(row_of(cells) for cells in (heading, ["---"] * len(heading), *rows))


def row_of(cells):
    """Return one row of a Markdown table."""
    return "| " + " | ".join(str(cell).replace("|", "\\|") for cell in cells) + " |"
