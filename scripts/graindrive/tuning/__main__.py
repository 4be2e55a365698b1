"""The command `scripts/tune`: measure within a budget what a study's levers change and cost, and choose among them."""

import os
import shlex
import subprocess
import sys
from pathlib import Path

from ..base import output, signals, whole_files
from ..campaign import execution
from ..commands.command_line import split
from ..base.errors import UsageError, one_line
from ..commands.headless import guarded
from ..commands.parameter_values import argument_text, convert
from ..postproc.tuning import held_out as held_out_report
from ..postproc.tuning.report import write_report
from ..runs.provenance import code_version, cpu_model
from ..commands.started import study_file
from ..study import duration, loaded
from ..accuracy import book, choice
from . import held_out, ladder
from ..accuracy.effects import CONFIDENCE
from .search import FEWEST_SEEDS, MOST_SEEDS, Search
from .trials import Trials
from ..accuracy.words import in_words, shown

NAME = "tune"
USUAL = dict(budget="30min", target="5%", vary="", seeds=str(MOST_SEEDS), cores=str(os.cpu_count()), out="")
UNITS = dict(s=1, min=60, h=3600)
USAGE = """usage: scripts/tune STUDY [key=value …] [budget=30min] [target=5%] [vary=KEY,…] [seeds=6]
                         [cores=N] [out=DIR] [-n] [--launch]
       scripts/tune check [BOOK …] [points=5] [observable=NAME] [cores=N] [out=DIR]

Starts from the study's most accurate levers, or those that are given, and varies each alone towards cheaper values, then
the good ones together. Keys that are no levers may have several values, as phi=0.352,0.6: each is a scene.
budget: processor time that the runs may take (90s, 30min, 2h)      target: relative error of the headline, or NAME:5%
vary: the levers to vary; without it all                             seeds: repeats of a setting at most
-n: only say what would be varied, and the reference's cost         --launch: then run the study with what was chosen
check: runs scenes that no tuning saw, drawn inside what the books of studies/data cover, with what accuracy= takes for them"""


def main(arguments):
    """Carry out what the command line asks for; return the exit code."""
    if not arguments or {"help", "-h", "--help"} & set(arguments):
        print(USAGE)
        return 0 if arguments else UsageError.exit_code
    outcome = []
    code = guarded(lambda: outcome.append(tune(arguments)), NAME)
    return code or outcome[0]


def tune(arguments):
    """Measure, report, and with --launch run; return the exit code."""
    if arguments[0] == "check":
        return check(arguments[1:])
    flags = {a for a in arguments if a.startswith("-")}
    if flags - {"-n", "--launch"}:
        raise UsageError(f"there is no option {one_line(min(flags - {'-n', '--launch'}))}; there are -n and --launch")
    name, *words = [a for a in arguments if a not in flags]
    file = study_file(name)
    study = loaded(file)
    options, keys = parted(study, words)
    target = choice.asked_of(study, options["target"], "target")
    scenes, given = scenes_of(study, keys)
    reference = ladder.reference_of(study, given)
    parameters = [ladder.parameters_of(study, {**scene, **reference}) for scene in scenes]
    refuse_unused(keys, parameters)
    vary = varied(study, options["vary"], parameters)
    ladders = {key: ladder.rungs(study, {**scenes[0], **reference}, key) for key in vary}
    out = Path(options["out"] or f"tune_{study.name}").absolute()
    trials = Trials(study, file, out, scenes, reference, Path.cwd())
    found = {key: values for key, (values, _) in ladders.items()}
    seeds = seeds_of(parameters, whole(options, "seeds"))
    search = Search(trials, found, target.observable, target.error, CONFIDENCE, max(seeds), min(seeds))
    tell_plan(search, ladders, options)
    if "-n" in flags:
        return 0
    with execution.nothing_in_the_way(out), signals.handled():
        carry_out(search, seconds_of(options["budget"]), whole(options, "cores"))
        if not trials.of(()):
            raise UsageError(
                f"no run of the reference ended: {next(iter(trials.failed.values()), 'the budget is too small for one')}"
            )
        command = shlex.join(["scripts/tune", name, *(w for w in words if not w.startswith(("out=", "cores=")))])
        measured = measured_book(search, command)
        book.write(out / "measured.json", measured)
        tuned = write_parameters(out / "tuned.yaml", search, parameters)
        report = write_report(out, search, measured)
    print(
        f"{NAME}: see {report}; {tuned.name} holds the levers chosen, for scripts/run {name} @{tuned}", file=sys.stderr
    )
    return launch(file, scenes[0], tuned) if "--launch" in flags else 0


