"""The same small scene on YADE's own loop or on GrainLoop, for tests that apply to both."""

import disks
import numpy as np
import pytest
from graindrive.loops import grain_loop
from yade import O

each_loop = pytest.mark.parametrize("loop", ["yade", "grain"])


def put_on(loop, *engines, law=None, **settings):
    """Put `engines` before the integrator of that loop; soft disks by default, so that large time steps are allowed."""
    disks.loop(law or disks.hertz(k_n=2e3, k_t=2e3), before_newton=engines, **settings)
    if loop == "grain":
        grain_loop.use_grain_loop(largestOverlap=1)  # soft on purpose


def way_of(ident, steps):
    """Return the body's positions after each of so many steps, shape (steps, 3)."""
    rows = []
    for _ in range(steps):
        O.step()  # O.run waits in units of 1/20 s
        rows.append(O.bodies[ident].state.pos)
    return np.array(rows)
