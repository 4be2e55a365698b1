"""What the figures of a shear campaign share: claims, the points of mu(I) and phi(I), the drum paper's constants."""

from functools import partial

import numpy as np

from ..campaign.claims import claim_on
from ..campaign.runs import curve
from .rheology import fitted

PRINTED = dict(mu_s=0.246, mu_2=0.401, i_0=0.133)  # Oba, Otsuki 2025, appendix B, at an area fraction of 0.825
ROUNDING = 0.0005  # of the printed numbers
DISK = np.pi / 4  # mass of a disk of diameter d [rho d^2]: stiffness is given in m g/d, pressure in rho g d

claim = partial(
    claim_on,
    dict(
        inertial_number=("I", ""),
        grains=("", " disks"),
        friction=("μ_p", ""),
        restitution=("e", ""),
        pressure=("P", " ρgd"),
    ),
)
claim_on_area = partial(
    claim_on,
    dict(
        area_fraction=("φ", ""),
        shear_rate=("γ̇", " √(g/d)"),
        grains=("", " disks"),
        friction=("μ_p", ""),
        restitution=("e", ""),
    ),
)


def points_of(rows, name, key="inertial_number"):
    """Return (I (n,), the quantity `name` (n,) as `Measured`) of the runs, repeats joined by `key`: each I is their mean."""
    _, found = curve(rows, key, name)
    _, inertial = curve(rows, key, "flow_inertial_number")
    return np.array([i.value for i in inertial]), found


def up_to(rows, largest):
    """Return the runs whose I is at most `largest`."""
    return rows[rows["inertial_number"] <= largest]


def law_of(rows, key="inertial_number"):
    """Return the `FrictionLaw` of a sweep."""
    return fitted(*points_of(rows, "stress_ratio", key))
