"""Books on trial: scenes that no tuning saw, inside what a book covers, with what `accuracy=` takes and with the reference."""

from dataclasses import dataclass

import numpy as np

from ..commands.command_line import parse
from ..base.errors import UsageError
from ..commands.parameter_values import argument
from ..accuracy import book as books
from ..accuracy.effects import CONFIDENCE, NOTHING
from .trials import Trial, Trials
from ..accuracy.words import in_words

FIRST_SEED = 1001  # far from those of any tuning
SLACK = 1.0001  # over a setting's bound: the accuracy for which it is just good enough


@dataclass(frozen=True)
class Point:
    """One scene on trial: `asked` is the relative error allowed, `taken` what the study took for it, `error` what came out.

    `predicted` and `measured` are processor times [s] of the run with the levers taken, `reference` that of the reference.
    """

    study: str
    book: str
    scene: dict
    observable: str
    asked: float
    taken: tuple
    error: float
    predicted: float
    measured: float
    reference: float

    @property
    def holds(self):
        """True if the error is within what was asked for."""
        return self.error <= self.asked


def drawn_scenes(book, count, seed):
    """Return `count` scenes inside a book's cover: keys that had several numbers are drawn between them, words among them.

    Numbers whose range spans more than a factor of three are drawn by their logarithm.
    """
    random, scenes = np.random.default_rng(seed), []
    keys = list(book.scenes[0])
    for _ in range(count):
        scene = {}
        for key in keys:
            values = list(dict.fromkeys(s[key] for s in book.scenes))
            scene[key] = values[0] if len(values) == 1 else between(random, values)
        scenes.append(scene)
    return scenes


def between(random, values):
    """Return a random number within the range of `values`, or one of them where they are words or switches."""
    if not all(isinstance(v, (int, float)) and not isinstance(v, bool) for v in values):
        return values[random.integers(len(values))]
    low, high = min(values), max(values)
    if low > 0 and high > 3 * low:
        value = float(np.exp(random.uniform(np.log(low), np.log(high))))
    else:
        value = float(random.uniform(low, high))
    return round(value) if all(isinstance(v, int) for v in values) else float(f"{value:.4g}")


def accuracies(book, observable):
    """Return the errors for which some setting of the book is the cheapest that will do, the smallest first.

    Not those for which that is the reference: against itself a run has no error.
    """
    known = [s for s in book.settings if s.effects.get(observable, NOTHING).bound(CONFIDENCE) * SLACK < 1]
    found, least = [], np.inf
    for setting in sorted(known, key=lambda s: s.effects[observable].bound(CONFIDENCE)):
        if setting.core_seconds < least:
            least = setting.core_seconds
            found += [setting.effects[observable].bound(CONFIDENCE) * SLACK] if setting.levers else []
    return found


def can_be_tried(study, book, observable):
    """True if a book has a setting, besides the reference, whose error of `observable`, "" for the headline, is below 100 %."""
    return bool(accuracies(book, observable or study.headline.name))


def points_of(study, study_file, book, folder, count, cores, seed, observable=""):
    """Return `count` `Point`s of a book, with their runs in `folder`; runs that are there are not made again.

    `observable` is the one whose error is asked for, "" for the headline.
    """
    observable = observable or study.headline.name
    errors = accuracies(book, observable)
    if not errors:
        raise UsageError(
            f"{book.file}: no setting but the reference has an error of {observable} that is known to be below 100 %"
        )
    trials = Trials(study, study_file, folder, drawn_scenes(book, count, seed), dict(book.reference), folder)
    asked = [errors[k % len(errors)] for k in range(count)]
    taken = [choice_for(study, trials.scenes[k], f"{observable}:{asked[k]:.6g}", FIRST_SEED + k) for k in range(count)]
    settings = [tuple(sorted(t.choice.setting.levers.items())) for t in taken]
    wanted = [Trial(s, k, FIRST_SEED + k) for k in range(count) for s in dict.fromkeys([(), settings[k]])]
    trials.make(wanted, cores)
    found = []
    for k in range(count):
        one, reference = (trials.outcomes.get(Trial(s, k, FIRST_SEED + k)) for s in (settings[k], ()))
        if one is None or reference is None:
            lost = trials.failed.get(Trial(settings[k], k, FIRST_SEED + k)) or trials.failed.get(
                Trial((), k, FIRST_SEED + k)
            )
            raise UsageError(f"{book.file}: a run of {in_words(settings[k])} in {trials.scenes[k]} did not end: {lost}")
        value, there = one.found[observable][0], reference.found[observable][0]
        error = abs(value - there) / abs(there) if there else np.inf
        factor = taken[k].choice.setting.cost_factor
        predicted = (
            factor * study.cost.core_seconds(one.parameters) if study.cost else taken[k].choice.setting.core_seconds
        )
        found.append(
            Point(
                study.name,
                book.file,
                trials.scenes[k],
                observable,
                asked[k],
                settings[k],
                float(error),
                float(predicted),
                one.core_seconds,
                reference.core_seconds,
            )
        )
    return found


def choice_for(study, scene, accuracy, seed):
    """Return what the study takes for an `accuracy`, as NAME:0.05, in a scene; UsageError where it does not find the book."""
    words = [
        argument(study.parameters, key, value) for key, value in {**scene, "seed": seed, "unused": "allow"}.items()
    ]
    p = parse(study, [*words, f"accuracy={accuracy}"], environment={})
    if p.choice.setting is None:
        raise UsageError(f"{' '.join(words)}: {p.choice.words}")
    return p


def books_of(names):
    """Return the books in `names`, files or names of those shipped, all of them for none; UsageError for a name that is none."""
    known = {book.file.removesuffix(".json"): book for book in books.shipped(books.FOLDER)}
    if not names:
        return list(known.values())
    for name in names:
        if name not in known:
            raise UsageError(f"there is no book of measured settings '{name}'; there are: {' '.join(known) or 'none'}")
    return [known[name] for name in names]
