"""Further rules for scenes of spheres, beside those of `take_over`: features of YADE's loop that GrainLoop lacks."""

from .loop_laws import YADE_LAWS, our_laws
from .take_over import Rule


def yades_own_law(loop):
    """GrainLoop has YADE's own laws only for disks."""
    name = type(loop.contacts.lawDispatcher.functors[0]).__name__
    if name not in YADE_LAWS:
        return ""
    return f"it has {name} for disks in a plane only; take one of {', '.join(our_laws())}, or dimensions=2 for disks"


def damped(loop):
    """GrainLoop has Cundall's damping only for disks."""
    damping = loop.newton.damping
    return f"NewtonIntegrator.damping={damping:g}, and it damps disks only; set it to 0" if damping else ""


def turned_as_a_sphere(loop):
    """YADE turns a body by Euler's equations only if it is `aspherical` and exactAsphericalRot is set, GrainLoop always."""
    from yade import O

    exact = loop.newton.exactAsphericalRot
    for body in O.bodies:
        a, b, c = body.state.inertia
        turns = not body.isClumpMember and set("XYZ") - set(body.state.blockedDOFs)
        if turns and not a == b == c and not (exact and body.aspherical):
            what = f"O.bodies[{body.id}].aspherical" if exact else "NewtonIntegrator.exactAsphericalRot"
            return f"moments of inertia of body {body.id} differ and {what} is False; set it to True"
    return ""


RULES = [Rule(rule.__name__, rule) for rule in (yades_own_law, damped, turned_as_a_sphere)]
