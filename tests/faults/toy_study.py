"""The smallest study: one sphere flies through an empty box, with a choice of faults; run it as `yade toy_study.py`."""

import os
import signal
import time
from typing import Literal

import numpy as np

from graindrive.base.errors import UsageError
from graindrive.commands.headless import listening_ports, main
from graindrive.parameters import StudyParameters, quantity
from graindrive.runs.progress import run_blocks
from graindrive.study import Study
from graindrive.scenes.yade_march import YadeMarch


class Toy(StudyParameters):
    period: float = quantity(4.0, "sqrt(d/g)", "a number that decides nothing", gt=0)
    steps: int = quantity(100, "-", "number of steps", ge=1)
    fault: Literal["none", "engine", "study", "usage", "figure", "slow"] = quantity("none", "-", "what goes wrong")
    ask: Literal["none", "INT", "TERM", "HUP", "KILL"] = quantity("none", "-", "signal half-way", identity=False)


def study(p, folder):
    """Run the flight; each block of a tenth of the steps gives one row of the series, one frame and one checkpoint."""
    from yade import ForceResetter, NewtonIntegrator, O, PyRunner, utils

    print("ports", sorted(listening_ports()), flush=True)
    O.bodies.append(utils.sphere((0, 0, 0), 1))
    O.engines = [ForceResetter(), NewtonIntegrator()]
    if p.fault == "engine":
        O.engines = O.engines + [PyRunner(command="1/0", iterPeriod=p.steps // 2, initRun=False)]
    if p.fault == "slow":
        O.engines = O.engines + [PyRunner(command="import time; time.sleep(1e-3)", iterPeriod=1)]
    O.dt = 1e-3
    if p.fault == "usage":
        raise UsageError("dt=1 is over the critical 0.5; give a smaller dt_factor")
    folder.declare_series(t="sqrt(d/g)", step="-")
    first = folder.resumed["step"] if folder.resumed else 0
    folder.note(dt=O.dt, dt_over_critical=0.1, n_grains=1)

    def on_block(done):
        step = first + done
        folder.append(t=step * O.dt, step=step)
        folder.frame(step * O.dt, {"x": np.full(3, step)})
        folder.checkpoint(lambda where: (where / "state").write_text(str(step)), step)
        if p.ask != "none" and step == p.steps // 2:
            folder.series.flush()
            os.kill(os.getpid(), getattr(signal, f"SIG{p.ask}"))
            time.sleep(10)

    timing = run_blocks(YadeMarch(1), p.steps - first, p.steps // 10, on_block, label="toy")
    if p.fault == "study":
        raise ValueError("the study\nhas a bug")
    folder.note(steps=timing.steps, particle_steps_per_second=timing.work_per_second)
    folder.summarize(answer=np.float64(42), answer_err=float("nan"), first=first)


def figure(path):
    """Fail if the parameters request it, like a figure that cannot be drawn."""
    if "badfigure" in path.name:
        raise ValueError("no figure")
    (path / "figure.png").write_bytes(b"")


STUDY = Study(
    name="toy_study",
    parameters=Toy,
    presets={"smoke": {}, "demo": {"steps": 100}},
    run=study,
    figure=figure,
)

if __name__ == "__main__":
    main(STUDY)
