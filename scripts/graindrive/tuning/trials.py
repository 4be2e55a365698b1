"""Runs of a tuning: planned as a campaign's, made by its machinery, and read back as what they measured and cost."""

from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from ..runs import summary_file
from ..campaign import execution
from ..campaign.plan import Plan, planned_run
from ..accuracy import effects
from ..accuracy.effects import NOTHING, pooled

SWEEP = "tune"


@dataclass(frozen=True, order=True)
class Trial:
    """One run: `setting` is a tuple of (lever, value), the levers that are not at the reference; `scene` counts scenes."""

    setting: tuple
    scene: int
    seed: int


@dataclass(frozen=True)
class Outcome:
    """What a run gave: {observable: (value, standard error or nan)}, processor time [s], memory [MB], its parameters."""

    found: dict
    core_seconds: float
    memory: float
    parameters: object


@dataclass
class Trials:
    """The runs of a tuning of a `study`, whose file is `study_file`, in a `folder`, and what came of them.

    `scenes` are dicts of keys that are no levers, `reference` {lever: value}, `origin` the folder from which values name
    files. `outcomes` maps a `Trial` to its `Outcome`, `failed` to the last words of its log.
    """

    study: object
    study_file: Path
    folder: Path
    scenes: list
    reference: dict
    origin: Path
    outcomes: dict = field(default_factory=dict)
    failed: dict = field(default_factory=dict)
    asked: dict = field(default_factory=dict)

    def planned(self, trial):
        """Return the `PlannedRun` of a trial."""
        values = {**self.scenes[trial.scene], **self.reference, **dict(trial.setting), "seed": trial.seed}
        return planned_run(self.study.name, values, self.study)

    def make(self, trials, cores):
        """Have the runs of `trials` made that are not there, `cores` at a time, and read them all; signals are raised."""
        self.asked.update({trial: self.planned(trial) for trial in trials})
        runs = {}
        for run in self.asked.values():
            run.sweeps[:] = [SWEEP]
            runs[run.name] = run
        plan = Plan(self.folder.name, "", self.origin, self.study, self.study_file, None, list(runs.values()))
        with execution.opened(self.folder, plan) as lock:
            execution.set_damaged_aside(self.folder, plan)
            if execution.missing(self.folder, plan):
                execution.carry_out(self.folder, plan, cores, ["--quiet", "all"], lock)
            failures = execution.failures(self.folder, plan)
        for trial, run in self.asked.items():
            if run.name in failures:
                self.failed[trial] = failures[run.name]
            elif trial not in self.outcomes:
                self.outcomes[trial] = self.read(run)

    def read(self, run):
        """Return the `Outcome` of a complete run."""
        summary = summary_file.read(self.folder / "runs" / run.name)
        number = {name: np.nan if summary.get(name) is None else summary[name] for name in summary}
        found = {
            o.name: (number[o.name], number.get(f"{o.name}_err", np.nan))
            for o in self.study.observables
            if o.name in number
        }
        return Outcome(found, number["core_seconds"], number["peak_memory"], run.parameters)

    @property
    def settings(self):
        """The settings of which there is a run, the reference first."""
        return sorted({trial.setting for trial in self.outcomes}, key=lambda s: (len(s), s))

    def of(self, setting):
        """Return {(scene, seed): Outcome} of a setting."""
        return {(t.scene, t.seed): outcome for t, outcome in self.outcomes.items() if t.setting == setting}

    def effect(self, setting, name):
        """Return the `Effect` of a setting on an observable, from runs of the same scene and seed as at the reference."""
        base = self.of(())
        if not setting:
            return effects.of_reference([self.column(base, scene, name) for scene in range(len(self.scenes))])
        deviations, own = [], []
        for place, outcome in self.of(setting).items():
            if place not in base or name not in outcome.found or name not in base[place].found:
                continue
            scale = abs(np.mean(self.column(base, place[0], name)[0]))
            (value, error), (there, its_error) = outcome.found[name], base[place].found[name]
            if scale > 0:
                deviations.append((value - there) / scale)
                own.append(np.hypot(error, its_error) / scale)
        return pooled(deviations, own) if deviations else NOTHING

    @staticmethod
    def column(outcomes, scene, name):
        """Return (values, standard errors) of an observable over the seeds of a scene."""
        found = [
            outcome.found[name] for place, outcome in outcomes.items() if place[0] == scene and name in outcome.found
        ]
        values, errors = np.array(found, dtype=float).reshape(-1, 2).T
        return values, errors

    def cost(self, setting):
        """Return the mean processor time [s] of a setting's runs; nan without one."""
        seconds = [outcome.core_seconds for outcome in self.of(setting).values()]
        return float(np.mean(seconds)) if seconds else np.nan

    def cost_factor(self, setting=None):
        """Return the median of measured over estimated processor time, of a setting's runs or of all; 1 where nobody knows."""
        cost = self.study.cost
        outcomes = self.outcomes.values() if setting is None else self.of(setting).values()
        ratios = [o.core_seconds / cost.core_seconds(o.parameters) for o in outcomes] if cost else []
        return float(np.median(ratios)) if ratios else 1.0

    def expected_seconds(self, trial):
        """Return the processor time [s] that a trial will take: the study's estimate times what such runs took over theirs.

        For a setting of which there is no run yet the worst factor of all settings counts, so that a budget is kept.
        """
        if trial in self.outcomes:
            return 0.0
        if self.study.cost is None:
            return self.cost(()) if self.of(()) else 0.0
        known = [trial.setting] if self.of(trial.setting) else self.settings
        factor = max(map(self.cost_factor, known), default=1.0)
        return factor * self.study.cost.core_seconds(self.planned(trial).parameters)

    @property
    def spent(self):
        """Processor time [s] of all runs."""
        return float(sum(outcome.core_seconds for outcome in self.outcomes.values()))
