"""Far from the origin, for very many steps, without gravity, and driven at both ends of amplitude and period."""

import math

import numpy as np

from .. import study
from ..lazily import engines
from .few_grains import Grain, R, advance, mass_of, place, said_by, spring, state_of
from .impacts import STEPS, meeting, met, stiffness_for
from .outcome import BOUND, GUARD, RIGHT, judged

EPS = float(np.finfo(float).eps)
DISTANCES = (1e2, 1e4, 1e6, 1e8, 1e10)  # d
FAR = 1e6  # the distance that is judged
LASTING = 0.1  # duration of the contacts [d/v]: their overlap is 0.03 d
GAP = 0.01014  # initial gap [d]: not a whole number of steps, or rounding would decide in which step the dashpot begins


def far(setting, *, dimensions):
    """The same impact far from the origin and at it: positions have an error of eps X, and so has the overlap."""
    mass = mass_of(dimensions) / 2
    law, dt = spring(stiffness_for(LASTING, mass), 0.5), LASTING / STEPS

    def restitution(at):
        (_, v1, _), (_, v2, _) = met(meeting(1.0, at=at, apart=GAP), law, setting, dimensions, dt, 2 * STEPS)
        return v2[0] - v1[0]

    near = restitution(0.0)
    errors = [abs(restitution(at) - near) for at in DISTANCES]
    found = errors[DISTANCES.index(FAR)]
    depth = LASTING / math.pi
    tolerance = 10 * EPS * FAR / depth * math.sqrt(STEPS) + (1e-5 if setting.single else 0)
    said = ", ".join(f"{error:.1g} at {at:g} d" for at, error in zip(DISTANCES, errors))
    sentence = f"an impact 1e6 d from the origin: its restitution minus that at the origin; at other distances {said}"
    trials = dict(distance=DISTANCES, error=errors)
    source = "round-off of positions X: εX√n over the overlap, n steps"
    return judged(BOUND, found, 0.0, tolerance, source, sentence, trials)


def no_gravity(setting, *, dimensions):
    """A spinning grain in free flight without gravity: x_0 + v t, and constant spin."""
    steps, dt, velocity, spin = 20_000, 1e-3, (3.0, -2.0), 7.0
    ids = place([Grain((0, 0), velocity, spin=spin), Grain((1e3, 1e3))], spring(1.0), setting, dt, dimensions)
    advance(steps)
    x, v, w = state_of(ids[0])
    errors = [*(x[:2] / (np.array(velocity) * steps * dt) - 1), *(v[:2] / velocity - 1), w / spin - 1, x[2], v[2]]
    worst = float(np.abs(errors).max())
    sentence = f"free flight without gravity, {steps} steps: largest relative error of position, velocity or spin"
    return judged(RIGHT, worst, 0.0, steps * EPS, "round-off of n additions, nε", sentence)


# A bound pair ---------------------------------------------------------------------------------------------------------

SWING = 0.2  # of the overlap at rest
REST = 0.01  # overlap at rest [d]
STEPS_OF_A_SWING = 62.5  # approximately; half an oscillation takes 31 steps
PARTS = 50


