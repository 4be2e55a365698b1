"""What is read off a steady flow in a drum, of grains or a continuum: surface, profile across the layer, thickness, flow rates.

Definitions of Oba, Otsuki (2025), section III and appendices A, C and D. The drum's axis is the origin of (X, Y), Y upwards; it
turns counter-clockwise. The rotated frame, Eq. 48, has x down the slope and z into the bed, both from the axis:
x = -X cos a - Y sin a, z = X sin a - Y cos a, with a the angle of the surface at X = 0. Rigid rotation is u = -Omega z.
All functions are pure; lengths in d, times in sqrt(d/g), or in any other units that agree.
"""

from dataclasses import dataclass

import numpy as np

SQUARE = 1.2  # d, edge of the squares in which the paper takes the velocity
BED_FRACTION = 0.825  # solid fraction of the continuum's bed: the paper's, of the static part
SURFACE_LEVEL = {"dem": 0.7, "continuum": 0.5 * BED_FRACTION}  # of the solid fraction; alpha = 1/2
SURFACE_REACH = 1 / 8  # of the diameter: the surface is a line through its points that far on either side of the axis
SUB_POINTS = 8  # along each edge of a square
LEAST_FRACTION = 0.02  # with less in a square there is no velocity
STATIC_FROM, OFF_THE_WALL = 1.5, 5.0  # the static part: from so many h to so many squares from the wall
ABOVE = 0.1  # of the diameter: where profiles begin, above the axis


@dataclass(frozen=True)
class FlowField:
    """A steady flow on a grid: `x` (nx,), `y` (ny,) centres of cells, evenly spaced, the axis at 0; fields (ny, nx).

    `fraction` is the solid fraction, of a continuum `BED_FRACTION` times the volume fraction of the granular phase. Velocities
    count where it is not 0, and may be nan elsewhere. The free surface is where it falls to `surface_level`.
    """

    x: np.ndarray
    y: np.ndarray
    fraction: np.ndarray
    velocity_x: np.ndarray
    velocity_y: np.ndarray
    surface_level: float

    def __post_init__(self):
        shape = (len(self.y), len(self.x))
        for name in ("fraction", "velocity_x", "velocity_y"):
            if np.shape(getattr(self, name)) != shape:
                raise ValueError(f"{name} must have the grid's shape {shape}, got {np.shape(getattr(self, name))}")
        if min(shape) < 2:
            raise ValueError(f"the grid must have two cells or more along each axis, got {shape}")

    def within(self, diameter):
        """Return the same flow with nothing outside of the drum."""
        outside = np.hypot(self.x[None, :], self.y[:, None]) > diameter / 2
        fraction = np.where(outside, 0.0, self.fraction)
        return FlowField(self.x, self.y, fraction, self.velocity_x, self.velocity_y, self.surface_level)

    @property
    def fluxes(self):
        """Fraction times velocity along X and Y, 0 where nothing is, each (ny, nx)."""
        with np.errstate(invalid="ignore"):
            return tuple(
                np.where(self.fraction > 0, self.fraction * v, 0.0) for v in (self.velocity_x, self.velocity_y)
            )


@dataclass(frozen=True)
class Surface:
    """The free surface as a line through its points: `angle` [rad], counter-clockwise from X, and `height` at X = 0 [length].

    `x`, `y` (n,) are the points.
    """

    angle: float
    height: float
    x: np.ndarray
    y: np.ndarray

    @property
    def depth(self):
        """Where the surface lies on the line x = 0 of the rotated frame: its z, < 0 above the axis."""
        return -self.height * np.cos(self.angle)


@dataclass(frozen=True)
class Profile:
    """Velocity `u` down the slope and `fraction` at depths `z` on the line x = 0, in squares; u is nan where nothing is.

    `edge` is that of the squares; all arrays (n,), z rising.
    """

    z: np.ndarray
    u: np.ndarray
    fraction: np.ndarray
    edge: float

    @property
    def flux(self):
        """Fraction times u, 0 where nothing is, (n,)."""
        return np.nan_to_num(self.fraction * self.u)


