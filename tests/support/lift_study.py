"""The lift study as a module and its scene, built with any speed, for tests that shrink it."""

import importlib
from pathlib import Path

STUDIES = Path(__file__).resolve().parents[2] / "studies"
SMALL = dict(
    breadth=5,
    height=13,
    depth=6.5,
    cylinder_diameter=2,
    lid_density=30,
    speed=0.4,
    dt_factor=2,
    rest=1e-3,
    fields=False,
)


def module(monkeypatch, cache):
    """Return the study as a module, in this process, with its beds in the folder `cache`."""
    monkeypatch.setenv("GRAINDRIVE_CACHE", str(cache))
    monkeypatch.syspath_prepend(str(STUDIES))
    return importlib.import_module("lift")


def built(lift, keys, speed, change=None):
    """Build the scene with any speed along x, also 0 or backwards; return its parameters and the facts of the stage.

    `change` is that of the study's `build`.
    """
    p = lift.LiftParameters(**keys).copy(update=dict(speed=speed))
    return p, lift.build(p, lift.body_of(p), lift.time_step(p), change)
