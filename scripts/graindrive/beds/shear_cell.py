"""A periodic cell of disks, sheared homogeneously at constant pressure or area fraction: scene, loop and measured means.

Units are d, rho, g: a disk of diameter d has the mass pi/4.
"""

import math
from dataclasses import dataclass

import numpy as np

from ..lazily import engines
from ..loops import grain_loop
from ..scenes import scene
from ..base.errors import UsageError
from ..scenes.material import MOST_CONTACTS, SpringDashpotMaterial, critical_time_step_of_disks

DENSITY = 1.0  # rho
MASS = math.pi / 4  # of a disk of diameter d [rho d^2]
SMALLEST, LARGEST = 1.0, 1.2  # d, diameters are uniform between them
SPACING = 1.22  # d, of the initial square lattice
JITTER = 0.02  # d, largest random shift of a disk along x and y
ASPECT = 1.3  # initial rows over columns; the pressure then makes the cell about square
CLOSING_RATE = 0.1  # sqrt(g/d), |dL/dt|/L while a cell approaches its area fraction
LABEL = "shear"
NAMES = (
    *("contact_sxx", "contact_sxy", "contact_syx", "contact_syy"),
    *("kinetic_sxx", "kinetic_sxy", "kinetic_syx", "kinetic_syy"),
    *("coordination", "phi", "growth", "mean_pressure", "shear_stress"),
)


@dataclass(frozen=True)
class ShearCell:
    """Recipe for a sheared cell with constant `pressure` > 0 or constant `area_fraction` > 0. Stiffness in m g/d."""

    grains: int
    stiffness: float
    friction: float
    restitution: float
    shear_rate: float
    pressure: float
    area_fraction: float
    every: int
    seed: int

    @property
    def k_n(self):
        """Normal stiffness [rho g d]."""
        return self.stiffness * MASS

    def given(self):
        """Return what the law is given, under the names of GrainLoop and of the Law2_ functor."""
        return dict(normalStiffness=self.k_n, tangentialStiffness=self.k_n * 2 / 7, restitution=self.restitution)

    def check(self, dt, largest_overlap):
        """Return dt/dt_crit for two smallest disks; UsageError if it is over 1 or if the grains are too soft."""
        critical = self.critical_time_step()
        if dt > critical:
            raise UsageError(
                f"time step {dt:.3g} is over the critical {critical:.3g} of two smallest grains; lower dt_factor"
            )
        scene.require_bed_bears(dt, self.critical_time_step(MOST_CONTACTS))
        if self.pressure > (most := self.k_n * largest_overlap / 4):
            raise UsageError(
                f"pressure={self.pressure:g} makes grains overlap too far; give at most {most:.3g}, or raise stiffness"
            )
        return dt / critical

    def critical_time_step(self, contacts=1):
        """Return the largest stable step of two smallest disks; `contacts` is as in `critical_time_step_of_disks`."""
        grains = SpringDashpotMaterial(self.k_n, self.k_n * 2 / 7, self.restitution, self.friction, DENSITY)
        return critical_time_step_of_disks(grains, SMALLEST / 2, 1e-3, contacts)

    def build(self, dt, loop, *, precision, largest_overlap):
        """Put disks, drive and the loop ("grain" or "yade") into YADE; disks have only small random velocities."""
        from yade import O
        from yade import wrapper as w

        x, y, radii, width, height = self.lattice()
        O.reset()
        O.periodic = True
        O.cell.setBox(width, height, 10)
        O.cell.homoDeform = 1
        O.dt = dt
        scene.add_disks(x, y, radii, DENSITY)
        law = engines.Law2_ScGeom_ContactPhys_SpringDashpot(**self.given())
        phys = engines.Ip2_FrictMat_FrictMat_ContactPhys(friction=self.friction)
        contacts = w.InteractionLoop([w.Ig2_Sphere_Sphere_ScGeom()], [phys], [law])
        collider = w.InsertionSortCollider([w.Bo1_Sphere_Aabb()], allowBiggerThanPeriod=True)
        drive = self.drive(np.pi * np.sum(radii**2) / width)
        O.engines = [w.ForceResetter(), collider, contacts, drive, w.NewtonIntegrator(damping=0)]
        if loop == "grain":
            threads = min(O.numThreads, 1 + self.grains // scene.GRAINS_PER_THREAD)
            grain_loop.use_grain_loop(
                dimensions=2, precision=precision, threads=threads, largestOverlap=largest_overlap, label="loop"
            )

    def lattice(self):
        """Return x, y, radii (n,) of a jittered square lattice, and the cell's width and height."""
        rng = np.random.default_rng(self.seed)
        columns = max(6, round(math.sqrt(self.grains / ASPECT)))
        rows = math.ceil(self.grains / columns)
        places = rng.permutation(rows * columns)[: self.grains]
        noise = rng.uniform(-JITTER, JITTER, (2, self.grains))
        x, y = (places % columns + 0.5) * SPACING + noise[0], (places // columns + 0.5) * SPACING + noise[1]
        return x, y, rng.uniform(SMALLEST, LARGEST, self.grains) / 2, columns * SPACING, rows * SPACING

    @property
    def area_fraction_at_first(self):
        """Area fraction of the lattice [-]."""
        _, _, radii, width, height = self.lattice()
        return float(np.pi * np.sum(radii**2) / (width * height))

    def drive(self, filled_height):
        """Return the drive; `filled_height` is the disks' area over the cell's width."""
        held = dict(pressure=self.pressure, pressureDamping=math.sqrt(MASS * self.k_n))
        if self.area_fraction:
            held = dict(height=filled_height / self.area_fraction, heightRate=CLOSING_RATE)
        return engines.ShearDrive(shearRate=self.shear_rate, every=self.every, label=LABEL, **held)


def means():
    """Return the drive's means since the last call, and reset them.

    A dict of the numbers of `NAMES`, the cell's `height`, and `profile` (bins,): the mean of v_x relative to the mean flow.
    """
    from yade import O

    drive = O.labeledEngine(LABEL)
    numbers = np.array(drive.sums) / drive.samples
    row = dict(zip(NAMES, numbers))
    row["profile"] = np.array(drive.profileSums) / np.maximum(np.array(drive.profileCounts), 1)
    row["height"] = O.cell.hSize[1][1]
    drive.clear()
    return row


def keep_upright():
    """Flip YADE's cell back if it is tilted by more than half its width: YADE's collider handles strongly tilted cells badly."""
    from yade import O

    if scene.fast_loop() is None and O.cell.hSize[0][1] > O.cell.hSize[0][0] / 2:
        O.cell.flipCell()
