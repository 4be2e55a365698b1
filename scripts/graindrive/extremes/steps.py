"""The largest stable time step: of a pair under every law, for normal and tangential motion, and of crystals."""

import math

import numpy as np

from ..lazily import engines
from ..scenes import scene
from .few_grains import CLOSE, Grain, Law, R, advance, duration, lattice, mass_of, place, said_by, spring, state_of
from .outcome import BOUND, GUARD, RIGHT, judged, largest

GRIP = 1e9  # a friction coefficient that no contact here reaches
SHALLOW, DEEP = 1e-3, 0.1  # overlaps [R]: of the observed pair, and in GrainLoop's check
FAINT = 1e-8  # overlap of a sliding pair [R]: with more, the pair would turn during the observation
BLOCKS, BLOCK, ODD = 8, 500, 7  # number of blocks, steps of a block; then ODD checks, ODD steps apart
START, GROWN = 1e-7, 1e3  # first deviation over the overlap, and its growth that counts as unstable
RESOLUTION = 5e-4  # of the bisection
# Beyond the limit a strongly damped motion grows by dt/dt_crit - 1 a step or more: 4000 steps resolve 2 parts in 1000.
TOLERANCE = 5e-3
LAWS = {
    "spring": Law("springDashpot", dict(normalStiffness=1e6, tangentialStiffness=1e6, restitution=0.5)),
    "hertz_history": Law(
        "hertzHistory",
        dict(normalStiffness=2e6, tangentialStiffness=2.46e6, normalDamping=2500.0, tangentialDamping=2500.0),
    ),
    "hertz_restitution": Law("hertzRestitution", dict(young=5e6, poisson=0.45, restitution=0.6)),
    "cundall_strack": Law("cundallStrack", dict(young=1e6, poisson=1.0)),
    "hertz_mindlin": Law(
        "hertzMindlin", dict(young=5e6, poisson=0.3, normalDampingRatio=0.2, tangentialDampingRatio=0.2)
    ),
}
SOURCE = "λ = −1 of leapfrog: dt = (2/ω)(√(1 + ζ²) − ζ), engines/laws/critical_step.hpp"


def theory(law, dimensions, overlap, sliding):
    """Return the critical step of a pair at an overlap [R]: against the normal with m/2, sliding with m/6 (disks) or m/7."""
    mass = mass_of(dimensions) / 2
    at = law.terms(overlap * R, mass=mass)
    if sliding:
        yields = mass / 3 if dimensions == 2 else mass * 2 / 7
        return engines.critical_step(at["tangential_stiffness"], at["tangential_dashpot"], yields)
    return engines.critical_step(at["stiffness"], at["dashpot"], mass)


def pressed_pair(law, setting, dimensions, dt, overlap, *, sliding):
    """Put two grains that a constant force presses together into YADE, a little out of equilibrium; return their ids."""
    from yade import O

    depth = overlap * R
    force = law.terms(depth, mass=mass_of(dimensions) / 2)["elastic"]
    nudge = START * depth
    speed = nudge / theory(law, dimensions, overlap, sliding)
    apart = 2 * R - depth - (0 if sliding else nudge)
    velocity = (0, speed / 2) if sliding else (0, 0)
    pair = [Grain((-apart / 2, 0), velocity), Grain((apart / 2, 0), (0, -velocity[1]))]
    law = Law(law.LAW, law.numbers, GRIP if sliding else 0.0)
    ids = place(pair, law, setting, dt, dimensions, largestOverlap=max(1.01 * overlap, DEEP))
    for ident, push in zip(ids, (force, -force)):
        O.forces.setPermF(ident, (push, 0, 0))
    return ids, (speed if sliding else nudge), apart + (0 if sliding else nudge)


def deviation(ids, balance, sliding):
    """Return the deviation of the pair from equilibrium: its distance, or the velocity of one surface along the other."""
    (x1, v1, w1), (x2, v2, w2) = map(state_of, ids)
    return abs(v1[1] - v2[1] + R * (w1 + w2)) if sliding else abs(x2[0] - x1[0] - balance)


