"""Impacts of two grains: restitution, friction, spin, speed, ratios, stiffness, each compared with its closed form."""

import math

import numpy as np

from .few_grains import Grain, Law, R, advance, duration, mass_of, place, said_by, spring, state_of
from .outcome import BOUND, GUARD, RIGHT, judged, largest

CONTACT = 1e-3  # duration of a contact [d/v]; the contact turns by no more than this angle
STEPS = 500  # number of steps of a contact
SINGLE = (
    3e-3  # additional error in single precision: 6e-8 d relative to an overlap of some 3e-4 d, summed over the contact
)


def meeting(speed, *, apart=1e-5, weights=(1, 1), radii=(R, R), spins=(0, 0), at=0.0):
    """Return two grains: the first moves along x with this speed towards the second, at rest; their gap is `apart`."""
    distance = radii[0] + radii[1] + apart
    first = Grain((at, at), (speed, 0), radii[0], weights[0], spins[0])
    return [first, Grain((at + distance, at), (0, 0), radii[1], weights[1], spins[1])]


def met(pair, law, setting, dimensions, dt, steps, **settings):
    """Run a pair for some steps; return the states of both, as from `state_of`."""
    ids = place(pair, law, setting, dt, dimensions, **settings)
    advance(steps)
    return [state_of(ident) for ident in ids]


def stiffness_for(contact, mass):
    """Return the spring constant of a linear contact of that duration."""
    return mass * (math.pi / contact) ** 2


# Restitution ----------------------------------------------------------------------------------------------------------

RESTITUTIONS = (0.01, 0.1, 0.5, 0.9, 1.0)


def restitution(setting, *, dimensions):
    """Restitution 0.01 to 1 for both laws that have this parameter; the error is of first order in the time step."""
    mass, trials = mass_of(dimensions) / 2, dict(law=[], given=[], error=[])
    for name in ("springDashpot", "hertzRestitution"):
        for e in RESTITUTIONS:
            if name == "springDashpot":
                law, contact = spring(stiffness_for(CONTACT, mass), e), CONTACT
            else:
                law = Law(name, dict(young=5e6, poisson=0.45, restitution=e))
                depth = largest_depth(law, mass, 1.0)
                contact = 2.94 * depth
            apart, dt = 0.1 * contact, contact / (4 * STEPS)
            # Damping makes contacts longer, by 1/sqrt(1 - b^2) for the linear law, and up to six times at e = 0.01.
            (_, v1, _), (_, v2, _) = met(meeting(1.0, apart=apart), law, setting, dimensions, dt, 16 * STEPS)
            trials["law"].append(name)
            trials["given"].append(e)
            trials["error"].append(v2[0] - v1[0] - e)
    worst = max(trials["error"], key=abs)
    sentence = f"restitution {RESTITUTIONS[0]} to 1, linear and Hertz contacts of {4 * STEPS} steps: largest error"
    # The dashpot uses the velocity half a step earlier, which changes e by less than 2 omega dt.
    tolerance = 2 * math.pi / (4 * STEPS) + (SINGLE if setting.single else 0)
    source = "e = exp(−π b/√(1 − b²)); Antypov, Elliott 2011 for Hertz"
    return judged(RIGHT, worst, 0.0, tolerance, source, sentence, trials)


def largest_depth(law, mass, speed):
    """Return the largest overlap of an undamped impact: there the elastic energy equals the kinetic energy before."""
    low, high = 1e-12, 2 * R
    while high / low > 1 + 1e-12:
        middle = math.sqrt(low * high)
        low, high = (middle, high) if law.terms(middle, mass=mass)["energy"] < mass * speed**2 / 2 else (low, middle)
    return low


# Friction -------------------------------------------------------------------------------------------------------------

FRICTIONS = (0.0, 0.01, 0.05, 0.1, 0.15, 0.5, 1.0, 3.0, 10.0)
SURFACE = 1.2  # tangential over normal relative velocity at the contact


def surface_velocity(states):
    """Return the velocity of surface 1 against surface 2, along y, of grains side by side along x."""
    (_, v1, w1), (_, v2, w2) = states
    return v1[1] - v2[1] + R * (w1 + w2)


