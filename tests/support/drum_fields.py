"""Made-up flows in a drum with closed forms: a plane surface, a layer with a parabola on top of rigid rotation."""

from dataclasses import dataclass

import numpy as np

from graindrive.postproc.drum.flow import FlowField


@dataclass(frozen=True)
class MadeUpDrum:
    """u(z) = -Omega (z - z_s) + speed (1 - (z - z_s)/b)^2 down to the depth b = `layer` below the surface at z_s, rigid below it.

    `speed` makes Q+ + Q- = 0 for a surface through the axis, z_s = 0; else rigid rotation is about the axis all the same.
    """

    diameter: float = 150.0
    omega: float = 6.28e-3
    angle_deg: float = 20.0
    layer: float = 26.0
    density: float = 0.82
    height: float = 0.0
    spacing: float = 0.6

    @property
    def speed(self):
        """U: U b/3 = Omega R^2/2."""
        return 3 * self.omega * (self.diameter / 2) ** 2 / (2 * self.layer)

    @property
    def thickness(self):
        """Where u = 0 for a surface through the axis: the smaller root of U (1 - z/b)^2 = Omega z."""
        a, b, c = self.speed / self.layer**2, 2 * self.speed / self.layer + self.omega, self.speed
        return (b - np.sqrt(b**2 - 4 * a * c)) / (2 * a)

    def u(self, z):
        """Velocity down the slope at depths z below the axis."""
        below = z + self.height * np.cos(np.radians(self.angle_deg))
        return -self.omega * z + self.speed * np.clip(1 - below / self.layer, 0, None) ** 2

    def field(self, surface_level=0.7):
        """Return the flow on a grid; bins at the surface hold what lies below it, to first order in their size."""
        count = 2 * int(np.ceil(self.diameter / 2 / self.spacing))
        x = (np.arange(count) + 0.5 - count / 2) * self.spacing
        X, Y = np.meshgrid(x, x)
        a = np.radians(self.angle_deg)
        below = X * np.sin(a) - Y * np.cos(a) + self.height * np.cos(a)
        fraction = self.density * np.clip(0.5 + below / self.spacing, 0, 1)
        down = self.speed * np.clip(1 - below / self.layer, 0, None) ** 2
        v_x, v_y = -self.omega * Y - down * np.cos(a), self.omega * X - down * np.sin(a)
        return FlowField(
            x, x, fraction, np.where(fraction > 0, v_x, np.nan), np.where(fraction > 0, v_y, np.nan), surface_level
        )
