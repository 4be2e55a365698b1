"""The grains' material and what time step it bears."""

import math
from dataclasses import dataclass

from . import engines

LAW = "hertzHistory"


@dataclass(frozen=True)
class HertzHistoryMaterial:
    """Disks under the Brilliantov-Silbert law, in any consistent units.

    normal_stiffness K_n, tangential_stiffness K_t [Pa]; normal_damping, tangential_damping gamma_n, gamma_t [1/(m s)];
    friction mu [-]; density [kg/m^2] of a disk.
    """

    normal_stiffness: float
    tangential_stiffness: float
    normal_damping: float
    tangential_damping: float
    friction: float
    density: float

    def critical_time_step(self, smallest_radius, overlap):
        """Return the largest stable step [s] of two smallest disks overlapping by `overlap` of their radius.

        Along the normal they move with m_eff. Two disks (I = m R^2/2) slide past each other with a third of it: half of
        their rolling is free. Hertz stiffness grows with the overlap: given the one where GrainLoop's guard stops a run,
        the step holds for every contact that it lets pass.
        """
        mass = self.density * math.pi * smallest_radius**2
        at = self.terms(smallest_radius, overlap)
        normal = engines.critical_step(at["stiffness"], at["dashpot"], mass / 2)
        if self.friction == 0:
            return normal
        return min(normal, engines.critical_step(at["tangential_stiffness"], at["tangential_dashpot"], mass / 6))

    def force_between(self, radius, overlap):
        """Return the force [N] of resting disks of `radius` [m] that overlap by `overlap` of it."""
        return self.terms(radius, overlap)["elastic"]

    def terms(self, radius, overlap):
        """Return the law's terms for two disks of `radius` [m] that overlap by `overlap` of it, see `engines.terms_of_law`."""
        mass = self.density * math.pi * radius**2
        return engines.terms_of_law(LAW, self.given(), overlap * radius, radius / 2, mass / 2)

    def given(self):
        """Return what the law is given, under the names of GrainLoop and of the Law2_ functor."""
        return dict(
            normalStiffness=self.normal_stiffness,
            tangentialStiffness=self.tangential_stiffness,
            normalDamping=self.normal_damping,
            tangentialDamping=self.tangential_damping,
        )