def friction(setting, *, dimensions):
    """mu 0 to 10 for linear contacts with equal frequencies: they slip all the time, or stick and reverse the velocity."""
    mass, inverse = mass_of(dimensions) / 2, 3 if dimensions == 2 else 3.5  # of m/m_sliding
    trials = dict(mu=[], found=[], expected=[])
    for mu in FRICTIONS:
        law = spring(stiffness_for(CONTACT, mass), 1.0, mu, 1 / inverse)
        pair = meeting(1.0, spins=(SURFACE / (2 * R),) * 2, apart=1e-5)
        states = met(pair, law, setting, dimensions, CONTACT / STEPS, 2 * STEPS)
        sticks = SURFACE / inverse <= mu
        trials["mu"].append(mu)
        trials["found"].append(surface_velocity(states))
        trials["expected"].append(-SURFACE if sticks else SURFACE - 2 * inverse * mu)
    errors = np.subtract(trials["found"], trials["expected"])
    worst = float(errors[np.abs(errors).argmax()])
    sentence = "μ 0 to 10, tangential velocity 1.2 times the normal one: largest error of the former after the impact"
    tolerance = 5 * CONTACT + (SINGLE if setting.single else 0)  # rotation of the contact's normal, and the time step
    source = "v_t − 2μ(m/m_t)v_n while slipping, −v_t where it sticks (equal frequencies)"
    return judged(RIGHT, worst, 0.0, tolerance, source, sentence, trials)


SPIN_RATIOS = (10.0, 100.0, 1000.0)  # omega R/v


def spin(setting, *, dimensions):
    """A spinning grain hits one at rest, spin ratio up to 1000: it slips all the time, so the impulses' ratio is mu."""
    mass, mu = mass_of(dimensions) / 2, 0.5
    trials = dict(ratio=[], friction=[])
    for ratio in SPIN_RATIOS:
        law = spring(stiffness_for(CONTACT, mass), 1.0, mu)
        pair = meeting(1.0, spins=(ratio / R, 0))
        (_, v1, _), (_, v2, _) = met(pair, law, setting, dimensions, CONTACT / STEPS, 2 * STEPS)
        trials["ratio"].append(ratio)
        trials["friction"].append(v2[1] / v2[0])
    worst = max(trials["friction"], key=lambda f: abs(f / mu - 1)) / mu
    sentence = "spin ratio ωR/v 10 to 1000, μ = 0.5: tangential impulse over μ times the normal one, furthest from 1"
    return judged(
        RIGHT, worst, 1.0, 5 * CONTACT + (SINGLE if setting.single else 0), "Coulomb: J_t = μ J_n", sentence, trials
    )


def angular_momentum(setting, *, dimensions):
    """Forces act at each grain's own surface, so that a contact with friction changes the angular momentum by delta F_t dt."""
    contact, mu, ratio = 0.1, 0.5, 10.0
    full = mass_of(dimensions)
    inertia = full * R**2 * (0.5 if dimensions == 2 else 0.4)
    k_n = stiffness_for(contact, full / 2)
    pair = meeting(1.0, spins=(ratio / R, 0))
    states = met(pair, spring(k_n, 1.0, mu), setting, dimensions, contact / 2000, 4000)
    after = sum(full * (x[0] * v[1] - x[1] * v[0]) + inertia * w for x, v, w in states)
    depth = contact / math.pi  # v/omega
    expected = mu * k_n * depth**2 * contact / 2
    found = (inertia * ratio / R - after) / expected
    sentence = (
        f"slipping contact, overlap {depth / R:.2g} R: angular momentum that the pair loses over μ∫δ F_n dt; the loss is"
        f" {depth / (2 * R):.2g} of the angular impulse on both grains"
    )
    # The normal turns by about v_t contact/d during the contact, which changes both impulses to first order.
    return judged(BOUND, found, 1.0, 0.1, "torque R n×F_t on both grains (engines/README.md)", sentence)


# Speed ----------------------------------------------------------------------------------------------------------------

LIMIT = 0.1  # overlap at which GrainLoop stops a run [R]
SPEED_LAWS = (
    Law("springDashpot", dict(normalStiffness=1e6, tangentialStiffness=3e5, restitution=1.0)),
    Law("hertzRestitution", dict(young=5e6, poisson=0.45, restitution=1.0)),
)


def driven_meeting(law, setting, dimensions, speed, dt, gap):
    """Put a grain that keeps its speed, and a free one in its way, into YADE; return their ids."""
    pair = [Grain((0, 0), (speed, 0), held=True), Grain((2 * R + gap, 0))]
    return place(pair, law, setting, dt, dimensions)


