"""When a body that is shaken sideways rises: grains fall freely into the cavity behind it (Tripura et al., Eqs 3.6-3.17).

A body of height h and amplitude A leaves a cavity of length 2A behind it in half a period. Grains fall into it; those that
get below the lowest point with a vertical tangent, l below the top, cannot come back and lift the body.

All printed forms agree: Eq. 3.10 is the integral of 3.9 to the last term, 3.13 and 3.15 follow from it, and 3.14 is
where it vanishes. Table 1 cuts its values off instead of rounding them (2.828 is printed as 2.82, 4.176 as 4.17). In
Eqs 3.6-3.9 the "1" beside d/2 is the letter l.

Three things to know before fitting data with it. The amplitude drops out: only T and the shape are left. The fall counts
for twice the time since the body turned in 3.6 (2 g t^2, hence 3.14), but once a half period in T_max = sqrt(8h/g). And
3.16 is not the continuation of 3.15: at T_max V_y jumps, and for a body whose lowest vertical tangent is at its foot
(square, rectangles, triangle) h = l, so that it no longer rises at all.

Units: any with one g; in the study's d = g = 1.
"""

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class CavityModel:
    """The model for a shape of height h, `height`, and l, `fall_height` (0 for a triangle on its apex); d and g of the grains."""

    fall_height: float
    height: float
    grain_diameter: float = 1.0
    gravity: float = 1.0

    def __post_init__(self):
        for name, value in vars(self).items():
            if not (np.isfinite(value) and (value > 0 or (name == "fall_height" and value == 0))):
                raise ValueError(f"{name} must be positive and finite, got {value}")
        if self.fall_height > self.height * (1 + 1e-9):
            raise ValueError(f"fall_height must not exceed height, {self.height}, got {self.fall_height}")

    @property
    def fall(self):
        """l' = l + d/2: how far a grain on top of the body has to fall [length]."""
        return self.fall_height + self.grain_diameter / 2

    @property
    def first_rising_period(self):
        """T_rise = sqrt(2 l'/g), Eq. 3.14: below it no grain gets under the body [time]."""
        return np.sqrt(2 * self.fall / self.gravity)

    @property
    def fastest_period(self):
        """T_max = sqrt(8 h/g): above it the cavity is full before the body returns [time]."""
        return np.sqrt(8 * self.height / self.gravity)

    def rise_rate(self, period):
        """Return V_y [velocity] for one period or an array of them by Eq. 3.17; 0 below T_rise, where the model is silent."""
        t = np.asarray(period, dtype=float)
        if not np.all(t > 0):
            raise ValueError(f"period must be positive, got {period}")
        filling = np.where(t <= self.fastest_period, self.filling_rate(t), (self.height - self.fall_height) / t)
        return np.where(t > self.first_rising_period, filling, 0.0)[()]

    def filling_rate(self, period):
        """Return V_y [velocity] of a cavity that is still being filled, Eq. 3.15, at T >= T_rise."""
        a = self.first_rising_period / period
        bracket = 1 - 2 / np.pi**2 - a**2 - 2 / np.pi**2 * np.cos(np.pi * a) - 2 / np.pi * a * np.sin(np.pi * a)
        return self.gravity * period / 2 * bracket


def smallest_amplitude(grain_diameter=1.0):
    """Return A_min = d/2: a cavity of length 2A has to let a grain in (text below Eq. 3.17)."""
    return grain_diameter / 2
