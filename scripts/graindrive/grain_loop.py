"""Moves a scene built for YADE's loop over to GrainLoop, and back."""

from . import engines, loop_laws
from .errors import UsageError

REPLACED = ("ForceResetter", "InsertionSortCollider", "InteractionLoop", "NewtonIntegrator")


def use_grain_loop(periods=None, **settings):
    """Replace YADE's four engines in O.engines by one GrainLoop with the same law, materials, damping and gravity; return it.

    Measures and drives stay, in their order, before it. `periods` are the lengths (x, y) after which the box repeats, 0
    where it does not; by default a periodic scene repeats in x only, as YADE's long cells are meant. Other `settings`
    (precision, threads, syncEvery, ...) go to GrainLoop. Present contacts keep their tangential springs.
    """
    from yade import O

    contacts, newton = find("InteractionLoop"), find("NewtonIntegrator")
    if periods is None:
        periods = (O.cell.size[0], 0) if O.periodic else (0, 0)
    of_scene = {
        **loop_laws.law_settings(contacts),
        **loop_laws.damping_settings(newton),
        "springs": loop_laws.springs_of(contacts),
    }
    made = engines.GrainLoop(gravity=newton.gravity, periods=(*periods, 0), **{**of_scene, **settings})
    made_before = [e for e in O.engines if type(e).__name__ in REPLACED]
    O.engines = [e for e in O.engines if type(e).__name__ not in REPLACED] + [made]
    exchanged[made.label or "GrainLoop"] = made_before
    O.interactions.clear()  # GrainLoop does not follow them: their springs would be stale when YADE's loop comes back
    return made


exchanged = {}  # label of a GrainLoop -> the engines that it replaced


def use_yade_loop():
    """Put YADE's own engines back in place of the GrainLoop that `use_grain_loop` made; all bodies are brought up to date."""
    from yade import O

    loop = find("GrainLoop")
    if (loop.label or "GrainLoop") not in exchanged:
        raise UsageError(
            "the GrainLoop in O.engines was not made by use_grain_loop in this session, or was given another label;"
            " put YADE's engines into O.engines yourself"
        )
    loop.sync()
    before = {type(e).__name__: e for e in exchanged.pop(loop.label or "GrainLoop")}
    between = [e for e in O.engines if type(e).__name__ != "GrainLoop"]
    *first, last = [before[name] for name in REPLACED]
    O.engines = [*first, *between, last]


def find(name):
    """Return the engine of O.engines of that class; UsageError if there is none."""
    from yade import O

    for engine in O.engines:
        if type(engine).__name__ == name:
            return engine
    raise UsageError(f"O.engines must hold a {name}; it holds {', '.join(type(e).__name__ for e in O.engines)}")