# Free surface ---------------------------------------------------------------------------------------------------------


def surface_points(field, reach):
    """Return (x, y) of the free surface in each column of cells with |X| <= reach that has one, each (n,).

    It is where the fraction, linear between the centres of cells, last falls through the surface's level on the way up.
    """
    columns = np.flatnonzero(np.abs(field.x) <= reach)
    dense = field.fraction[:, columns] >= field.surface_level
    falls = dense[:-1] & ~dense[1:]
    columns, falls = columns[falls.any(axis=0)], falls[:, falls.any(axis=0)]
    low = len(falls) - 1 - np.argmax(falls[::-1], axis=0)
    below, above = field.fraction[low, columns], field.fraction[low + 1, columns]
    share = (below - field.surface_level) / np.where(below > above, below - above, np.inf)
    return field.x[columns], field.y[low] + share * (field.y[low + 1] - field.y[low])


def surface_of(field, diameter):
    """Return the `Surface` at X = 0; nan where fewer than three columns of cells have one.

    The paper takes the angle at X = 0. Here it is that of the line of least squares through the points within
    `SURFACE_REACH` of the diameter: narrow enough that the surface's S shape does not count, as that is odd in X and flat.
    """
    x, y = surface_points(field, SURFACE_REACH * diameter)
    if len(x) < 3:
        return Surface(float("nan"), float("nan"), x, y)
    slope, height = np.polyfit(x, y, 1)
    return Surface(float(np.arctan(slope)), float(height), x, y)


# Across the layer -----------------------------------------------------------------------------------------------------


def profile_of(field, angle, diameter, edge=SQUARE):
    """Return the `Profile` along the line through the axis normal to a surface of that `angle` [rad].

    Each square's velocity is the mean over what is in it, weighted by the fraction: the grains of a square, or the cells that
    overlap with it (appendix A). It is summed over `SUB_POINTS`^2 points of the square, with fields linear between centres.
    """
    first, last = -np.ceil(ABOVE * diameter / edge), np.ceil(diameter / 2 / edge)
    z = (np.arange(first, last) + 0.5) * edge
    fraction, flux = np.full(len(z), np.nan), np.full(len(z), np.nan)
    if np.isfinite(angle):
        within = ((np.arange(SUB_POINTS) + 0.5) / SUB_POINTS - 0.5) * edge
        x, depth = (axis.ravel() for axis in np.meshgrid(within, within))
        points = from_rotated(x[None, :], z[:, None] + depth[None, :], angle)
        fraction = interpolated(field, field.fraction, points).mean(axis=1)
        flux_x, flux_y = (interpolated(field, flux, points).mean(axis=1) for flux in field.fluxes)
        flux = -np.cos(angle) * flux_x - np.sin(angle) * flux_y
    with np.errstate(invalid="ignore", divide="ignore"):
        u = np.where(fraction > LEAST_FRACTION, flux / fraction, np.nan)
    return Profile(z, u, fraction, edge)


def from_rotated(x, z, angle):
    """Return (X, Y) of points (x, z) of the rotated frame: Eq. 48 is its own inverse but for the sign of the sine."""
    return -x * np.cos(angle) + z * np.sin(angle), -x * np.sin(angle) - z * np.cos(angle)


def interpolated(field, values, points):
    """Return a field (ny, nx) at points (X, Y), linear between centres of cells and 0 outside of them."""
    places, shares, inside = [], [], True
    for grid, at in zip((field.x, field.y), points):
        along = (at - grid[0]) / (grid[1] - grid[0])
        inside = inside & (along >= 0) & (along <= len(grid) - 1)
        low = np.clip(np.floor(along).astype(int), 0, len(grid) - 2)
        places.append(low)
        shares.append(along - low)
    (i, j), (a, b) = places, shares
    mixed = (1 - b) * ((1 - a) * values[j, i] + a * values[j, i + 1]) + b * (
        (1 - a) * values[j + 1, i] + a * values[j + 1, i + 1]
    )
    return np.where(inside, mixed, 0.0)