def stays(law, setting, dimensions, dt, overlap, *, sliding):
    """True if the deviation of a pressed pair does not grow in some thousand steps of dt."""
    ids, start, balance = pressed_pair(law, setting, dimensions, dt, overlap, sliding=sliding)
    for _ in range(BLOCKS):
        advance(BLOCK)
        if not deviation(ids, balance, sliding) < GROWN * start:
            return False
    for _ in range(ODD):  # a mode that changes sign every step may be zero at the time of a check
        advance(ODD)
        if not deviation(ids, balance, sliding) < GROWN * start:
            return False
    return True


def guarded_step(law, setting, dimensions, sliding):
    """Return the largest step that GrainLoop accepts for two separate grains, over theory at 0.1 R, and its refusals."""
    law, words = Law(law.LAW, law.numbers, GRIP if sliding else 0.0), set()
    expected = theory(law, dimensions, DEEP, sliding)

    def taken(ratio):
        def build():
            place([Grain((0, 0)), Grain((2, 0))], law, setting, ratio * expected, dimensions)
            scene.fast_loop()()  # in this thread

        said = said_by(build)
        words.add(said.split("critical one")[0] if said else "")
        return not said

    return largest(taken, 0.5, 2.0, RESOLUTION), words


def stable_step(setting, *, law, dimensions):
    """The largest step of a pair over theory: on YADE's loop from the motion, on GrainLoop from its check."""
    law, trials = LAWS[law], dict(direction=[], overlap=[], ratio=[], share=[])
    stable = True
    for sliding in (False, True):
        overlap = (FAINT if sliding else SHALLOW) if setting.loop == "yade" else DEEP
        expected = theory(law, dimensions, overlap, sliding)
        if setting.loop == "yade":
            ratio = largest(
                lambda r: stays(law, setting, dimensions, r * expected, overlap, sliding=sliding), 0.5, 2, RESOLUTION
            )
        else:
            ratio, words = guarded_step(law, setting, dimensions, sliding)
            stable &= all(word.endswith("time step must not exceed the ") for word in words if word)
            stable &= sliding or stays(law, setting, dimensions, 0.995 * expected, 0.99 * DEEP, sliding=False)
        contact = duration(law, mass_of(dimensions) / 2, overlap * R)
        row = ("sliding" if sliding else "normal", overlap, ratio, ratio * expected / contact)
        for column, value in zip(trials.values(), row):
            column.append(value)
    worst = max(trials["ratio"], key=lambda r: abs(r - 1) if math.isfinite(r) else math.inf)
    shares = " and ".join(f"{share:.3f}" for share in trials["share"])
    how = (
        "beyond it the motion grows"
        if setting.loop == "yade"
        else "GrainLoop refuses a larger one, and just below it a pair stays at rest"
    )
    sentence = f"largest step over theory, {how}; {shares} of π√(m/k) for normal and sliding motion"
    word = RIGHT if setting.loop == "yade" else GUARD
    return judged(word, worst if stable else math.nan, 1.0, TOLERANCE, SOURCE, sentence, trials)


ALLOWED = 0.3  # an overlap that a user may allow [R]


def deep_step(setting, *, dimensions):
    """The largest step that GrainLoop accepts for an allowed overlap of 0.3 R, over the critical one at that overlap."""
    law = LAWS["hertz_restitution"]
    expected = theory(law, dimensions, ALLOWED, False)

    def taken(ratio):
        def build():
            place([Grain((0, 0)), Grain((2, 0))], law, setting, ratio * expected, dimensions, largestOverlap=ALLOWED)
            scene.fast_loop()()

        return not said_by(build)

    found = largest(taken, 0.5, 2.0, RESOLUTION)
    stable = stays(law, setting, dimensions, 0.99 * found * expected, ALLOWED, sliding=False)
    sentence = (
        f"Hertz's law, largestOverlap = 0.3: largest step that GrainLoop accepts over the critical one at that overlap; the pair"
        f" {'stays at rest' if stable else 'becomes unstable'}"
    )
    return judged(GUARD, found if stable else math.nan, 1.0, TOLERANCE, SOURCE, sentence)


# Crystal --------------------------------------------------------------------------------------------------------------

SQUEEZED = 1e-3  # overlap of its grains [d]
WATCHED = 3000  # steps
CONTACTS = {2: 6, 3: 12}  # of a grain
EDGE = {2: 6, 3: 8}  # omega^2 over k/m of its fastest mode, at the edge of the Brillouin zone


