"""Solids by distance and normal, for YADE bodies of any shape.

    from graindrive.solids import surfaces
    drum = ~surfaces.cylinder((0, 0, 0), axis=(0, 1, 0), radius=0.2)     # all but a cylinder
    blade = surfaces.swept_outline([(-0.1, -0.01), (0.1, -0.01), (0.1, 0.01), (-0.1, 0.01)], low=0, high=0.3)
    O.bodies.append(surfaces.body(drum | blade))

A surface has the methods `distance(points)` [m], > 0 outside the solid, `normal(points)`, pointing outwards, and `bounds()`.
`a | b` is the union of two solids, `a & b` their intersection, `a - b` the part of a outside b, `~a` the complement. `recipe`
is a text from which `Surface(recipe)` makes the same surface to the last bit; scenes and pickles store it. Every function
raises ValueError with the rule, the value and the way out.
"""

import math

import numpy as np

from ..lazily import engines
from .recipes import number, vector, words

__all__ = [
    "ball",
    "body",
    "cylinder",
    "half_space",
    "sampled",
    "swept_outline",
]  # Surface and surface_kinds come from the compiled engines


def __getattr__(name):
    """Give `Surface` and `surface_kinds`, which the compiled module makes."""
    if name in ("Surface", "surface_kinds"):
        return getattr(engines, name)
    raise AttributeError(f"module {__name__} has no {name}")


def half_space(point, normal):
    """The half-space bounded by the plane through `point` [m]; `normal`, of any length, points out of the solid."""
    return engines.Surface(words("half_space", vector("point", point), vector("normal", normal)))


def ball(centre, radius):
    """A ball about `centre` [m] of a radius [m] > 0."""
    return engines.Surface(words("ball", vector("centre", centre), number("radius", radius)))


def cylinder(centre, axis, radius, length=math.inf):
    """A round cylinder about `centre` [m] along `axis`, of a radius and a length [m] > 0; without ends by default."""
    numbers = number("radius", radius), number("length", length)
    return engines.Surface(words("cylinder", vector("centre", centre), vector("axis", axis), *numbers))


def swept_outline(outline, low=-math.inf, high=math.inf, axis=(0, 0, 1)):
    """An outline swept along an axis: a prism from `low` to `high` [m] along it, by default along z and endless.

    outline: `graindrive.engines.Outline`, whose point (0, 0) lies on the axis, or its vertices, shape (n, 2) [m]. For
    another axis than z the outline is turned with z by the shortest way (for -z about x); `placed` turns it further.
    Raises ValueError for an outline as Outline does, for one end without the other, and unless low < high.
    """
    outline = outline if isinstance(outline, engines.Outline) else engines.Outline(outline)
    low, high = number("low", low), number("high", high)
    if math.isinf(low) != math.isinf(high):
        raise ValueError(f"low and high must both be finite or both be left out, got {low} and {high}; give both ends")
    if not low < high:
        raise ValueError(f"low must be less than high, got {low} and {high}; exchange them")
    middle = 0.0 if math.isinf(low) else (low + high) / 2
    if outline.disk_radius > 0:
        prism = cylinder((0, 0, middle), (0, 0, 1), outline.disk_radius, high - low)
    else:
        axes = (0, 0, middle), (1, 0, 0), (0, 1, 0)
        vertices = outline.vertices
        prism = engines.Surface(words("swept_outline", *axes, high - low, len(vertices), *vertices))
    axis = vector("axis", axis)
    return prism if np.array_equal(axis, (0, 0, 1)) else _turned_from_z(prism, axis)