def check(words):
    """Put books on trial; return the exit code."""
    options = dict(points="5", observable="", cores=USUAL["cores"], out="held_out")
    options.update(word.split("=", 1) for word in words if word.split("=", 1)[0] in options and "=" in word)
    names = [word for word in words if "=" not in word]
    for word in words:
        if "=" in word and word.split("=", 1)[0] not in options:
            raise UsageError(
                f"{one_line(word)} is nothing that check knows; it takes names of books, points=, observable=, cores= and out="
            )
    count, cores, out, points = whole(options, "points"), whole(options, "cores"), Path(options["out"]).absolute(), []
    observable, books, passed_over = options["observable"], held_out.books_of(names), []
    with execution.nothing_in_the_way(out), signals.handled():
        out.mkdir(parents=True, exist_ok=True)
        for number, made in enumerate(books):
            file, name = study_file(made.study), made.file.removesuffix(".json")
            study = loaded(file)
            if not names and not held_out.can_be_tried(study, made, observable):
                passed_over.append(name)
                continue
            points += held_out.points_of(study, file, made, out / name, count, cores, number + 1, observable)
        command = shlex.join(["scripts/tune", "check", *(w for w in words if not w.startswith(("out=", "cores=")))])
        where = f"`{command}`; code {code_version()}, on {cpu_model()}."
        if passed_over:
            where += f" Without a setting whose error is known to be below 100 %: {', '.join(passed_over)}."
        report = held_out_report.write_report(out, points, where)
    print(
        f"{NAME}: {sum(p.holds for p in points)} of {len(points)} within what was asked for; see {report}",
        file=sys.stderr,
    )
    return 0


def parted(study, words):
    """Return (options of the tuning, {key: text} of the study) from `key=value` words."""
    options, keys = dict(USUAL), {}
    for word in words:
        key, sign, text = word.partition("=")
        if sign and key in USUAL:
            options[key] = text.strip()
            continue
        key, text = split(study.parameters, word)
        if key in keys:
            raise UsageError(f"{key} is given twice; keep one")
        keys[key] = text
    return options, keys


def scenes_of(study, keys):
    """Return (scenes: a dict of values for each combination of the values given, {lever: value given})."""
    scenes, given = [{}], {}
    for key, text in keys.items():
        field = study.parameters.__fields__[key]
        if key == "seed":
            raise UsageError(
                f"seed={one_line(text)}: a tuning takes seeds 1, 2, … itself; leave it out, seeds=N bounds them"
            )
        if key in study.levers:
            given[key] = convert(field, text)
            continue
        values = [convert(field, part) for part in text.split(",")] if field.type_ is not str else [text]
        scenes = [{**scene, key: value} for scene in scenes for value in values]
    return scenes, given


def refuse_unused(keys, parameters):
    """Raise UsageError for a key given that has several values but is not used in all scenes, or one that no scene uses."""
    for key, text in keys.items():
        broken = [p.not_used()[key] for p in parameters if key in p.not_used()]
        if len(broken) == len(parameters) or ("," in text and broken):
            raise UsageError(
                f"{argument_text(key, text)} has no effect: {key} is used only with {broken[0].rule}, and"
                f" {'a scene' if len(parameters) > 1 else 'the scene'} has"
                f" {next(broken[0].state(p) for p in parameters if key in p.not_used())}; leave {key} out"
            )


def varied(study, text, parameters):
    """Return the levers to vary: those named, or all that each scene uses; UsageError for a key that is none of these.

    `parameters` are those of the scenes.
    """
    unused = {key: (condition, p) for p in parameters for key, condition in p.not_used().items()}
    open_ones = [key for key in study.levers if key not in unused]
    names = [name.strip() for name in text.split(",") if name.strip()] or open_ones
    for name in names:
        if name not in study.levers:
            raise UsageError(
                f"vary={one_line(text)}: {one_line(name)} is no lever of {study.name}; there are: {' '.join(open_ones)}"
            )
        if name in unused:
            condition, p = unused[name]
            raise UsageError(
                f"vary={one_line(text)}: {name} has no effect: it is used only with {condition.rule}, and the scene has"
                f" {condition.state(p)}; these have one: {' '.join(open_ones)}"
            )
    return names


def seconds_of(text):
    """Return the seconds of a budget as 90s, 30min, 2h; UsageError with the rule."""
    unit = next((unit for unit in sorted(UNITS, key=len, reverse=True) if text.endswith(unit)), None)
    try:
        value = float(text.removesuffix(unit)) * UNITS[unit]
    except (TypeError, ValueError):
        value = 0.0
    if not 0 < value < float("inf"):
        raise UsageError(f"budget={one_line(text)} must be a time as 90s, 30min or 2h")
    return value