def bound_pair(setting, *, dimensions):
    """A grain oscillates on a held one under its weight for many steps: its energy, and leapfrog's exact solution."""
    from yade import O

    mass, k_n = mass_of(dimensions), 1e4
    omega = math.sqrt(k_n / mass)
    dt = 2 * math.pi / omega / STEPS_OF_A_SWING
    weight = REST * k_n / mass  # g
    balance, amplitude = 2 * R - REST, SWING * REST
    turn = 2 * math.asin(omega * dt / 2)  # phase of leapfrog's solution per step
    # y_n = A cos(n turn) belongs to v_(-1/2) = (y_0 - y_(-1))/dt = A (1 - cos turn)/dt.
    start = (0, amplitude * (1 - math.cos(turn)) / dt)
    ids = place(
        [Grain((0, 0), held=True), Grain((0, balance + amplitude), start)],
        spring(k_n),
        setting,
        dt,
        dimensions,
        gravity=weight,
    )
    trials = dict(step=[], energy=[], position=[])
    part = max(1, setting.steps // PARTS)
    first = None
    while O.iter < setting.steps:
        advance(min(part, setting.steps - O.iter))
        x, v, _ = state_of(ids[1])
        y = x[1] - balance
        middle = v[1] * dt  # y_n - y_(n-1)
        # Leapfrog keeps y_n^2 + y_(n-1)^2 - 2 cos(turn) y_n y_(n-1) = A^2 sin^2(turn).
        before = y - middle
        energy = (y**2 + before**2 - 2 * math.cos(turn) * y * before) / (amplitude * math.sin(turn)) ** 2
        first = energy if first is None else first
        angle = math.fmod(turn * O.iter, 2 * math.pi)
        trials["step"].append(O.iter)
        trials["energy"].append(energy - 1)
        trials["position"].append((y - amplitude * math.cos(angle)) / amplitude)
    worst = max(trials["energy"], key=abs)
    apart = max(trials["position"], key=abs)
    n = setting.steps
    sentence = (
        f"a grain oscillates on another under its weight, {n:.3g} steps: largest relative change of the oscillation's energy;"
        f" its position differs from leapfrog's exact solution by {abs(apart):.1g} of the amplitude at most"
    )
    # y has an error of eps d, 1e-16/2e-3 of the amplitude. It adds up as sqrt(n); its systematic part is 1000 times smaller.
    rounding = EPS / amplitude if not setting.single else 6e-8 / REST / SWING
    tolerance = 10 * rounding * math.sqrt(n) + (n * rounding * 1e-3 if setting.single else 0)
    return judged(
        RIGHT,
        worst,
        0.0,
        tolerance,
        "leapfrog conserves y² + y₋² − 2 cos(ωdt) y y₋; round-off grows as √n",
        sentence,
        trials,
    )


# Driven ---------------------------------------------------------------------------------------------------------------

AMPLITUDES, PERIODS = (1e-6, 1.0, 1e6), (2.5, 40.0, 1e4, 1e8)  # d; steps


def oscillation(setting):
    """Amplitudes 1e-6 to 1e6 d, periods 2.5 to 1e8 steps of the wiggle's drive against x = A sin(2 pi t/T)."""
    dt, steps, trials = 1e-3, 5000, dict(amplitude=[], period=[], error=[])
    for amplitude in AMPLITUDES:
        for period in PERIODS:
            drive = engines.OscillationDrive(body=0, amplitude=amplitude, period=period * dt)
            place([Grain((0, 0)), Grain((0, 1e3))], spring(1.0), setting, dt, 2, before=[drive])
            advance(steps)
            angle = 2 * math.pi * math.fmod(steps / period, 1)
            trials["amplitude"].append(amplitude)
            trials["period"].append(period)
            trials["error"].append(state_of(0)[0][0] / amplitude - math.sin(angle))
    worst = max(trials["error"], key=abs)
    sentence = (
        "amplitudes 1e-6 to 1e6 d, periods 2.5 to 1e8 steps: position after 5000 steps minus A sin(2πt/T), over A"
    )
    tolerance = 8 * EPS * 2 * math.pi * steps / min(PERIODS)  # the angle's round-off is relative to its size
    return judged(RIGHT, worst, 0.0, tolerance, "x = A sin(2πt/T)", sentence, trials)


def wiggle_ends(_setting):
    """The wiggle study refuses periods that are too short for its time step or too long for its run."""
    wiggle = study.loaded(study.house()["wiggle"])
    usual = wiggle.usual("smoke").dict()
    asked = (
        (dict(period=1e-4), "must be at least 40 time steps"),
        (dict(period=1e6), "must be at most 40 times time"),
    )
    said = [said_by(lambda keys=keys: wiggle.check(wiggle.parameters(**{**usual, **keys}))) for keys, _ in asked]
    found = sum(words in told for told, (_, words) in zip(said, asked))
    sentence = "wiggle, T = 1e-4 and T = 1e6: number of refusals that name the period and its bound"
    return judged(GUARD, found, len(asked), 0.5, "at least 40 samples in a period, at most 40 run lengths", sentence)
