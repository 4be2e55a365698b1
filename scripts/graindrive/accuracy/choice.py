"""`accuracy=5%` of any study: the cheapest measured setting whose error stays below that, or the paper's with a word why."""

import math
import re
from dataclasses import dataclass

from ..base.errors import UsageError
from ..base.numbers import with_error
from . import book as books
from .effects import CONFIDENCE, NOTHING
from .words import in_words

ROUNDED = 1e-6  # so that an error's text, rounded up, is never below it
LARGEST = 0.99  # an error that may be asked for must be below 100 % when it is rounded up


@dataclass(frozen=True)
class Asked:
    """An accuracy that a user asks for: of which observable, and how large its relative error may be [-]."""

    observable: str
    error: float


@dataclass(frozen=True)
class Choice:
    """What was taken for an accuracy: all `levers`, why in `words`; from a `book` its `setting`, None where none would do."""

    levers: dict
    words: str
    book: object = None
    setting: object = None

    def facts(self):
        """Return what a run's provenance keeps of the choice: words, and the book with the code that made it."""
        facts = dict(accuracy_choice=self.words)
        if self.book:
            facts.update(accuracy_book=self.book.file, accuracy_book_code=self.book.code_version)
        return facts

    def bound(self, observable):
        """Return the largest relative error of an observable at `CONFIDENCE` [-]; nan where it was not measured."""
        return self.setting.effects[observable].bound(CONFIDENCE) if self.setting else math.nan


def asked_of(study, text, key="accuracy"):
    """Return what a key, accuracy or a tuning's target, asks for: "5%", "0.05" or "drag:5%"; UsageError with rule and example."""
    match = re.fullmatch(r"(?:(\w+):)?([0-9.eE+-]+)(%?)", text.strip())
    names = [o.name for o in study.observables]
    if study.headline is None:
        raise UsageError(
            f"{key}={text}: study {study.name} names no observable, so nothing can have an error; leave it out"
        )
    name = match[1] if match and match[1] in names else study.headline.name
    try:
        error = float(match[2]) * (0.01 if match[3] else 1.0)
    except (TypeError, ValueError):
        raise UsageError(
            f"{key}={text} must be a share as 5% or 0.05, or that of an observable as drag:5%; {example(study, name, key)}"
        ) from None
    if not 0 < error < 1:
        hint = f"write {key}={text.strip()}% for percents; " if 1 <= error < 100 and not match[3] else ""
        raise UsageError(f"{key}={text} must lie between 0 and 100 %; {hint}{example(study, name, key)}")
    if match[1] and match[1] not in names:
        raise UsageError(
            f"{key}={text}: {study.name} measures no {match[1]}; it measures {', '.join(names)}; {example(study, name, key)}"
        )
    return Asked(name, error)


def example(study, name, key):
    """Return in words what a user may type: for accuracy the smallest error of the observable `name` that a book has."""
    if key != "accuracy":
        return f"for example {key}=5%"
    known = [s.effects[name].bound(CONFIDENCE) for b in books.of_study(study) for s in b.settings if name in s.effects]
    if not (least := min(known, default=1)) < LARGEST:
        return f"no error of {name} was measured: leave accuracy out"
    return f"for example scripts/run {study.name} {as_asked(study, name, least)}, the smallest measured, or leave accuracy out"


def as_asked(study, name, error):
    """Return the argument that asks for a relative error [-] of an observable, rounded up to two digits: "accuracy=drag:5.1%"."""
    percent = 100 * error * (1 + ROUNDED)
    step = 10.0 ** (math.floor(math.log10(percent)) - 1)
    of = "" if name == study.headline.name else f"{name}:"
    return f"accuracy={of}{math.ceil(percent / step) * step:.2g}%"