def whole(options, key):
    """Return an option that counts; UsageError unless it is a whole number of at least 1 (of seeds 2)."""
    least = 2 if key == "seeds" else 1
    if not options[key].isdecimal() or int(options[key]) < least:
        raise UsageError(f"{key}={one_line(options[key])} must be a whole number of at least {least}")
    return int(options[key])


def seeds_of(parameters, most):
    """Return the (fewest, most) seeds of a setting: one where no scene uses the seed, for its runs would be the same."""
    return (1, 1) if all("seed" in p.not_used() for p in parameters) else (FEWEST_SEEDS, most)


def tell_plan(search, ladders, options):
    """Say what is varied from where, and what the reference costs."""
    trials = search.trials
    print(
        f"{NAME}: reference {in_words(sorted(trials.reference.items()))}; {len(trials.scenes)} scenes", file=sys.stderr
    )
    if search.most_seeds == 1:
        print(f"{NAME}: no scene uses the seed: each setting has one run in a scene", file=sys.stderr)
    for key, (values, end) in ladders.items():
        tried = ", ".join(shown(value) for value in values) or "nothing to try"
        print(f"{NAME}: {key}: {tried}{f' ({end})' if end else ''}", file=sys.stderr)
    if trials.study.cost:
        start = search.repeats((), search.fewest_seeds)
        seconds = sum(trials.expected_seconds(trial) for trial in start)
        print(
            f"{NAME}: {len(start)} runs of the reference: about {duration(seconds)} of the budget, {options['budget']}",
            file=sys.stderr,
        )


def carry_out(search, budget, cores):
    """Make trials until the levers are settled or the budget is spent."""
    trials = search.trials
    wanted = search.next_trials(budget)
    if trials.study.cost and (needed := sum(map(trials.expected_seconds, wanted))) > budget:
        raise UsageError(
            f"the reference alone needs about {duration(needed)} of processor time, more than the budget of {duration(budget)};"
            " raise budget, or give levers nearer to what you can afford as the reference"
        )
    while wanted:
        trials.make(wanted, cores)
        for trial in wanted:
            if trial in trials.failed:
                print(f"{NAME}: {in_words(trial.setting)} fails: {trials.failed[trial]}", file=sys.stderr)
        print(
            f"{NAME}: {len(trials.outcomes)} runs, {duration(trials.spent)} of {duration(budget)} spent",
            file=sys.stderr,
        )
        if not trials.of(()):
            return
        wanted = search.next_trials(budget - trials.spent)


def measured_book(search, command):
    """Return the `Book` of what the trials gave."""
    trials = search.trials
    scenes = [book.scene_of(trials.planned(t).parameters, trials.reference) for t in reference_trials(trials)]
    same, cover = book.cover_of(scenes)
    settings = []
    for setting in trials.settings:
        runs = trials.of(setting).values()
        effects = {o.name: trials.effect(setting, o.name) for o in trials.study.observables}
        settings.append(
            book.Setting(
                dict(setting),
                {name: effect for name, effect in effects.items() if effect.runs},
                trials.cost_factor(setting),
                trials.cost(setting),
                max(outcome.memory for outcome in runs),
                len(runs),
            )
        )
    about = (trials.study.family, command, code_version(), cpu_model())
    return book.Book(*about, trials.reference, same, cover, trials.scenes, tuple(settings))


def reference_trials(trials):
    """Return one trial of the reference in each scene."""
    return [next(t for t in trials.asked if t.setting == () and t.scene == k) for k in range(len(trials.scenes))]


def write_parameters(path, search, parameters):
    """Write the levers of the chosen setting that a scene uses, as a file of parameters; return its path."""
    levers = {**search.trials.reference, **dict(search.chosen())}
    levers = {key: value for key, value in levers.items() if not all(key in p.not_used() for p in parameters)}
    lines = [f"{key}: {'auto' if v is None else v}" for key, v in sorted(levers.items())]  # with all digits
    text = "# Levers that scripts/tune chose; a study takes this file as @FILE.\n" + "\n".join(lines) + "\n"
    whole_files.write_text(path, text)
    return path


def launch(file, scene, tuned):
    """Run the study with the first scene's keys and the chosen levers; return its exit code."""
    keys = [f"{key}={int(v) if isinstance(v, bool) else v}" for key, v in scene.items()]
    return subprocess.call([*execution.PROGRAM, str(file), *keys, f"@{tuned}", "unused=allow"])


if __name__ == "__main__":
    output.forgive()
    sys.exit(main(sys.argv[1:]))
