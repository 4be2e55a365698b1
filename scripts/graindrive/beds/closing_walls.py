"""Makes dense channels: the walls of a wider channel close in on its grains, which then come to rest or jam."""

import os
import sys

import numpy as np

from ..lazily import engines
from ..runs import progress
from ..scenes import scene
from .channel_recipe import finished, insert, mean_area, radii_for
from ..base.errors import UsageError
from ..runs.progress_line import Calming
from ..scenes.yade_march import YadeMarch

INSERTION_FRACTION = 0.45  # random insertion jams near 0.547
DEEPEST_OVERLAP = 0.01  # [R] overlap above which the channel counts as jammed
CLOSING_DEPTH = 0.03  # [R] overlap for which the time step of the preparation is chosen
MOST_STOPS = 50  # number of stops after which grains that keep moving count as jammed


def close(recipe):
    """Close the walls of a wide channel until it has its height and its grains are at rest; return its arrays.

    Grains start with the velocity v_y = -v y/y_wall, so that the channel shrinks homogeneously. Walls that pushed grains at
    rest would make jammed layers at the walls and a dilute middle: 0.84 and 0.53 at an area fraction of 0.78.
    """
    area = np.sum(np.pi * radii_for(recipe) ** 2)
    start = recipe.height_for(area, INSERTION_FRACTION)
    x, y, r = insert(recipe, start)
    scene.start(recipe.width, start)
    walls = [
        scene.add_wall_clump(recipe.width, recipe.d, recipe.material.density, side * (start - recipe.d) / 2)
        for side in (-1, 1)
    ]
    beads = np.array(recipe.beads)
    scene.add_disks(
        beads[:, 0], beads[:, 1], np.full(len(beads), recipe.bead_radius), recipe.material.density, "xyzXYZ"
    )
    ids = scene.add_disks(x, y, r, recipe.material.density)
    steps, speed = bring_together(recipe, walls, start)
    scene.set_motion(ids, -speed * y / ((start - recipe.d) / 2))
    print(f"closing walls on {len(ids)} grains from {start:.3g} to {recipe.height:.3g}, {steps} steps", file=sys.stderr)
    march = YadeMarch(len(ids))
    progress.run_blocks(march, steps, 1000, lambda done: stop_if_jammed(recipe, area, walls), label="closing walls")
    halt(walls)
    energy = rest(recipe, ids)
    stop_if_jammed(recipe, area, walls)
    packed = scene.rows_of(ids)
    return finished(recipe, packed["x"], packed["y"], packed["r"], energy)


def bring_together(recipe, walls, start):
    """Put the loop and the drives of the walls into YADE; return the steps until the walls are in place, and their speed."""
    from yade import O

    way = (start - recipe.height) / 2
    O.dt = 0.45 * recipe.material.critical_time_step(recipe.d_min / 2, CLOSING_DEPTH)
    steps = int(np.ceil(way / (recipe.closing_speed * O.dt)))
    speed = way / (steps * O.dt)
    drives = [
        engines.SpinTranslateDrive(body=wall, velocity=(0, -side * speed, 0)) for wall, side in zip(walls, (-1, 1))
    ]
    scene.run_on(
        "grain", recipe.material, gravity=0.0, between=drives, largest_overlap=CLOSING_DEPTH, threads=free_cores()
    )
    return steps, speed


def free_cores(most=2):
    """Return the number of threads for which a core is free now: on a busy machine, threads that wait for each other are slow."""
    return int(np.clip(len(os.sched_getaffinity(0)) - os.getloadavg()[0] + 0.5, 1, most))


def halt(walls):
    """Remove the drives and stop the walls at their present positions."""
    from yade import O
    from yade.minieigenHP import Vector3

    O.engines = [engine for engine in O.engines if not isinstance(engine, engines.SpinTranslateDrive)]
    for wall in walls:
        O.bodies[wall].state.vel = Vector3.Zero


def stop_if_jammed(recipe, area, walls):
    """Raise UsageError with the area fraction reached so far if grains are compressed beyond jamming."""
    from yade import O

    contacts = scene.fast_loop().contacts()
    deepest = contacts["overlap"].max(initial=0.0)
    if deepest > DEEPEST_OVERLAP * recipe.d / 2:
        height = O.bodies[walls[1]].state.pos[1] - O.bodies[walls[0]].state.pos[1] + recipe.d
        raise UsageError(
            f"phi={recipe.phi:g} is beyond jamming: at {area / recipe.free_area(height):.4f} grains overlap by"
            f" {2 * deepest / recipe.d:.2g} R; lower phi"
        )


def rest(recipe, ids):
    """Stop the grains repeatedly until they stay at rest; return their mean kinetic energy over that of `rest_speed`.

    Below jamming only collisions slow the grains down, and they move between the walls for minutes at a few mm/s. So
    velocities are set to zero; the springs of grains that still overlap push them apart. This repeats until they stay at rest.
    """
    from yade import O

    limit = len(ids) * mean_area(recipe) * recipe.material.density * recipe.rest_speed**2 / 2
    block = int(np.ceil(recipe.d / recipe.rest_speed / O.dt / 100))
    loop = scene.fast_loop()
    aim = Calming(lambda: loop.kineticEnergy / limit, 1.0, f"times that at {recipe.rest_speed:g} m/s")

    def stop_unless_at_rest(done):
        if not aim.reached(done):
            scene.set_motion(ids, 0.0)
        return aim.reached(done)

    scene.set_motion(ids, 0.0)
    label = "coming to rest"
    progress.run_blocks(YadeMarch(len(ids)), MOST_STOPS * block, block, stop_unless_at_rest, label=label, aim=aim)
    if aim.energy < 1:
        return aim.energy
    raise RuntimeError(f"grains keep a kinetic energy of {aim.energy:.3g} times that at {recipe.rest_speed:g}")
