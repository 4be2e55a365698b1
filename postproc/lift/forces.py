"""Drag, lift and stress by angle on a solid dragged through a bed of spheres, averaged over the steady state with errors.

Definitions of Guillard, Forterre, Pouliquen, Phys. Fluids 26, 043301 (2014): C_d of Eq. 2, the lift over the buoyancy
rho g V of Eq. 3 (rho the bed's bulk density, V the body's volume), stresses by angle of Eq. A4, and Eq. 4.
"""

from dataclasses import dataclass

import numpy as np

from .. import quantities
from ..statistics import block_mean, ratio_mean, steady_start

# Series of the lift study: means over a block. The body moves along +x relative to the base; z is up.
UNITS = quantities.units("series", "t travel fx fz contacts base_fx base_fz lid_z", quantities.SI)
BY_ANGLE = ("normal", "tangential")  # forces on the body by angle [N], (blocks, points)
PAPERS_TRANSIENT = 2.0  # D


@dataclass(frozen=True)
class Scene:
    """What the forces are compared with, SI: body's height D, breadth L, volume V; bulk density rho; depth of the axis.

    `effective_depth` is the h~ of the paper: of the bed above and of the lid. `bed_weight` and `lid_weight` are those of
    grains and lid; `friction` is the grains'.
    """

    gravity: float
    d: float
    height: float
    breadth: float
    volume: float
    bulk_density: float
    effective_depth: float
    bed_weight: float
    lid_weight: float
    friction: float
    speed: float
    grain_density: float

    @property
    def pressure(self):
        """P_0 = rho g h~ at the axis [Pa]."""
        return self.bulk_density * self.gravity * self.effective_depth

    @property
    def buoyancy(self):
        """rho g V [N]: of a cylinder rho g pi D^2 L/4."""
        return self.bulk_density * self.gravity * self.volume

    @property
    def area(self):
        """D L [m^2], across the motion."""
        return self.height * self.breadth

    @property
    def inertial_number(self):
        """I = (U_0/D) d sqrt(rho_g/P_0) [-]: small where the flow is quasi-static."""
        return self.speed / self.height * self.d * np.sqrt(self.grain_density / self.pressure)

    @property
    def grip(self):
        """Largest force along x that base and lid bear by friction [N]: mu times the weight that presses on each."""
        return self.friction * (self.bed_weight + 2 * self.lid_weight)


def angles_of(points):
    """Return the angles of the binner's points [rad], from the direction of travel, > 0 below the axis."""
    return (np.arange(points) + 0.5) * 2 * np.pi / points - np.pi


def steady_window(series, least_travel):
    """Return (slice of the steady state, whether it is one): after `least_travel` [d], later if drag or lift still drifts."""
    least = int(np.searchsorted(series["travel"], least_travel, side="right"))
    found = [steady_start(series[name][least:]) for name in ("fx", "fz")]
    return slice(least + max(cut for cut, _ in found), len(series["travel"])), all(steady for _, steady in found)


def steady_state(series, scene):
    """Return (summary, angular) of the steady state of block means with the names of `UNITS` (n,) and `BY_ANGLE` (n, points).

    summary: quantities of summary.json with errors NAME_err. angular, by angle from the direction of travel, > 0 below the
    axis, shape (points,): theta, normal_stress and tangential_stress [Pa] with errors, the latter counter-clockwise about y.
    """
    window, steady = steady_window(series, PAPERS_TRANSIENT * scene.height / scene.d)
    kept = {name: np.asarray(series[name])[window] for name in (*UNITS, *BY_ANGLE)}
    means = forces(kept, scene)
    summary = {}
    for name, mean in means.items():
        summary.update({name: mean.value, f"{name}_err": mean.error})
    angular = by_angle(kept, scene)
    stress, error = angular["normal_stress"][0], angular["normal_stress_err"][0]
    front = int(np.argmax(stress))
    theta = angular["theta"][0]
    summary.update(
        steady=int(steady),
        steady_from=float(kept["travel"][0]),
        steady_travel=float(np.ptp(kept["travel"])),
        peak_stress_over_pressure=float(stress[front] / scene.pressure),
        peak_stress_over_pressure_err=float(error[front] / scene.pressure),
        rear_stress_over_pressure=float(stress[np.abs(theta) > 5 * np.pi / 6].mean() / scene.pressure),
        local_pressure_lift=local_pressure_lift(theta, stress, scene),
    )
    summary.update(tangential_share(angular), drag_over_grip=summary["drag"] / scene.grip)
    return summary, angular


def forces(kept, scene):
    """Return {name: `Mean`} of drag (against the motion) and lift (up) [N], both without dimension, and the base's part."""
    drag, lift = -kept["fx"], kept["fz"]
    return dict(
        drag=block_mean(drag),
        lift=block_mean(lift),
        drag_coefficient=block_mean(drag / (scene.pressure * scene.area)),
        lift_over_buoyancy=block_mean(lift / scene.buoyancy),
        lift_to_drag=ratio_mean(lift, drag),
        contacts=block_mean(kept["contacts"]),
        weight_on_base=block_mean(-kept["base_fz"]),
        drag_on_base=block_mean(kept["base_fx"]),
    )


def by_angle(kept, scene):
    """Return theta and the stresses {name: (array, unit)} with errors: forces of the points over their share of the surface.

    The share of a point is pi D L/points: that of a cylinder's mantle. Of another shape it is a measure of force by angle.
    """
    points = kept["normal"].shape[1]
    share = np.pi * scene.area / points
    arrays = {"theta": (angles_of(points), "rad")}
    for name in BY_ANGLE:
        found = [block_mean(column / share) for column in kept[name].T]
        arrays[f"{name}_stress"] = (np.array([mean.value for mean in found]), "Pa")
        arrays[f"{name}_stress_err"] = (np.array([mean.error for mean in found]), "Pa")
    return arrays


def local_pressure_lift(theta, stress, scene):
    """Return the lift over the buoyancy that Eq. 4 predicts from a distribution of normal stress: (1/pi) int s sin^2 d(theta).

    s is the stress over P_0. It is meant for distributions measured without gravity in the bulk.
    """
    return float(np.sum(stress / scene.pressure * np.sin(theta) ** 2) * (theta[1] - theta[0]) / np.pi)


def tangential_share(angular):
    """Return the sum of |sigma_t| over the sum of sigma_n."""
    normal, tangential = angular["normal_stress"][0], angular["tangential_stress"][0]
    total = float(np.sum(normal))
    return {"tangential_share": float(np.sum(np.abs(tangential)) / total) if total > 0 else float("nan")}
