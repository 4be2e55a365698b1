"""Translates the contact law, the materials and the damping of a scene for YADE's loop into GrainLoop's settings."""

import functools
import math

from ..base.errors import UsageError
from ..lazily import engines

OUR_IP2 = "Ip2_FrictMat_FrictMat_ContactPhys"
# Law2_ -> its Ip2_, GrainLoop.law, and attributes that must keep their defaults because GrainLoop does not have them
YADE_LAWS = {
    "Law2_ScGeom_FrictPhys_CundallStrack": (
        "Ip2_FrictMat_FrictMat_FrictPhys",
        "cundallStrack",
        dict(neverErase=False, traceEnergy=False),
        dict(kn=None, ks=None),
    ),
    "Law2_ScGeom_MindlinPhys_Mindlin": (
        "Ip2_FrictMat_FrictMat_MindlinPhys",
        "hertzMindlin",
        dict(includeAdhesion=False, includeMoment=False, neverErase=False, calcEnergy=False),
        dict(gamma=0, eta=0, krot=0, ktwist=0),
    ),
}


@functools.lru_cache(maxsize=None)
def our_laws():
    """Return {our own Law2_: GrainLoop.law}."""
    return engines.law_functors()


@functools.lru_cache(maxsize=None)
def our_attributes():
    """Return the names of all constants that laws of our own have, as a tuple."""
    known = engines.contact_laws()
    return tuple(dict.fromkeys(key for law in our_laws().values() for key in known[law]))


def law_settings(contacts):
    """Return GrainLoop's arguments for the law, the friction and the materials of an InteractionLoop.

    If GrainLoop would compute something different, UsageError names the functor and the attribute, or two bodies.
    """
    law = only(contacts.lawDispatcher.functors, "Law2_")
    ip2 = only(contacts.physDispatcher.functors, "Ip2_")
    name = type(law).__name__
    if name in our_laws():
        return our_law(law, ip2)
    if name not in YADE_LAWS:
        raise UsageError(f"GrainLoop knows the laws {', '.join([*our_laws(), *YADE_LAWS])}; the scene uses {name}")
    return yade_law(law, ip2, contacts.geomDispatcher.functors)


def only(functors, kind):
    """Return the only functor of a dispatcher; UsageError if there are several or none."""
    if len(functors) == 1:
        return functors[0]
    found = ", ".join(type(f).__name__ for f in functors) or "none"
    raise UsageError(f"GrainLoop needs exactly one {kind} functor in the InteractionLoop, got {found}")


def require_ip2(ip2, expected, law):
    """Refuse an Ip2_ functor that does not belong to the law."""
    if type(ip2).__name__ != expected:
        raise UsageError(f"GrainLoop takes {type(law).__name__} with {expected} only, got {type(ip2).__name__}")


def require_defaults(functor, allowed):
    """Refuse changed attributes that GrainLoop does not have; the error names functor and attribute."""
    for key, value in allowed.items():
        got = getattr(functor, key)
        if got != value:
            raise UsageError(
                f"GrainLoop has no {type(functor).__name__}.{key}: it must be {value}, got {got};"
                " use YADE's loop, or leave it out"
            )


def our_law(law, ip2):
    """Return the arguments for one of Graindrive's own laws; friction from its Ip2_ functor, or else from the materials."""
    require_ip2(ip2, OUR_IP2, law)
    if law.leverArm != "radius":
        raise UsageError(f"GrainLoop's friction acts at the grains' radius; the functor has leverArm='{law.leverArm}'")
    friction = ip2.friction if ip2.friction >= 0 else math.tan(common_material("frictionAngle").frictionAngle)
    constants = {key: getattr(law, key) for key in our_attributes() if hasattr(law, key)}
    return dict(law=our_laws()[type(law).__name__], friction=friction, **constants)


def yade_law(law, ip2, geometries):
    """Return the arguments for one of YADE's own laws, with the constants of the single material of all bodies.

    Only the Ig2_ functor of two spheres matters, because GrainLoop refuses bodies of other shapes.
    """
    expected, name, of_law, of_ip2 = YADE_LAWS[type(law).__name__]
    require_ip2(ip2, expected, law)
    names = [type(functor).__name__ for functor in geometries]
    if "Ig2_Sphere_Sphere_ScGeom" not in names:
        raise UsageError(f"{type(law).__name__} needs Ig2_Sphere_Sphere_ScGeom, got {', '.join(names) or 'none'}")
    require_defaults(law, of_law)
    require_defaults(ip2, of_ip2)
    require_defaults(geometries[names.index("Ig2_Sphere_Sphere_ScGeom")], dict(avoidGranularRatcheting=True))
    material = common_material("young", "poisson", "frictionAngle")
    angle = matched(ip2, "frictAngle", material.frictionAngle)
    ratios = damping_ratios(ip2) if name == "hertzMindlin" else {}
    return dict(law=name, friction=math.tan(angle), young=material.young, poisson=material.poisson, **ratios)