def zero_of(profile):
    """Return the z at which u, linear between squares, first changes its sign below its largest value; nan if nowhere."""
    if not np.isfinite(profile.u).any():
        return float("nan")
    fastest = int(np.nanargmax(profile.u))
    turns = np.flatnonzero((profile.u[fastest:-1] > 0) & (profile.u[fastest + 1 :] <= 0))
    if len(turns) == 0:
        return float("nan")
    k = fastest + turns[0]
    return float(profile.z[k] + profile.edge * profile.u[k] / (profile.u[k] - profile.u[k + 1]))


def flow_rates(profile):
    """Return (Q+, Q-), integrals of fraction times u over the squares where u > 0 and u < 0; in a steady state Q+ + Q- = 0."""
    return tuple(float(profile.edge * np.sum(part)) for part in (profile.flux.clip(min=0), profile.flux.clip(max=0)))


def static_part(profile, thickness, diameter):
    """Return which squares lie in the static part: from `STATIC_FROM` thicknesses to `OFF_THE_WALL` squares off the wall."""
    deep = profile.z > STATIC_FROM * thickness
    return deep & (profile.z < diameter / 2 - OFF_THE_WALL * profile.edge) & np.isfinite(profile.u)


def rigid_deviation(profile, static, omega):
    """Return the root mean square of u + Omega z over that of Omega z in the squares `static`; nan without any."""
    rigid = -omega * profile.z[static]
    return norm(profile.u[static] - rigid) / norm(rigid) if static.any() else float("nan")


def difference(one, other, diameter):
    """Return the L2 norm of the difference of u of two `Profile`s over that of the first, from z = 0 to the wall.

    The second is taken at the depths of the first, linear between its own; squares in which either has no velocity are left
    out. nan if none is left.
    """
    known = np.isfinite(other.u)
    u = np.interp(one.z, other.z[known], other.u[known], left=np.nan, right=np.nan) if known.any() else one.u * np.nan
    kept = (one.z > 0) & (one.z < diameter / 2) & np.isfinite(one.u) & np.isfinite(u)
    return norm(u[kept] - one.u[kept]) / norm(one.u[kept]) if kept.any() else float("nan")


def norm(values):
    """Return the root of the sum of squares."""
    return float(np.sqrt(np.sum(np.square(values))))


# All of it ------------------------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Found:
    """What one field gives: its `surface`, its `profile`, and `numbers`, {name of summary.json: value}."""

    surface: Surface
    profile: Profile
    numbers: dict


def analysed(field, diameter, omega, edge=SQUARE):
    """Return what is `Found` of a flow in a drum of `diameter` that turns with `omega`, in squares of that edge.

    h is the depth below the axis at which u = 0, as in the paper, which takes the surface of a half full drum to pass through
    the axis (appendix D); `layer_over_diameter` is counted from the surface that was found.
    """
    field = field.within(diameter)
    surface = surface_of(field, diameter)
    profile = profile_of(field, surface.angle, diameter, edge)
    thickness, (down, up) = zero_of(profile), flow_rates(profile)
    static = static_part(profile, thickness, diameter)
    numbers = dict(
        surface_angle_deg=float(np.degrees(surface.angle)),
        thickness_over_diameter=thickness / diameter,
        layer_over_diameter=(thickness - surface.depth) / diameter,
        surface_over_diameter=surface.depth / diameter,
        packing_fraction=float(profile.fraction[static].mean()) if static.any() else float("nan"),
        rigid_deviation=rigid_deviation(profile, static, omega),
        flow_down=down / (omega * diameter**2),
        flow_up=up / (omega * diameter**2),
        flow_balance=(down + up) / down if down > 0 else float("nan"),
        surface_speed=float(np.nanmax(profile.u)) / (omega * diameter)
        if np.isfinite(profile.u).any()
        else float("nan"),
    )
    return Found(surface, profile, numbers)