def crystal(setting, dimensions, dt, law):
    """Put a slightly compressed close-packed crystal into YADE, at rest except for noise; return the ids and the noise."""
    at, box = lattice(dimensions, CLOSE[dimensions] / (1 - SQUEEZED) ** dimensions)
    noise = 1e-3 if setting.single else 1e-9  # larger than the effect of the forces' round-off
    speeds = np.zeros((len(at), 3))
    speeds[:, :dimensions] = np.random.default_rng(1).normal(0, noise, (len(at), dimensions))
    grains = [Grain(tuple(x), tuple(v)) for x, v in zip(at, speeds)]
    return place(grains, law, setting, dt, dimensions, box=box), noise


def fastest(ids):
    """Return the largest speed of the bodies."""
    return max(float(np.linalg.norm(state_of(ident)[1])) for ident in ids)


def crystal_step(setting, dimensions, law, pair):
    """Return the largest step at which a crystal stays at rest, over the step `pair`."""

    def stable(ratio):
        ids, noise = crystal(setting, dimensions, ratio * pair, law)
        said = said_by(lambda: advance(WATCHED))
        return not said and fastest(ids) < 100 * noise

    return largest(stable, 0.3, 0.95, 2e-3)


def stable_crystal(setting, *, dimensions):
    """The largest step of a crystal without friction over that of a pair, from its fastest mode; and what larger ones do."""
    law = spring(1e6)
    pair = theory(law, dimensions, SHALLOW, False)
    found, expected = crystal_step(setting, dimensions, law, pair), math.sqrt(2 / EDGE[dimensions])

    def run(ratio):
        advance_ids.extend(crystal(setting, dimensions, ratio * pair, spring(1e6, 0.9))[0])
        advance(30_000)

    advance_ids = []
    said = said_by(lambda: run(1.04 * expected))
    told = (
        "the overlap guard stops the run"
        if "overlap by" in said
        else said or f"speeds of {fastest(advance_ids):.2g} d/s"
    )
    sentence = (
        f"crystal, {CONTACTS[dimensions]} contacts a grain, no friction: largest step over a pair's critical one (GrainLoop"
        f" accepts the latter); 4 % beyond it, with e = 0.9: {told}"
    )
    source = f"ω² = {EDGE[dimensions]} k/m at the edge of the Brillouin zone, 2 k/m for a pair"
    return judged(BOUND, found, expected, 0.01, source, sentence)


def frictional_frequency(k_n, k_t, mass):
    """Return the largest frequency of a triangular crystal with sticking contacts, among the waves that fit the periodic cell."""
    fastest_of = 0.0
    sides = [np.array([math.cos(a), math.sin(a)]) for a in (0, math.pi / 3, 2 * math.pi / 3)]
    weights = 1 / np.sqrt([mass, mass, mass * R**2 / 2])
    for p in range(8):
        for q in range(8):
            wave = 2 * math.pi * np.array([p / 8, q / (8 * math.sqrt(3) / 2)])
            matrix = np.zeros((3, 3), complex)
            for n in sides:
                phase, t = np.exp(1j * wave @ n), np.array([-n[1], n[0]])
                normal = np.array([*(n * (phase - 1)), 0])
                slide = np.array([*(t * (phase - 1)), -R * (phase + 1)])
                matrix += k_n * np.outer(normal.conj(), normal) + k_t * np.outer(slide.conj(), slide)
            fastest_of = max(fastest_of, np.linalg.eigvalsh(weights[:, None] * matrix * weights).max())
    return math.sqrt(fastest_of)


def stable_crystal_that_sticks(setting):
    """The same for disks with sticking contacts that may rotate, compared with the fastest wave that fits the cell."""
    law = spring(1e6, 1.0, GRIP, 1.0)
    pair, safe = theory(law, 2, SHALLOW, True), 1 / math.sqrt(CONTACTS[2])
    found = crystal_step(setting, 2, law, pair)
    expected = 2 / frictional_frequency(1e6, 1e6, mass_of(2)) / pair
    sentence = (
        f"crystal with six sticking contacts a grain: largest stable step over the pair's critical step; for any packing with"
        f" six contacts a grain this ratio is at least 1/√6 = {safe:.3f}"
    )
    return judged(BOUND, found, expected, 0.01, "largest eigenvalue of the crystal's waves, with rotation", sentence)