def speed_limit(setting, *, dimensions):
    """The speed of a driven grain at which the overlap guard stops a run: m V^2/2 equals the contact's energy at 0.1 R."""
    trials, guards = dict(law=[], ratio=[]), set()
    for law in SPEED_LAWS:
        mass = mass_of(dimensions)
        expected = math.sqrt(2 * law.terms(LIMIT * R, mass=mass)["energy"] / mass)
        dt = duration(law, mass, LIMIT * R / 2) / 4000  # the guard checks every 100 steps

        def goes_on(ratio, law=law, dt=dt, expected=expected):
            driven_meeting(law, setting, dimensions, ratio * expected, dt, 0.1 * LIMIT * R)
            said = said_by(lambda: advance(10_000))
            guards.add("overlap by" in said if said else True)
            return not said

        trials["law"].append(law.LAW)
        trials["ratio"].append(largest(goes_on, 0.5, 2.0, 1e-3))
    worst = max(trials["ratio"], key=lambda r: abs(r - 1))
    sentence = "speed of a driven grain at which the overlap guard stops the run, over the speed V with ½mV² = U(0.1 R)"
    return judged(GUARD, worst if all(guards) else math.nan, 1.0, 0.01, "energy of the contact", sentence, trials)


def passing(setting, *, dimensions):
    """Whether a driven grain passes through a free one between two checks of the guard, at twice the limit's speed or more."""
    law = SPEED_LAWS[0]
    mass = mass_of(dimensions)
    limit = math.sqrt(2 * law.terms(LIMIT * R, mass=mass)["energy"] / mass)
    dt = duration(law, mass) / 50

    def passes_unseen(ratio):
        speed = ratio * limit
        first, second = driven_meeting(law, setting, dimensions, speed, dt, 5 * speed * dt)
        if said_by(lambda: advance(90)):  # without a search the guard checks at steps 0 and 100
            return False
        return state_of(second)[0][0] < state_of(first)[0][0]

    ratios = [2.0 * 1.5**k for k in range(11)]  # to 115; from 20 on the energy is that of an overlap of 2 R
    unseen = sum(map(passes_unseen, ratios))
    sentence = (
        "contacts of 50 steps between two checks of the guard, 100 steps apart, at 11 speeds of 2 to 115 times the overlap"
        " limit's: number of speeds at which a grain passes through another without an error (the guard also checks at searches)"
    )
    return judged(GUARD, float(unseen), 0.0, 0.5, "no grain may pass without an error", sentence)


# Ratios ---------------------------------------------------------------------------------------------------------------


def after_impact(m1, m2, e, v):
    """Return the velocities after an impact of m1, at v, on m2, at rest."""
    return (m1 - e * m2) * v / (m1 + m2), (1 + e) * m1 * v / (m1 + m2)


def unequal(setting, dimensions, ratios, of_radius):
    """Let a grain hit one of another radius or mass; return the worst error of the velocities, and trials."""
    e, trials = 0.5, dict(ratio=[], error=[])
    for ratio in ratios:
        radii, weights = ((R, R * ratio), (1, 1)) if of_radius else ((R, R), (1, ratio))
        masses = [weight * mass_of(dimensions, radius) for weight, radius in zip(weights, radii)]
        reduced = masses[0] * masses[1] / sum(masses)
        law = spring(stiffness_for(CONTACT, reduced), e)
        dt = CONTACT / (4 * STEPS)
        (_, v1, _), (_, v2, _) = met(
            meeting(1.0, weights=weights, radii=radii), law, setting, dimensions, dt, 8 * STEPS
        )
        u1, u2 = after_impact(*masses, e, 1.0)
        trials["ratio"].append(ratio)
        trials["error"].append(max(abs(v1[0] - u1), abs(v2[0] / u2 - 1)))
    return max(trials["error"]), trials


def radius_ratio(setting, *, dimensions):
    """Impacts on a grain of 50 times the radius and of a fiftieth of it."""
    worst, trials = unequal(setting, dimensions, (1 / 50, 1 / 7, 7.0, 50.0), True)
    sentence = "radius ratio 1:50 to 50:1, e = 0.5: largest error of a velocity after the impact"
    return ratios_judged(setting, worst, trials, sentence)