def sampled(function, low, high, spacing):
    """Any solid, from a function of its distance, sampled on a grid from `low` to `high` at most `spacing` [m] apart.

    function: takes the nodes, an array of shape (n, 3) [m], in one call and gives n signed distances [m], > 0 outside
    the solid. The surface interpolates them (Keys 1981): with radii of curvature R the error is of the order
    spacing^3/R^2, at edges of the order spacing.
    The solid must lie within the grid, and the grid must extend beyond it by the radius of the largest sphere: outside the
    grid only a lower bound of the distance is known. Spheres larger than the least distance at the grid's outer nodes are
    refused. For the outside of a cavity, such as a vessel around its inside, sample the cavity and take ~.

    Raises ValueError for values of another shape, that are not finite, for a solid that reaches the grid's sides, and
    for a function that is no distance: its slope near the surface differs from 1 by more than 0.1 at half of the nodes, or
    is above 1.01 anywhere.
    """
    low, high, spacing = vector("low", low), vector("high", high), number("spacing", spacing)
    if not (0 < spacing < math.inf):
        raise ValueError(f"spacing must be positive and finite, got {spacing}; give a length > 0")
    sides = high - low
    if not (np.all(np.isfinite(sides)) and np.all(sides > 0)):
        raise ValueError(
            f"low must be less than high along each axis, got {low.tolist()} and {high.tolist()}; correct them"
        )
    count = np.maximum(np.ceil(sides / spacing * (1 - 1e-12)).astype(int) + 1, 4)
    step = sides / (count - 1)
    values = np.asarray(function(_nodes(count, low, step)), dtype=float)
    if values.shape != (count.prod(),):
        raise ValueError(
            f"the function must give one distance for each of {count.prod()} points, shape ({count.prod()},), "
            f"got shape {values.shape}; sum over the last axis of its argument, of shape (n, 3)"
        )
    return engines.Surface(engines.sampled_recipe(tuple(map(int, count)), tuple(low), tuple(step), values))


def body(
    surface, position=(0, 0, 0), orientation=None, material=-1, mass=0.0, inertia=None, held=True, color=(0.6, 0.6, 0.6)
):
    """A YADE body with a solid's shape, to be given to O.bodies.append.

    surface: given in the body's frame, whose origin lies at position [m] and which is rotated by orientation (a Quaternion).
    material: a FrictMat, or the index or label of one in O.materials. held: True blocks all six degrees of freedom,
    so that only drives move it; a free solid needs its mass [kg] and the three moments of inertia [kg m^2] about the
    frame's axes.
    Raises ValueError for a free solid without mass or inertia.
    """
    from yade import Body, O, Quaternion

    inertia = (0, 0, 0) if inertia is None else tuple(vector("inertia", inertia))
    if not held and not (0 < mass < math.inf and 0 < min(inertia) <= max(inertia) < math.inf):
        raise ValueError(
            f"a free solid needs mass and inertia > 0 and finite, got {mass} and {inertia}; give them or held=True"
        )
    made = Body()
    made.shape = engines.Solid(surface)
    made.shape.color = color
    made.mat = material if not isinstance(material, (int, str)) else O.materials[material]
    made.state.pos = made.state.refPos = tuple(vector("position", position))
    if orientation is not None:
        made.state.ori = made.state.refOri = Quaternion(orientation)
    made.state.mass = mass
    made.state.inertia = inertia
    made.state.blockedDOFs = "xyzXYZ" if held else ""
    made.aspherical = not held and len(set(inertia)) > 1
    return made


def _turned_from_z(prism, axis):
    length = np.linalg.norm(axis)
    if not 0 < length < math.inf:
        raise ValueError(f"axis must be finite and not zero, got {axis.tolist()}; give a direction of any length")
    about = np.cross((0, 0, 1), axis / length)
    sine = np.linalg.norm(about)
    return prism.placed(axis=about if sine > 0 else (1, 0, 0), angle=math.atan2(sine, axis[2] / length))


def _nodes(count, low, step):
    x, y, z = (low[k] + np.arange(count[k]) * step[k] for k in range(3))
    grid = np.meshgrid(z, y, x, indexing="ij")
    return np.stack([part.ravel() for part in reversed(grid)], axis=1)
