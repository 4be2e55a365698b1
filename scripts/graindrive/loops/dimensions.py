"""Decides whether a scene written for YADE's loop holds disks in a plane or spheres in space."""

import numpy as np

from ..lazily import engines
from ..base.errors import UsageError

OUT_OF_PLANE = frozenset("zXY")  # degrees of freedom that take a body out of a plane z = const


def of_scene(newton):
    """Return 3 for a scene of spheres in space, 2 for one of disks in a plane z = const; `newton` is its integrator.

    It is 3 if some sphere or clump may leave the plane (not all of z, X, Y are in its blockedDOFs) and something takes
    bodies out of it: centres of spheres at different z, a body that moves along z or turns about x or y, or gravity
    along z. Bodies that lie in one plane and do not move out of it stay there, whatever is blocked: such a scene holds
    disks. The function does not consider what drives, forces and other engines will do.
    """
    from yade import O

    bodies = [body for body in O.bodies if is_grain_or_clump(body)]
    if not any(OUT_OF_PLANE - set(body.state.blockedDOFs) for body in bodies):
        return 2
    moving = any(body.state.vel[2] or body.state.angVel[0] or body.state.angVel[1] for body in bodies)
    return 3 if newton.gravity[2] != 0 or moving or not spheres_lie_in_one_plane() else 2


def is_grain_or_clump(body):
    """True for spheres and clumps; members move with their clump, and bodies of other shapes do not count."""
    return body.isClump or (not body.isClumpMember and type(body.shape).__name__ == "Sphere")


def spheres_lie_in_one_plane():
    """True if all spheres have the same z to 1e-9 of their radii, as GrainLoop requires for disks."""
    from yade import O

    table = engines.body_table(O._sceneObj)
    z = table["position"][:, 2]
    return bool((np.abs(z - z[:1]) <= 1e-9 * table["radius"]).all())


def periods_of_scene(periods, dimensions):
    """Return the periods along x, y, z [m] for GrainLoop: those given, (x, y) of disks or (x, y, z), or those of O.cell.

    UsageError for a wrong number of periods.
    """
    from yade import O

    if periods is None:
        size = (
            [O.cell.hSize[k][k] for k in range(3)] if O.periodic else (0, 0, 0)
        )  # O.cell.size: lengths of tilted edges
        return (size[0], size[1], size[2] if dimensions == 3 else 0)
    given = tuple(map(float, periods))
    if len(given) == 2 and dimensions == 2:
        return (*given, 0)
    if len(given) != 3:
        wanted = "(x, y)" if dimensions == 2 else "(x, y, z)"
        raise UsageError(
            f"periods of a scene of {'disks' if dimensions == 2 else 'spheres'} must be {wanted}, 0 along axes that are"
            f" not periodic, got {given}; give dimensions=2 or 3 if the scene was taken for the other kind"
        )
    return given
