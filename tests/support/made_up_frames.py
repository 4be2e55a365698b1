"""A run folder with made-up frames, for tests of exports to other programs."""

import numpy as np

from graindrive.parameters import StudyParameters
from graindrive.postproc import quantities
from graindrive.runs.run_folder import RunFolder

PERIOD, DT = 10.0, 0.25


class Parameters(StudyParameters):
    unit_system = quantities.GRAIN


def disks(rng, ids, x, y, **others):
    n = len(ids)
    moves = {name: rng.uniform(-1, 1, n) for name in ("vx", "vy", "spin")}
    return dict(id=np.array(ids), x=np.array(x), y=np.array(y), r=rng.uniform(0.4, 0.5, n), **moves, **others)


def made_up_run(out, *, frames=3, period=PERIOD, **parameters):
    """Write a run of `frames` frames at 0, 2, 4 …: 40 grains, a base of 5, a body of two beads at the periodic side."""
    rng = np.random.default_rng(2)
    with RunFolder(Parameters(out=str(out), **parameters), study="wiggle") as folder:
        folder.note(dt=DT)
        folder.write("intruder", dict(beads=np.array([[-0.5, 0], [0.5, 0]]), bead_radius=0.25))
        samples = dict(x=np.arange(3.0), y=np.arange(2.0), samples=np.array([7]), pressure=rng.uniform(size=(1, 2, 3)))
        folder.write("fields/around", samples, phases=1, period=0.0, phaseStart=0.0)
        for k in range(frames):
            x, y = np.r_[rng.uniform(0, 10, 40), np.arange(5) + 0.5], np.r_[rng.uniform(-3, 20, 40), np.full(5, -3.5)]
            grains = disks(rng, range(45), x, y, role=np.repeat([0, 1], [40, 5]))
            body = disks(rng, [46, 47], [-0.25, 0.75], [8.0, 8.0 + k], centre=np.array([0.25, 8.0]))
            sides = dict(i=[0, 3], j=[1, -1], id_i=[0, 3], id_j=[1, 47])
            forces = dict(fn=[1.0, -2.0], ft=[0.5, -0.5], slip=[0.1, -0.1], px=[1.0, 0.9], py=[0.0, 8.0])
            contacts = {name: np.array(column) for name, column in {**sides, **forces}.items()}
            folder.frame(2.0 * k, grains, contacts, body, period)
    return out
