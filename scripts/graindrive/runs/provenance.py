"""The provenance of a run: versions, processor, seed; it names no host, no user and no path."""

import os
import subprocess
import sys
from datetime import datetime, timezone
from pathlib import Path

from .. import __version__


def provenance(parameters, study):
    """Return a dict of plain values on the code and the processor that made a run."""
    return {
        "study": study,
        "code_version": code_version(),
        "yade_version": yade_version(),
        "python_version": ".".join(map(str, sys.version_info[:3])),
        "cpu": cpu_model(),
        "threads": int(os.environ.get("OMP_NUM_THREADS", "1") or 1),
        "seed": parameters.seed,
        "started": datetime.now(timezone.utc).isoformat(timespec="seconds"),
    }


def code_version():
    """Return `git describe` of the checkout that contains this file, else the package's version."""
    folder = Path(__file__).resolve().parent
    command = ["git", "--no-optional-locks", "-C", str(folder), "describe", "--always", "--dirty", "--tags"]
    environment = {key: value for key, value in os.environ.items() if not key.startswith("GIT_")}
    try:
        tracked = subprocess.run(
            command[:4] + ["ls-files", "--error-unmatch", Path(__file__).name],
            capture_output=True,
            timeout=10,
            env=environment,
        )
        described = subprocess.run(command, capture_output=True, text=True, timeout=10, env=environment)
    except (OSError, subprocess.TimeoutExpired):
        return __version__
    if tracked.returncode or described.returncode:
        return __version__
    return f"{__version__}+{described.stdout.strip()}"


def yade_version():
    """Return YADE's version, "none" if YADE is not loaded."""
    config = sys.modules.get("yade.config")
    return getattr(config, "version", "none")


def cpu_model():
    """Return the processor's model name, "unknown" if the kernel does not provide it."""
    try:
        lines = Path("/proc/cpuinfo").read_text().splitlines()
    except OSError:
        return "unknown"
    return next((line.partition(":")[2].strip() for line in lines if line.startswith("model name")), "unknown")
