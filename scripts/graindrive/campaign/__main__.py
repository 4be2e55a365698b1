"""The command `scripts/campaign`: plan, runs, table, report; complete runs are never made again."""

import argparse
import os
import sys
from pathlib import Path

from ..base import output, signals
from ..base.errors import UsageError
from ..commands.headless import guarded
from ..postproc.campaign.report import write_report
from . import cost, execution
from .plan import read_plan

NAME = "campaign"
SOME_FAILED = 1


def main(arguments):
    """Carry out the command line; return the exit code."""
    options = read_arguments(arguments)
    outcome = []
    code = guarded(lambda: outcome.append(campaign(options)), NAME)
    return code or outcome[0]


def read_arguments(arguments):
    """Return the options; those after `--` are passed to Snakemake."""
    at = arguments.index("--") if "--" in arguments else len(arguments)
    parser = argparse.ArgumentParser(prog="scripts/campaign", allow_abbrev=False)
    parser.add_argument("file", type=Path, help="the campaign's YAML file")
    parser.add_argument(
        "-n", "--dry-run", action="store_true", help="only list the runs that would be made, and their cost"
    )
    parser.add_argument("--report", action="store_true", help="start no run; only rebuild table and report")
    parser.add_argument(
        "--cores", type=int, default=os.cpu_count(), help="number of runs at a time; default: all processors"
    )
    parser.add_argument("--out", type=Path, help="the campaign's folder; default: named after the file")
    options = parser.parse_args(arguments[:at])
    options.snakemake = arguments[at + 1 :]
    return options


def campaign(options):
    """Plan, run, report; return the exit code."""
    if options.cores < 1:
        raise UsageError(f"cores={options.cores} must be at least 1; leave --cores out for all processors")
    plan = read_plan(options.file)
    folder = (options.out or Path(plan.name)).absolute()
    with execution.nothing_in_the_way(folder):
        if folder.exists() and not folder.is_dir():
            raise UsageError(f"out={folder} is a file; give --out a folder")
        if options.dry_run:
            return tell(folder, plan, options.cores)
        with signals.handled(), execution.opened(folder, plan) as lock:
            if not options.report:
                make_runs(folder, plan, options, lock)
            report = write_report(folder, plan.report, plan.study.observables)
        print(f"{NAME}: see {report}", file=sys.stderr)
        return tell_failures(folder, plan)


def make_runs(folder, plan, options, lock):
    """Make the missing runs, if there are any."""
    for line in execution.set_damaged_aside(folder, plan):
        print(f"{NAME}: {line}", file=sys.stderr)
    todo = execution.missing(folder, plan)
    print(f"{NAME}: {len(plan.runs) - len(todo)} of {len(plan.runs)} runs are there already", file=sys.stderr)
    if todo:
        print(f"{NAME}: {cost.in_words(folder, plan, todo, options.cores)}", file=sys.stderr)
        execution.carry_out(folder, plan, options.cores, options.snakemake, lock)


def tell(folder, plan, cores):
    """Print the runs that a call would make; return 0."""
    todo = execution.missing(folder, plan)
    for run in todo:
        print(f"{run.name}  ({', '.join(run.sweeps)})  {' '.join(run.arguments)}")
    print(f"{len(todo)} of {len(plan.runs)} runs would be made in {folder}; {cost.in_words(folder, plan, todo, cores)}")
    return 0


def tell_failures(folder, plan):
    """Print the missing runs, each with the last line of its log; return the exit code."""
    failed = execution.failures(folder, plan)
    for name, words in failed.items():
        print(f"{NAME}: {name} is not complete: {words} (logs/{name}.log)", file=sys.stderr)
    if failed:
        print(f"{NAME}: {len(failed)} of {len(plan.runs)} runs are missing; the next call makes them", file=sys.stderr)
    return SOME_FAILED if failed else 0


if __name__ == "__main__":
    output.forgive()
    sys.exit(main(sys.argv[1:]))
