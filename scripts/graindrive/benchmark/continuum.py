"""Times the continuum solver on the drum of Oba, Otsuki (2025): cell-steps per second for several grids and settings."""

import statistics
import sys
import time

from ..continuum import drum_continuum

NAME, LAW = "continuum", "mu_i"
TURNED = 0.35  # rad by which a drum has turned before it is timed, so that its surface flows
SPIN_UP_STEP = 0.02  # sqrt(d/g), time step of this start
PAPERS_STEP, PAPERS_SOLVER = 1e-4, "bicgstab"
PAPERS_VISCOSITY = 8000.0  # m sqrt(g/d)
FINE_STEP = 1e-5  # on the large grid, where the paper's step is above the stability limit of the explicit viscosity
LARGE = 368  # cells across, 400 with the shell
PARTS = "material forces pressure viscosity surface".split()


class Drum:
    """A flow in the paper's drum of 150 d, with `cells` across it, after its start; `size` is its number of cells."""

    def __init__(self, study, cells, turned=TURNED, **keys):
        known = study.parameters.__fields__
        p = study.parameters(cells=cells, **{name: value for name, value in keys.items() if name in known})
        self.flow = started(p, turned)
        self.size = self.flow.fraction.size

    def rate(self, steps):
        """Advance by `steps` steps; return cell-steps per second of processor time."""
        start = time.process_time()
        self.flow.advance(steps)
        return self.size * steps / (time.process_time() - start)

    def shares(self):
        """Return {part: its share of the time of all steps}."""
        times = self.flow.part_times
        total = sum(times[part] for part in PARTS)
        return {part: times[part] / total for part in PARTS}


def started(p, turned):
    """Return a flow with the parameters `p` in the state that it reached with a coarse time step; same grid, same fluids."""
    quick = drum_continuum.flow_of(p.copy(update=dict(continuum_dt=SPIN_UP_STEP, viscosity="full", pressure_solver="")))
    quick.advance(int(turned / (p.omega * SPIN_UP_STEP)))
    flow = drum_continuum.flow_of(p)
    flow.restore({**quick.state(), "time": 0.0, "steps": 0})
    flow.advance(5)  # in the first steps the flow adapts to the other time step
    return flow


def measure(study, quick):
    """Yield the rows: the paper's settings with our solver and with its own, our settings, and a grid of 400^2 cells."""
    rounds, steps = (3, 40) if quick else (7, 200)
    papers = dict(viscosity="split", continuum_dt=PAPERS_STEP, largest_viscosity=PAPERS_VISCOSITY)
    ours = Drum(study, 75, **papers)
    theirs = Drum(study, 75, pressure_solver=PAPERS_SOLVER, **papers)
    yield row(ours, theirs, rounds, steps, "BiCGSTAB, as the paper", steps // 4)
    yield row(Drum(study, 75), ours, rounds, steps, "own, the paper's dt")
    large = Drum(study, LARGE, turned=0.0 if quick else TURNED / 5, **{**papers, "continuum_dt": FINE_STEP})
    yield row(large, ours, rounds, max(3, steps // 14), "own 107^2 cells", steps)
    for words, drum in (("107^2 cells, the paper's settings", ours), ("400^2 cells", large)):
        parts = ", ".join(f"{part} {100 * share:.0f} %" for part, share in drum.shares().items())
        print(f"{words}: {parts}", file=sys.stderr)


def row(one, other, rounds, steps, peer, others_steps=None):
    """Return one line of the table: rates in cell-steps per second, taken alternately."""
    pairs = [(one.rate(steps), other.rate(others_steps or steps)) for _ in range(rounds)]
    return dict(
        scene=NAME,
        law=LAW,
        precision="double",
        threads=1,
        kernel="native",
        peer=peer,
        ours=statistics.median(a for a, _ in pairs),
        theirs=statistics.median(b for _, b in pairs),
        ratio=statistics.median(a / b for a, b in pairs),
    )
