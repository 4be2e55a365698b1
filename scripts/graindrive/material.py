"""The grains' material and what time step it bears."""

import math
from dataclasses import dataclass


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

        Leapfrog is stable for omega dt < 2 (sqrt(1 + zeta^2) - zeta). Normal: omega^2 = 3/2 K_n sqrt(R_eff delta)/m_eff.
        Tangential: omega^2 = K_t sqrt(R_eff delta)/(m_eff/3), since two disks (I = m R^2/2) slide past each other with a
        third of m_eff: half of their rolling is free. zeta = gamma m' sqrt(R_eff delta)/(2 m' omega) with the same mass.
        Hertz stiffness grows with the overlap: given the one where GrainLoop's guard stops a run, the step holds for
        every contact that it lets pass.
        """
        mass = self.density * math.pi * smallest_radius**2
        hertz = math.sqrt(smallest_radius / 2 * overlap * smallest_radius)
        normal = limit(1.5 * self.normal_stiffness * hertz, self.normal_damping * mass / 2 * hertz, mass / 2)
        if self.friction == 0:
            return normal
        sliding = self.tangential_stiffness * hertz, self.tangential_damping * mass / 2 * hertz, mass / 6
        return min(normal, limit(*sliding))

    def force_between(self, radius, overlap):
        """Return K_n sqrt(R_eff) delta^1.5 [N], the force of resting disks of `radius` [m] that overlap by `overlap` of it."""
        return self.normal_stiffness * math.sqrt(radius / 2) * (overlap * radius) ** 1.5


def limit(stiffness, dashpot, mass):
    """Return leapfrog's stability limit [s] of a damped oscillator: stiffness [N/m], dashpot [kg/s], mass [kg]."""
    omega = math.sqrt(stiffness / mass)
    zeta = dashpot / (2 * math.sqrt(stiffness * mass))
    return 2 / omega * (math.sqrt(1 + zeta**2) - zeta)
