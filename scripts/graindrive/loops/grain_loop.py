"""Moves a scene built for YADE's loop over to GrainLoop, and back."""

import uuid
from dataclasses import dataclass

from . import contact_springs
from . import dimensions as dims
from ..lazily import engines
from . import loop_laws, stand_ins, take_over, take_over_spheres
from ..base.errors import UsageError

TAG = "graindrive.exchange"  # key in O.tags, which O.save keeps: it names the exchange that made the scene's GrainLoop
KEPT = 16  # largest number of stored exchanges; the oldest are dropped first, since reset scenes leave theirs behind


@dataclass(frozen=True)
class Exchange:
    """One exchange: YADE's loop, the energy tracker that identifies its scene, and the GrainLoop's name."""

    loop: take_over.Loop
    scene: object
    made: str


exchanged = {}  # tag of a scene -> Exchange


def use_grain_loop(periods=None, dimensions=None, **settings):
    """Replace YADE's four engines in O.engines by one GrainLoop with the same law, materials, damping and gravity; return it.

    Other engines keep their order: they stand before it, or after it if they stood after NewtonIntegrator.
    `dimensions` is 2 for disks in a plane z = const and 3 for spheres in space. By default the scene says: 3 if some
    sphere or clump may leave the plane (its blockedDOFs lack one of z, X, Y) and something takes bodies out of it,
    which means centres at different z, a motion along z, a rotation about x or y, or gravity along z; else 2. Give 3 if a
    drive or a force will move a body out of the plane in which all bodies lie.
    `periods` are the periods of the box, (x, y) for disks, (x, y, z) for spheres, 0 along axes that are not periodic; by
    default those of O.cell. If a cell is long only to avoid images, 0 is faster. Other `settings` (precision, threads,
    syncEvery, ...) go to GrainLoop. Present contacts keep their tangential springs. Labels of YADE's four engines and of
    their functors then refuse to be read or set (`stand_ins`).

    Contacts of a step use the velocities of driven and frozen bodies from the previous step, and those of free disks as changed
    by engines before GrainLoop (TranslationEngine, a PyRunner). On YADE's loop this depends on whether the engine stands before
    or after InteractionLoop; the difference is a delay of one step. If a frozen disk is set in motion, GrainLoop computes the
    reduced mass of its contacts again, while YADE keeps the old one.

    Raises UsageError for features that GrainLoop lacks (`take_over.RULES`, for spheres also `take_over_spheres.RULES`,
    `loop_laws`), ValueError for bodies and cells that it cannot move, RuntimeError for engines that it does not know;
    O.engines is then unchanged.
    """
    from yade import O

    loop = take_over.yades_loop()
    take_over.require(loop)
    dimensions = dims.of_scene(loop.newton) if dimensions is None else dimensions
    if dimensions == 3:
        take_over.require(loop, take_over_spheres.RULES)
    of_scene = {
        **loop_laws.law_settings(loop.contacts),
        **loop_laws.damping_settings(loop.newton),
        **contact_springs.springs_of(loop.contacts, dimensions),
    }
    periods = dims.periods_of_scene(periods, dimensions)
    given = dict(dimensions=dimensions, gravity=loop.newton.gravity, periods=periods)
    made = engines.GrainLoop(**{**given, **of_scene, **settings})
    before = O.engines
    O.engines = loop.with_grain_loop(made)
    try:
        made.requireScene()
    except Exception:
        O.engines = before
        raise
    O.interactions.clear()  # GrainLoop does not follow them; its own contacts are in contacts()
    O.forces.reset(resetAll=False)  # those of YADE's last step, which ForceResetter would erase in the next one
    note_exchange(loop, made)
    stand_ins.put(loop)
    take_over.warn_of_runners()
    return made


def note_exchange(loop, made):
    """Remember which engines `made` replaced, for this scene and copies of it that O.load makes."""
    from yade import O

    O.tags[TAG] = uuid.uuid4().hex
    exchanged[O.tags[TAG]] = Exchange(loop, O.energy, str(made))
    while len(exchanged) > KEPT:
        del exchanged[next(iter(exchanged))]


def exchange_of(made):
    """Return the tag of the exchange that the scene's GrainLoop comes from; UsageError if there is none in this session.

    A scene that was loaded holds another GrainLoop than the one that was saved, and another energy tracker.
    """
    from yade import O

    tag = O.tags[TAG] if TAG in O.tags.keys() else None
    exchange = exchanged.get(tag)
    if exchange is None or (exchange.scene == O.energy and exchange.made != str(made)):
        raise UsageError(
            "the GrainLoop in O.engines was not made for this scene by use_grain_loop in this session;"
            " put YADE's engines into O.engines yourself"
        )
    return tag


def use_yade_loop():
    """Put YADE's own engines back in place of the GrainLoop that `use_grain_loop` made; update all bodies.

    Contacts are searched again and keep their present tangential springs; changes of gravity, friction and constants of the
    law are transferred.
    """
    from yade import O

    loop = find("GrainLoop")
    tag = exchange_of(loop)
    if loop.walls or loop.loads:
        raise UsageError(
            "YADE's loop does not have GrainLoop's flat walls and loads; remove them (removeWall, setLoad) first"
        )
    loop.sync()
    before = exchanged[tag].loop
    hand_settings_back(loop, before)
    del exchanged[tag]
    if O.periodic:
        before.newton.prevVelGrad = (
            O.cell.velGrad
        )  # bodies have followed it already, so NewtonIntegrator must not apply the change again
    O.engines = before.put_back(O.engines)
    make_contacts_anew(before, loop)


def hand_settings_back(loop, before):
    """Give YADE's engines gravity, damping and the law's constants as GrainLoop has them now.

    UsageError if they belong to materials and YADE's own laws, which the user must change.
    """
    law2, ip2 = before.contacts.lawDispatcher.functors[0], before.contacts.physDispatcher.functors[0]
    if type(law2).__name__ not in loop_laws.our_laws():
        for key, value in loop_laws.law_settings(before.contacts).items():
            if getattr(loop, key) != value:
                raise UsageError(
                    f"GrainLoop.{key} is {getattr(loop, key)}, but {value} in the scene's materials and functors;"
                    " make them equal before going back"
                )
    before.newton.gravity, before.newton.damping, before.newton.dampGravity = (
        loop.gravity,
        loop.damping,
        loop.dampGravity,
    )
    if getattr(ip2, "friction", -1) >= 0:
        ip2.friction = loop.friction
    for key in loop_laws.our_attributes():
        if hasattr(law2, key):
            setattr(law2, key, getattr(loop, key))


def make_contacts_anew(loop, of):
    """Make YADE find all contacts at the present positions, in a step with dt = 0, and give them a GrainLoop's springs."""
    from yade import O

    engines_of_scene, dt, clock = O.engines, O.dt, (O.iter, O.time)
    O.interactions.clear()
    loop.collider()  # called directly, because within a step it may wait until bodies have moved
    O.engines, O.dt = list(loop), 0
    O.run(1, True)  # in the loop's own thread: forces of engines that are called by hand are not cleared
    O.engines, O.dt = engines_of_scene, dt
    engines.set_clock(O._sceneObj, *clock)
    contact_springs.give_springs(loop.contacts, of)


def find(name):
    """Return the engine of O.engines of that class; UsageError if there is none."""
    from yade import O

    for engine in O.engines:
        if type(engine).__name__ == name:
            return engine
    raise UsageError(f"O.engines must hold a {name}; it holds {', '.join(type(e).__name__ for e in O.engines)}")
