"""Follow pages of studies/guides as a reader would, in an empty folder: write files, apply changes, call commands."""

import os
import re
import subprocess
import sys
from pathlib import Path

TOP = Path(__file__).resolve().parents[2]
GUIDES = TOP / "studies" / "guides"
BLOCK = re.compile(r"(?:^`(?P<file>[^`\n]+)`:\n\n)?^```(?P<language>\w+)\n(?P<text>.*?)^```$", re.MULTILINE | re.DOTALL)
# The commands of scripts/ after their set-up, which would build the checkout.
COMMANDS = {
    "run": 'study=$1; shift; [[ $study == *.py ]] || study={top}/studies/$study.py; exec {python} "$study" "$@"',
    "campaign": 'exec {python} -m graindrive.campaign "$@"',
}


def blocks(name):
    """Return [(file or None, language, text)] of the blocks of a page, in their order."""
    found = BLOCK.finditer((GUIDES / name).read_text(encoding="utf-8"))
    return [(block["file"], block["language"], block["text"]) for block in found]


def write_files(name, place):
    """Write the files of a page into a folder; return their names."""
    files = {file: text for file, _, text in blocks(name) if file}
    for file, text in files.items():
        (place / file).parent.mkdir(parents=True, exist_ok=True)
        (place / file).write_text(text, encoding="utf-8")
    return list(files)


def follow(name, place, *programs):
    """Follow a page in the folder `place`; return the output of its commands, standard output and errors together.

    `programs` are folders that precede those of the system on PATH. A command that fails raises AssertionError with
    what it said.
    """
    write_files(name, place)
    typed = [text for file, language, text in blocks(name) if language == "bash" and not file]
    (place / "scripts").mkdir(exist_ok=True)
    for command, text in COMMANDS.items():
        (place / "scripts" / command).write_text(f"#!/bin/bash\n{text.format(top=TOP, python=sys.executable)}\n")
        (place / "scripts" / command).chmod(0o755)
    return "".join(type_in(text, place, programs) for text in typed)


def type_in(text, place, programs=()):
    """Run lines in bash in the folder `place`; return their output."""
    path = os.pathsep.join([*map(str, programs), os.environ["PATH"]])
    own = dict(HOME=str(place), XDG_CACHE_HOME=str(place / "cache"), PATH=path, OMP_NUM_THREADS="1")
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(p for p in sys.path if p), **own}
    pipes = dict(stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=500)
    done = subprocess.run(["bash", "-euo", "pipefail", "-c", text], cwd=place, env=environment, **pipes)
    assert done.returncode == 0, f"{text}\n{done.stdout}"
    return done.stdout


def apply_changes(name, place):
    """Apply the diffs of a page to copies of the files that they name, exactly where they say, and write its own files."""
    for _, language, text in blocks(name):
        for file in re.findall(r"^--- a/(\S+)$", text, re.MULTILINE) if language == "diff" else []:
            (place / file).parent.mkdir(parents=True, exist_ok=True)
            (place / file).write_bytes((TOP / file).read_bytes())
        if language == "diff":
            done = subprocess.run(
                ["patch", "-p1", "--fuzz=0"], input=text, cwd=place, text=True, capture_output=True, check=False
            )
            assert done.returncode == 0, done.stdout + done.stderr
    return write_files(name, place)
