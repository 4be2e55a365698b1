"""A campaign's folder: its plan, and its runs as one table."""

import sys
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import pandas as pd

from ...runs import summary_file
from ...campaign import plan_json
from ..measured import birge_ratio
from ..reader import Run, RunError
from .runs import measurements

FACTS = ("cpu", "code_version", "threads")  # of a run's provenance that the table holds
NOT_IN_TABLE = (
    "out",
    "resume",
    "checkpoint_seconds",
    "redo",
    "vtk",
    "export",
    "film",
    "unused",
)  # keys that say nothing of the result


@dataclass(frozen=True)
class Campaign:
    """A campaign's `folder` and its `plan` (the content of campaign.json); raises RunError if the folder has none.

    `pooled` names quantities whose errors the table widens to the scatter of repeats over the whole campaign.
    """

    folder: Path
    plan: dict
    pooled: tuple = ()

    @classmethod
    def of(cls, folder):
        """Open the campaign in `folder`."""
        try:
            return cls(Path(folder), plan_json.read(folder))
        except plan_json.PlanError as error:
            raise RunError(str(error)) from None

    @cached_property
    def table(self):
        """One row per complete run: name, sweeps, all keys, all quantities of its summary; sorted by keys.

        A quantity that is named like a key but differs from it (a packing's phi) stands under NAME_measured.
        """
        table = self.as_measured
        factors = {f"{name}_err": pd.to_numeric(table[f"{name}_err"]) * factor for name, factor in self.widened.items()}
        return table.assign(**factors)

    @cached_property
    def as_measured(self):
        """The table with the errors that each run gave."""
        rows = [row for row in map(self.row, self.plan["runs"]) if row]
        table = without_copies(pd.DataFrame(rows, columns=None if rows else ["run", "sweeps"]))
        return table.sort_values(self.varied(table) or ["run"], kind="stable", ignore_index=True, key=sortable)

    @cached_property
    def widened(self):
        """Return {quantity: the factor, 1 or more, by which repeats scatter more than their errors say} for `pooled` ones."""
        table = self.as_measured
        settings = [key for key in self.varied(table) if key != "seed"]
        keys = settings[0] if len(settings) == 1 else settings
        groups = [group for _, group in table.groupby(keys, dropna=False)] if settings else [table]
        known = [name for name in self.pooled if {name, f"{name}_err"} <= set(table)]
        return {name: birge_ratio([measurements(group, name) for group in groups]) for name in known}

    def row(self, planned):
        """Return the table's row of one planned run; None if it is not complete."""
        try:
            run = self.run(planned["name"])
            if run.state != "complete" or not run.summary:
                return None
        except RunError as error:
            if (self.folder / "runs" / planned["name"]).is_dir():
                print(f"campaign: {error}; it is left out", file=sys.stderr)
            return None
        keys = {key: value for key, value in run.parameters.items() if key not in NOT_IN_TABLE}
        values, _ = summary_file.parted(run.summary)
        measured = {f"{k}_measured" if k in keys else k: v for k, v in values.items() if v is not None}
        facts = {fact: run.provenance.get(fact) for fact in FACTS}
        return {"run": planned["name"], "sweeps": " ".join(planned["sweeps"]), **keys, **measured, **facts}

    def with_units(self, table):
        """Return a table with a column NAME_unit at its end for every key and quantity that has a unit."""
        units = [{f"{k}_unit": u for k, u in self.units(name).items() if k in table} for name in table["run"]]
        return pd.concat([table, pd.DataFrame(units, index=table.index)], axis=1)

    def units(self, name):
        """Return {column: unit} of a run's keys and quantities; pure numbers and words are left out."""
        run = self.run(name)
        keys = {key: run.units[key] for key in run.parameters if key not in NOT_IN_TABLE}
        _, told = summary_file.parted(run.summary)
        told.update({f"{key}_measured": unit for key, unit in told.items() if key in keys})
        return {column: unit for column, unit in {**keys, **told}.items() if unit not in ("-", "")}

    def run(self, name):
        """Open one run folder."""
        return Run(self.folder / "runs" / name)

    def keys(self, table):
        """Return the study's keys that are columns of the table."""
        first = next((self.run(name) for name in table["run"]), None)
        return [key for key in first.parameters if key in table] if first else []

    def varied(self, table):
        """Return the keys that are not the same in all runs, the seed last."""
        keys = [key for key in self.keys(table) if table[key].nunique(dropna=False) > 1]
        return sorted(keys, key=lambda key: key == "seed")

    def common(self, table):
        """Return {key: value} of the keys that are the same in all runs."""
        return {key: table[key].iloc[0] for key in self.keys(table) if table[key].nunique(dropna=False) == 1}

    def sweep(self, name):
        """Return the rows of the table that belong to a sweep."""
        return self.table[[name in sweeps.split() for sweeps in self.table["sweeps"]]]


def without_copies(table):
    """Return a table without the columns NAME_measured that say in every run what the key NAME says."""
    measured = {name: name.removesuffix("_measured") for name in table if name.endswith("_measured")}
    copies = [
        name
        for name, key in measured.items()
        if key in table and all(a == b or pd.isna(a) for a, b in zip(table[name], table[key]))
    ]
    return table.drop(columns=copies)


def sortable(column):
    """Return a column as it can be sorted: one that holds words and numbers (`auto` beside 60) by its text."""
    return column.astype(str) if len(set(column.map(lambda value: isinstance(value, str)))) > 1 else column
