"""Wiggle, preset: the tall rectangle. Keys and physics: see wiggle.py."""

import os
import sys

sys.path[:0] = [os.path.dirname(os.path.abspath(sys.argv[0]))]  # `yade` runs scripts by exec: __file__ is YADE's own

import wiggle  # noqa: E402

wiggle.main(shape="tall")
