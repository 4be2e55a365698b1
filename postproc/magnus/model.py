"""The model of the saturated lift, Kumar, Dhiman, Reddy, Phys. Rev. E 99, 012902 (2019), section IV.

All contacts slip and their friction points clockwise on a body that turns counter-clockwise; angles from the velocity.
"""

import numpy as np


def symmetric_lift_to_drag(mu):
    """Return L/D = mu (Eq. 9): normal forces symmetric about the velocity, as in dilute systems."""
    return mu


def saturated_lift_to_drag(kappa, mu):
    """Return L/D = kappa mu - (1 - kappa)/mu (Eq. 15) [-] from kappa = sum F_N cos(theta)/D (Eq. 14).

    It is 0 without friction, where kappa is 1 and there is no lift.
    """
    mu, kappa = np.asarray(mu, float), np.asarray(kappa, float)
    return np.where(mu > 0, kappa * mu - (1 - kappa) / np.where(mu > 0, mu, 1), 0.0)[()]
