"""Wiggle, preset: the wide rectangle. Keys and physics: see wiggle.py."""

import os
import sys

if __name__ == "__main__":  # `yade` runs scripts by exec: __file__ is YADE's own
    sys.path.insert(0, os.path.dirname(os.path.abspath(sys.argv[0])))

import wiggle  # noqa: E402

from graindrive.commands import headless  # noqa: E402

STUDY = wiggle.STUDY.preset("wiggle_wide", shape="wide")

if __name__ == "__main__":
    headless.main(STUDY)
