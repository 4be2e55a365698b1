"""Which run of a tuning comes next: the reference, then each lever alone down its ladder, then the good ones together."""

from dataclasses import dataclass

import numpy as np

from .trials import Trial

FEWEST_SEEDS, MOST_SEEDS = 2, 6
WORTH_IT = 0.97  # of the cost of the rung before: one that saves less ends its ladder
GOOD, BAD, UNDECIDED, FAILED, SAVES_NOTHING, OPEN = (  # verdicts
    "good",
    "changes too much",
    "cannot be told from the noise",
    "fails",
    "saves nothing",
    "needs more runs",
)


@dataclass
class Search:
    """Decides by what the `trials` gave; it keeps nothing else, so a tuning that was stopped goes on as it would have.

    `ladders` maps levers to their values, nearest to the reference first. A setting is good when the bias of `observable`
    lies below `target` with `confidence`.
    """

    trials: object
    ladders: dict
    observable: str
    target: float
    confidence: float
    most_seeds: int = MOST_SEEDS
    fewest_seeds: int = FEWEST_SEEDS

    def next_trials(self, left):
        """Return the trials to make next, the largest savings first, within `left` core-seconds; none at the end."""
        start = self.repeats((), self.fewest_seeds)
        if start:
            return start
        wanted = [t for t in (self.next_of(key) for key in self.ladders) if t]
        wanted = wanted or [t for t in [self.next_together()] if t]
        wanted.sort(key=lambda group: -self.saving(group))
        taken, cost = [], 0.0
        for group in wanted:
            seconds = sum(self.trials.expected_seconds(trial) for trial in group)
            if cost + seconds <= left:
                taken, cost = taken + group, cost + seconds
        return taken

    def repeats(self, setting, seeds):
        """Return the trials of a setting, and of the reference with the same seeds, that are missing up to so many seeds."""
        places = [(scene, seed) for seed in range(1, seeds + 1) for scene in range(len(self.trials.scenes))]
        wanted = [Trial(s, scene, seed) for scene, seed in places for s in dict.fromkeys([(), setting])]
        return [t for t in wanted if t not in self.trials.outcomes and t not in self.trials.failed]

    def saving(self, group):
        """Return the share of the reference's cost that the group's setting is expected to save."""
        trial = group[-1]
        cost = self.trials.study.cost
        if cost is None:
            return 0.0
        here, there = (
            cost.core_seconds(self.trials.planned(t).parameters) for t in (trial, Trial((), trial.scene, trial.seed))
        )
        return 1 - here / there

    def seeds_of(self, setting):
        """Return how many seeds a setting has in all scenes."""
        count = len(self.trials.scenes)
        found = [sum(scene == k for scene, _ in self.trials.of(setting)) for k in range(count)]
        return min(found)

    def judge(self, setting):
        """Return what is known of a setting: GOOD, BAD, FAILED, UNDECIDED with as many seeds as are allowed, or OPEN."""
        if any(trial.setting == setting for trial in self.trials.failed):
            return FAILED
        seeds = self.seeds_of(setting)
        if seeds < self.fewest_seeds:
            return OPEN
        effect = self.trials.effect(setting, self.observable)
        half = effect.interval(self.confidence)
        if abs(effect.bias) + half <= self.target:
            return GOOD
        if abs(effect.bias) - half > self.target:
            return BAD
        return OPEN if seeds < self.most_seeds else UNDECIDED

    def saves(self, setting, before):
        """True if a setting costs less than the one before it on the ladder."""
        return self.trials.cost(setting) < WORTH_IT * self.trials.cost(before)

    def walk(self, key):
        """Yield (value, verdict) down a lever's ladder as far as it was walked; it ends at the first value that is not good."""
        before = ()
        for value in self.ladders[key]:
            setting = ((key, value),)
            verdict = self.judge(setting)
            if verdict == GOOD and not self.saves(setting, before):
                verdict = SAVES_NOTHING
            yield value, verdict
            if verdict != GOOD:
                return
            before = setting

    def next_of(self, key):
        """Return the trials that a lever needs next; none where it is settled."""
        for value, verdict in self.walk(key):
            if verdict == OPEN:
                setting = ((key, value),)
                return self.repeats(setting, max(self.fewest_seeds, self.seeds_of(setting) + 1))
        return []

    def best(self):
        """Return {lever: its cheapest good value}."""
        found = {key: [value for value, verdict in self.walk(key) if verdict == GOOD] for key in self.ladders}
        return {key: values[-1] for key, values in found.items() if values}

    def combinations(self):
        """Yield settings of the good levers together: all, then without the one that changes most, and so on."""
        best = self.best()
        size = {key: abs(self.trials.effect(((key, value),), self.observable).bias) for key, value in best.items()}
        keys = sorted(best, key=size.get)
        while len(keys) > 1:
            yield tuple(sorted((key, best[key]) for key in keys))
            keys = keys[:-1]

    def next_together(self):
        """Return the trials that the levers together need next; none when a combination is good, or none is left."""
        for setting in self.combinations():
            verdict = self.judge(setting)
            if verdict == OPEN:
                return self.repeats(setting, max(self.fewest_seeds, self.seeds_of(setting) + 1))
            if verdict == GOOD:
                return []
        return []

    def chosen(self):
        """Return the cheapest setting that is good; the empty one where none is."""
        good = [s for s in self.trials.settings if not s or self.judge(s) == GOOD]
        return min(good, key=lambda s: np.nan_to_num(self.trials.cost(s), nan=np.inf)) if good else ()
