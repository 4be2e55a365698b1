"""The grains' materials and their largest stable time steps."""

import math
from dataclasses import dataclass

from ..lazily import engines

MOST_CONTACTS = 6  # largest number of contacts of a disk among disks of about its size


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

    LAW = "hertzHistory"

    def critical_time_step(self, smallest_radius, overlap):
        """Return the largest stable step [s] of two smallest disks overlapping by `overlap` of their radius.

        Normal motion has the mass m_eff. Tangential motion of two disks (I = m R^2/2) has a third of it, because they can also
        rotate. Hertz stiffness grows with the overlap: with the overlap at which GrainLoop's guard stops a run, the step is
        stable for every contact that the guard allows.
        """
        return critical_time_step_of_disks(self, smallest_radius, overlap)

    def bed_time_step(self, smallest_radius):
        """Return the step [s] above which a bed may become unstable: none is known, because stiffness depends on the overlap.

        A bed's overlaps are far below the overlap of `critical_time_step`: at a smaller overlap delta the step may be
        (overlap/delta)^(1/4) times as long, which outweighs the effect of six contacts if delta < overlap/36.
        """
        return math.inf

    def force_between(self, radius, overlap):
        """Return the force [N] of resting disks of `radius` [m] that overlap by `overlap` of it."""
        return self.terms(radius, overlap)["elastic"]

    def terms(self, radius, overlap):
        """Return the law's terms for two disks of `radius` [m] that overlap by `overlap` of it, see `engines.terms_of_law`."""
        mass = self.density * math.pi * radius**2
        return engines.terms_of_law(self.LAW, self.given(), overlap * radius, radius / 2, mass / 2)

    def given(self):
        """Return what the law is given, under the names of GrainLoop and of the Law2_ functor."""
        return dict(
            normalStiffness=self.normal_stiffness,
            tangentialStiffness=self.tangential_stiffness,
            normalDamping=self.normal_damping,
            tangentialDamping=self.tangential_damping,
        )


@dataclass(frozen=True)
class SpringDashpotMaterial:
    """Disks under the linear spring-dashpot law of Oba, Otsuki (2025), in any consistent units.

    normal_stiffness k_n, tangential_stiffness k_t [N/m]; restitution e, which sets both dashpots, and friction mu [-];
    density [kg/m^2] of a disk.
    """

    normal_stiffness: float
    tangential_stiffness: float
    restitution: float
    friction: float
    density: float

    LAW = "springDashpot"

    def critical_time_step(self, smallest_radius, overlap):
        """Return the largest stable step [s] of two smallest disks; the law is linear, so `overlap` [R] plays no part."""
        return critical_time_step_of_disks(self, smallest_radius, overlap)

    def bed_time_step(self, smallest_radius):
        """Return the step [s] up to which every bed is stable, whatever its overlaps: that of a disk with six contacts."""
        return critical_time_step_of_disks(self, smallest_radius, 1e-3, MOST_CONTACTS)

    def force_between(self, radius, overlap):
        """Return the force [N] of resting disks of `radius` [m] that overlap by `overlap` of it."""
        return self.terms(radius, overlap)["elastic"]

    def terms(self, radius, overlap):
        """Return the law's terms for two disks of `radius` [m] that overlap by `overlap` of it, see `engines.terms_of_law`."""
        mass = self.density * math.pi * radius**2
        return engines.terms_of_law(self.LAW, self.given(), overlap * radius, radius / 2, mass / 2)

    def given(self):
        """Return what the law is given, under the names of GrainLoop and of the Law2_ functor."""
        return dict(
            normalStiffness=self.normal_stiffness,
            tangentialStiffness=self.tangential_stiffness,
            restitution=self.restitution,
        )


def critical_time_step_of_disks(material, smallest_radius, overlap, contacts=1):
    """Return the largest stable step [s] of smallest disks of a material, for normal and for tangential motion.

    With several `contacts` per disk each contact gets an equal part of the masses. If all contacts are stable with their parts,
    the bed is stable: 4M - 2 dt C - dt^2 K is a sum over contacts, positive if each term is (Irons, Treharne 1971, with
    dashpots).
    """
    mass = material.density * math.pi * smallest_radius**2 / contacts
    at = material.terms(smallest_radius, overlap)
    normal = engines.critical_step(at["stiffness"], at["dashpot"], mass / 2)
    if material.friction == 0:
        return normal
    return min(normal, engines.critical_step(at["tangential_stiffness"], at["tangential_dashpot"], mass / 6))


@dataclass(frozen=True)
class HertzRestitutionSpheres:
    """Spheres under Hertz's law with a damping that gives one restitution (Table I of Guillard, Forterre, Pouliquen 2014).

    young E [Pa]; poisson nu, restitution e, friction mu [-]; density [kg/m^3]. Spheres of diameter d and mass m have
    k_n* = E sqrt(d)/(3 (1 - nu^2)) and gamma_n* = -sqrt(5/2) beta sqrt(m k_n*), beta = ln e/sqrt(ln^2 e + pi^2).
    """

    young: float
    poisson: float
    restitution: float
    friction: float
    density: float

    LAW = "hertzRestitution"

    def given(self):
        """Return what the law is given, under the names of GrainLoop and of the Law2_ functor."""
        return dict(young=self.young, poisson=self.poisson, restitution=self.restitution)

    def mass(self, radius):
        """Return the mass [kg] of a sphere of `radius` [m]."""
        return self.density * 4 / 3 * math.pi * radius**3

    def terms(self, radius, overlap):
        """Return the law's terms for two spheres of `radius` [m] that overlap by `overlap` of it, see `engines.terms_of_law`."""
        return engines.terms_of_law(self.LAW, self.given(), overlap * radius, radius / 2, self.mass(radius) / 2)

    def terms_on_a_plane(self, radius, overlap):
        """Return the same for a sphere on a held plane, or on a held solid, which counts as a plane."""
        return engines.terms_of_law(self.LAW, self.given(), overlap * radius, radius, self.mass(radius))

    def critical_time_step(self, smallest_radius, overlap):
        """Return the largest stable step [s] of two smallest spheres that overlap by `overlap` of their radius.

        Normal motion has the mass m_eff; tangential motion of two spheres (I = 2/5 m R^2) has 2/7 of it. A sphere on a plane
        has sqrt(2) times the stiffness at twice the mass, so its largest stable step is longer.
        """
        mass = self.mass(smallest_radius) / 2
        at = self.terms(smallest_radius, overlap)
        normal = engines.critical_step(at["stiffness"], at["dashpot"], mass)
        if self.friction == 0:
            return normal
        sliding = engines.critical_step(at["tangential_stiffness"], at["tangential_dashpot"], mass * 2 / 7)
        return min(normal, sliding)
