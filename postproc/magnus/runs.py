"""What the report of a Magnus campaign takes from its runs: distributions by angle, and fields over repeats."""

from dataclasses import dataclass, replace

import numpy as np

from .figure import fields_of


# ---- distributions by angle ------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class ByAngle:
    """One run's distributions: theta (bins,) [rad], F_N and F_T [N] and N_theta [-] with standard errors, each (bins,).

    theta counts counter-clockwise from V, for omega > 0. F_N presses the body and F_T > 0 opposes its spin: the signs of
    the paper's Eqs. 5 and 7 (the study stores the tangential force counter-clockwise).
    """

    theta: np.ndarray
    normal: np.ndarray
    normal_err: np.ndarray
    tangential: np.ndarray
    tangential_err: np.ndarray
    contacts: np.ndarray

    @property
    def front(self):
        """Which bins have |theta| < pi/2."""
        return np.abs(self.theta) < np.pi / 2


def by_angle(campaign, rows):
    """Return the `ByAngle` of each run of `rows`."""
    found = [campaign.run(name).group("angular") for name in rows["run"]]
    return [
        ByAngle(a["theta"], a["normal"], a["normal_err"], -a["tangential"], a["tangential_err"], a["contacts_by_angle"])
        for a in found
    ]


# ---- fields ----------------------------------------------------------------------------------------------------------


def fields_over_repeats(campaign, rows):
    """Return the `Fields` around the body, lengths in d, velocities over V0, averaged over the runs of `rows`.

    The runs stand as the phases of one average: frames of all of them count alike.
    """
    found = [fields_of(campaign.run(name)) for name in rows["run"]]
    arrays = {name: np.concatenate([f.arrays[name] for f in found]) for name in found[0].arrays}
    return replace(found[0], samples=np.concatenate([f.samples for f in found]), arrays=arrays)
