"""Puts the package `graindrive` of this checkout on the path, or says how to build it."""

import sys
from pathlib import Path

BUILT = Path(__file__).resolve().parent.parent / "build" / "python"

if not (BUILT / "graindrive").is_dir():
    try:
        import graindrive  # noqa: F401 (installed)
    except ModuleNotFoundError:
        sys.exit("graindrive is not built yet: run scripts/setup once")
elif str(BUILT) not in sys.path:
    sys.path.insert(0, str(BUILT))