def chosen(study, text, made, given):
    """Return the `Choice` for `accuracy=text`.

    `made(levers)` gives the parameters with these levers in place of the scale's, `given` holds the levers that the user
    gave. A book counts if its scenes hold the run's, and if its reference is no cheaper than the scale's own levers: else its
    errors are against something coarser than what was asked for.
    """
    asked, reasons, found = asked_of(study, text), [], []
    usual = made({})
    for book in books.of_study(study):
        reason = coarser(study, book, usual, given) or book.outside(made(book.reference))
        if reason:
            reasons.append(reason)
            continue
        kept = [s for s in book.settings if is_open(study, made, book, s, given)]
        good = [s for s in kept if s.effects.get(asked.observable, NOTHING).bound(CONFIDENCE) <= asked.error]
        found += [(seconds(study, made, book, s), book, s) for s in good]
        if not good:
            reasons.append(
                best_of(study, kept, asked)
                if kept
                else f"no setting was measured with {in_words(sorted(given.items()))}"
            )
    if found:
        cost, book, setting = min(found, key=lambda f: f[0])
        levers = {key: value for key, value in book.levers_of(setting).items() if key not in given}
        return Choice(levers, reason_of(asked, book, setting, cost), book, setting)
    paper = study.usual("paper") if "paper" in study.presets else study.usual(next(iter(study.presets)))
    levers = {key: getattr(paper, key) for key in study.levers if key not in given}
    why = "; ".join(dict.fromkeys(reasons)) or "nothing of this study was measured"
    told = sorted((key, value) for key, value in levers.items() if key not in usual.not_used())
    words = f"no measured setting will do ({why}): the paper's settings, {in_words(told)}"
    if study.cost and any(getattr(usual, key) != value for key, value in levers.items()):
        cost = study.cost.in_words(made(levers))
        words += f"; that is {cost} of one core; leave accuracy out for the settings of scale={usual.scale}"
    return Choice(levers, words)


def is_open(study, made, book, setting, given):
    """True if a setting agrees with the levers that the user gave, and the study takes it in this scene."""
    levers = book.levers_of(setting)
    if not all(books.alike(levers.get(key), value) for key, value in given.items() if key in book.reference):
        return False
    try:
        study.check(made(levers))
    except UsageError:
        return False
    return True


def coarser(study, book, usual, given):
    """Return in words which lever of the scale is more accurate than the book's reference; "" if none is."""
    for key, reference in book.reference.items():
        lever, value = study.levers.get(key), getattr(usual, key, None)
        if lever is None or key in given or isinstance(reference, str) or None in (reference, value):
            continue
        if value > reference if lever.cheaper == "lower" else value < reference:
            return f"{key}={value:g} is more accurate than the measured reference, {reference:g}"
    return ""


def seconds(study, made, book, setting):
    """Return the processor time [s] that a run with a setting will take: the study's estimate times the measured factor."""
    if study.cost is None:
        return setting.core_seconds
    return setting.cost_factor * study.cost.core_seconds(made(book.levers_of(setting)))


def best_of(study, settings, asked):
    """Return in words how far the best of the settings is known, what to ask for to get it, and how many seeds would do."""
    measured = [s for s in settings if math.isfinite(s.effects.get(asked.observable, NOTHING).bound(CONFIDENCE))]
    if not measured:
        return f"{asked.observable} has no measured error"
    least = min(s.effects[asked.observable].bound(CONFIDENCE) for s in measured)
    words = f"the smallest measured error of {asked.observable} is {100 * least:.2g} %"
    words += f", which {as_asked(study, asked.observable, least)} takes" if least < LARGEST else ""
    runs = {id(s): s.effects[asked.observable].runs_for(asked.error, CONFIDENCE) for s in measured}
    enough = [s for s in measured if math.isfinite(runs[id(s)])]
    if not enough:
        return words
    best = min(enough, key=lambda s: runs[id(s)] * s.core_seconds)
    return f"{words}; the mean over {runs[id(best)]} seeds of {in_words(sorted(best.levers.items()))} would do"


def reason_of(asked, book, setting, cost):
    """Return in words what was chosen and why."""
    effect = setting.effects[asked.observable]
    levers = in_words(sorted(setting.levers.items()))
    return (
        f"{levers}: {asked.observable} off by {with_error(100 * effect.bias, 100 * effect.error)} %, mean of {effect.runs} runs"
        f" ({book.file}), one run by less than {100 * effect.bound(CONFIDENCE):.2g} % at {100 * CONFIDENCE:.0f} % confidence;"
        f" about {cost:.0f} s of one core"
    )