def matched(ip2, key, value=None):
    """Return the value of an Ip2_ functor's MatchMaker for two bodies with the same `value`; without MatchMaker, `value`."""
    matcher = getattr(ip2, key)
    if matcher is None:
        return value
    if matcher.matches:
        raise UsageError(
            f"GrainLoop has one material: {type(ip2).__name__}.{key} must not list matches, got {matcher.matches};"
            " give MatchMaker(algo='val', val=...)"
        )
    if value is None:
        return matcher(0, 0)
    return matcher.computeFallback(value, value)


def damping_ratios(ip2):
    """Return GrainLoop's damping ratios as Ip2_FrictMat_FrictMat_MindlinPhys makes them: betan, betas, or en, es."""
    for one, other in (("en", "betan"), ("es", "betas")):
        if getattr(ip2, one) is not None and getattr(ip2, other) is not None:
            raise UsageError(f"{type(ip2).__name__}: only one of {one} and {other} may be given, got both")
    if ip2.en is not None or ip2.es is not None:
        normal, tangential = matched(ip2, "en"), matched(ip2, "es")
        normal, tangential = tangential if normal is None else normal, normal if tangential is None else tangential
        ratios = [ratio_of_restitution(normal), ratio_of_restitution(tangential)]
    else:
        normal = matched(ip2, "betan")
        normal = 0.0 if normal is None else normal
        tangential = matched(ip2, "betas")
        ratios = [normal, normal if tangential is None else tangential]
    return dict(normalDampingRatio=ratios[0], tangentialDampingRatio=ratios[1])


# Thornton, Cummins, Cleary, Powder Technology 233, 30 (2013), Table 2
THORNTON = (-6.918798, -16.41105, 146.8049, -796.4559, 2928.711, -7206.864, 11494.29, -11342.18, 6276.757, -1489.915)


def ratio_of_restitution(restitution):
    """Return the damping ratio for a restitution in (0, 1] by Thornton et al. (2013), Eqs (B6) and (B7), as YADE does."""
    if not 0 < restitution <= 1:
        raise UsageError(f"a coefficient of restitution must lie in (0, 1], got {restitution:g}")
    if restitution == 1:
        return 0.0
    exponent = 0.0
    for coefficient in reversed(THORNTON):
        exponent = restitution * (coefficient + exponent)
    return math.sqrt(1 / (1 - (1 + restitution) ** 2 * math.exp(exponent)) - 1)


def common_material(*properties):
    """Return a material whose properties of these names all bodies share; UsageError names two bodies that differ."""
    from yade import O

    first = None
    for body in O.bodies:
        if body.mat is None:  # a clump; its members have one
            continue
        first = first or body
        for key in properties:
            here, there = getattr(body.mat, key), getattr(first.mat, key)
            if here != there:
                raise UsageError(
                    f"GrainLoop has one material for all contacts: {key} of body {body.id} is {here:g},"
                    f" that of body {first.id} is {there:g}; make them equal"
                )
    if first is None:
        raise UsageError(
            "GrainLoop takes friction and stiffness from the bodies' materials, but O.bodies holds no material"
        )
    return first.mat


def damping_settings(newton):
    """Return GrainLoop's arguments for the damping of a NewtonIntegrator.

    UsageError if YADE would damp one body differently from the others: State.isDamped=False, or a clump that may rotate about
    x or y, whose torque YADE damps by another rule.
    """
    from yade import O

    if newton.damping == 0:
        return {}
    for body in O.bodies:
        if not body.state.isDamped:
            raise UsageError(f"GrainLoop damps all bodies alike; body {body.id} has state.isDamped=False")
        turns_freely = not set(body.state.blockedDOFs) & set("XYZ")
        if body.isClump and body.aspherical and turns_freely and newton.exactAsphericalRot:
            raise UsageError(
                f"clump {body.id} may turn about x and y, and YADE then damps its torque by another rule;"
                " set its state.blockedDOFs='zXY', or NewtonIntegrator.exactAsphericalRot=False"
            )
    return dict(damping=newton.damping, dampGravity=newton.dampGravity)