def mass_ratio(setting, *, dimensions):
    """Impacts on a grain of 1e6 times the mass and of a millionth of it."""
    worst, trials = unequal(setting, dimensions, (1e-6, 1e-3, 1e3, 1e6), False)
    sentence = "mass ratio 1e-6 to 1e6, e = 0.5: largest error of a velocity after the impact"
    return ratios_judged(setting, worst, trials, sentence)


def ratios_judged(setting, worst, trials, sentence):
    """Judge errors after impacts of unequal grains."""
    tolerance = 2 * math.pi / (4 * STEPS) + (SINGLE if setting.single else 0)  # as for the restitution
    return judged(
        RIGHT, worst, 0.0, tolerance, "conservation of momentum, and e of the relative velocity", sentence, trials
    )


RING = 60  # small grains


def ring(setting):
    """Sixty disks hit a disk of fifty times their radius at once: each contact is found, and each disk is reflected."""
    law = spring(stiffness_for(CONTACT, mass_of(2)), 1.0)
    big = 50 * R
    angles = 2 * math.pi * np.arange(RING) / RING
    small = [
        Grain(((big + R + 1e-5) * c, (big + R + 1e-5) * s), (-c, -s))
        for c, s in zip(np.cos(angles).tolist(), np.sin(angles).tolist())
    ]
    ids = place([Grain((0, 0), radius=big), *small], law, setting, CONTACT / STEPS, 2)
    advance(2 * STEPS)
    radial = [
        float(np.dot(state_of(ident)[1][:2], (c, s))) for ident, c, s in zip(ids[1:], np.cos(angles), np.sin(angles))
    ]
    worst = max(radial, key=lambda v: abs(v - 1))
    sentence = (
        f"{RING} disks hit one of fifty times their radius at once: their speed after over that before, furthest from 1"
    )
    tolerance = 1e-3 + (SINGLE if setting.single else 0)
    return judged(RIGHT, worst, 1.0, tolerance, "symmetry: the large disk stays at rest", sentence, dict(speed=radial))


# Stiffness ------------------------------------------------------------------------------------------------------------

STIFFNESSES = (1e-12, 1e-6, 1.0, 1e6, 1e12, 1e18, 1e24)


def stiffness(setting, *, dimensions):
    """Springs from 1e-12 to 1e24, with speeds chosen so that all impacts are the same in other units."""
    e, mass, trials = 0.5, mass_of(dimensions) / 2, dict(stiffness=[], error=[])
    for k_n in STIFFNESSES:
        law = spring(k_n, e)
        contact = duration(law, mass)
        speed, dt = 0.01 * math.pi / contact, contact / (4 * STEPS)  # overlap 0.01 d
        pair = meeting(speed, apart=0.1 * speed * contact)
        (_, v1, _), (_, v2, _) = met(pair, law, setting, dimensions, dt, 8 * STEPS)
        trials["stiffness"].append(k_n)
        trials["error"].append((v2[0] - v1[0]) / speed - e)
    worst = max(trials["error"], key=abs)
    sentence = (
        f"springs of {STIFFNESSES[0]:g} to {STIFFNESSES[-1]:g}, overlap 0.01 d: largest error of the restitution 0.5"
    )
    tolerance = 2 * math.pi / (4 * STEPS) + (SINGLE if setting.single else 0)
    return judged(RIGHT, worst, 0.0, tolerance, "units: e does not depend on k", sentence, trials)


def softest(setting, *, dimensions):
    """Grains softer than their speed allows are stopped by the overlap guard: k at which v sqrt(m_eff/k) is 0.1 R."""
    mass = mass_of(dimensions) / 2
    expected, guards = mass / (LIMIT * R) ** 2, set()

    def stopped(ratio):
        law = spring(ratio * expected)
        contact = duration(law, mass)
        ids = place(meeting(1.0, apart=1e-3), law, setting, contact / 4000, dimensions)
        said = said_by(lambda: advance(5000))
        guards.add("overlap by" in said if said else True)
        return bool(said) or not ids

    found = largest(stopped, 0.5, 2.0, 1e-3)
    sentence = "softest spring with which an impact at speed 1 passes the overlap guard, over m_eff v²/(0.1 R)²"
    return judged(GUARD, found if all(guards) else math.nan, 1.0, 0.01, "½mv² = ½k(0.1 R)²", sentence)
