"""Pictures of the scene for a run folder: grains, the driven body and the contacts between them at this moment.

Contacts belong to the present positions, and their forces are those that the next step will compute, under either loop; taking a
picture does not change the scene. All positions lie in one periodic image, along x for disks and along each periodic axis for
spheres: grains lie in [0, period); the body is not split, and its centre lies there; a contact point lies next to the contact's
first side, or next to the grain if the other side is a solid. A driven body that is a solid (`surfaces`) has no disks: only its
position is stored.
"""

from typing import NamedTuple

import numpy as np

from ..lazily import engines
from ..loops import grain_loop
from ..scenes import scene
from ..postproc.reader import INTRUDER

NOT_SHOWN = -1  # row of a disk that no array of a picture contains


class Picture(NamedTuple):
    """The scene at one moment, in the form that `RunFolder.frame` stores; `postproc.quantities` explains the columns.

    `grains` holds grains and base, `contacts` all contacts between them and the body, `intruder` the driven body's disks with
    its `centre` and, for a single disk, its `angle`, for a body among spheres its `turn`; all are dicts of arrays. `period`
    is the period of the box in x, 0 without one; for spheres it is an array (3,).
    """

    grains: dict
    contacts: dict
    intruder: dict
    period: float | np.ndarray


def taken(grains, base, intruder):
    """Return the present `Picture` of the disks with the ids `grains` and `base` and of the body `intruder`."""
    from yade import O

    shown = np.concatenate([np.asarray(grains, int), np.asarray(base, int)])
    beads, solid = beads_of(intruder), is_solid(intruder)
    ids, n = np.concatenate([shown, beads]), len(shown)
    rows, period = scene.rows_of(ids), period_of_box()
    centre = np.array(O.bodies[intruder].state.pos)[: 3 if "z" in rows else 2]
    for axis, (name, length) in enumerate(zip("xyz", np.atleast_1d(period))):
        rows[name] = in_one_image(rows[name], n, centre, axis, length)
    disks = [
        {"id": ids[part], **{name: column[part] for name, column in rows.items()}}
        for part in (slice(n), slice(n, None))
    ]
    disks[0]["role"] = np.r_[np.zeros(len(grains), int), np.ones(len(base), int)]
    found = contacts(ids, rows, n, solid=intruder if solid else None)
    return Picture(disks[0], found, {**disks[1], **pose(intruder, centre)}, period)


def is_solid(intruder):
    """True for a body whose shape is a `surfaces` solid: it has no beads."""
    from yade import O

    return type(O.bodies[intruder].shape).__name__ == "Solid"


def beads_of(intruder):
    """Return the ids of a body's disks or spheres, (m,); none for a solid."""
    from yade import O

    if is_solid(intruder):
        return np.zeros(0, int)
    return np.array(scene.members(intruder) if O.bodies[intruder].isClump else [intruder])


def period_of_box():
    """Return the period in x as a float, 0 without one; for a scene of spheres the periods in x, y, z, (3,)."""
    from yade import O

    in_space, loop = scene.dimensions() == 3, scene.fast_loop()
    if in_space and loop:
        return np.array(loop.periods)
    size = np.array(O.cell.size) if O.periodic else np.zeros(3)
    return size if in_space else float(size[0])


def in_one_image(x, n, centre, axis, period):
    """Move the first `n` of x, and centre[axis] in place, into [0, period), the other x next to the centre; return x."""
    if period == 0:
        return x
    beside = x[n:] - centre[axis]
    centre[axis] = wrapped(centre[axis : axis + 1], period)[0]
    return np.r_[wrapped(x[:n], period), centre[axis] + beside - period * np.round(beside / period)]


def wrapped(x, period):
    """Return x moved by whole periods into [0, period)."""
    x = np.mod(x, period)
    return np.where(x < period, x, 0.0)  # np.mod(-1e-20, period) is the period


def pose(intruder, centre):
    """Return the centre of a body and, for a single disk, the angle by which it has turned [rad], in (-pi, pi].

    The positions of a clump's beads show how it has turned. For a body among spheres the quaternion `turn`, (w, x, y, z), does.
    """
    from yade import O

    body = O.bodies[intruder]
    if len(centre) == 3:
        turn = body.state.ori
        return {"centre": centre, "turn": np.array([turn[3], turn[0], turn[1], turn[2]])}
    if body.isClump:
        return {"centre": centre}
    axis, angle = body.state.ori.toAxisAngle()
    return {"centre": centre, "angle": np.arctan2(*(f(angle * axis[2]) for f in (np.sin, np.cos)))}


def contacts(ids, rows, n, solid=None):
    """Return the contacts between disks `ids`, of which the first `n` are shown as grains and base, and with flat walls.

    `rows` are the disks' columns, `solid` is the id of a driven body without disks. Each contact appears once, with its
    smaller id first; contacts are sorted by ids.
    """
    from yade import O

    row_of_id = np.full(len(O.bodies) + 1, NOT_SHOWN)
    row_of_id[ids] = np.arange(len(ids))
    if solid is not None:
        row_of_id[solid] = len(ids)  # after all disks
    table = ordered(present_contacts())
    i, j = row_of_id[table["i"]], np.where(table["j"] >= 0, row_of_id[table["j"]], table["j"])
    kept = (i != NOT_SHOWN) & (j != NOT_SHOWN)
    i, j, table = i[kept], j[kept], {name: column[kept] for name, column in table.items()}
    of_solid = i == len(ids)
    begin, side = np.where(of_solid, j, i), np.where(
        of_solid, -1, 1
    )  # the contact point is computed from a disk, because a solid has no radius
    normal, reach = table["normal"], side * (rows["r"][begin] - table["overlap"] / 2)
    axes = "xyz" if "z" in rows else "xy"
    return dict(
        i=named(i, n),
        j=named(j, n),
        id_i=table["i"],
        id_j=table["j"],
        fn=np.sum((table["normal_force"] * normal)[:, : len(axes)], axis=1),
        **(tangential_in_space(table) if len(axes) == 3 else tangential_in_plane(table)),
        **{f"p{axis}": rows[axis][begin] + reach * normal[:, k] for k, axis in enumerate(axes)},
    )


def tangential_in_plane(table):
    """Return tangential force on i and slip along z x n."""
    force, normal = table["tangential_force"], table["normal"]
    return {"ft": -np.sum(force[:, :2] * np.c_[-normal[:, 1], normal[:, 0]], axis=1), "slip": table["slip"]}


def tangential_in_space(table):
    """Return the components of tangential force on i and slip of i."""
    of = {"ft": -table["tangential_force"], "slip": table["slip"]}
    return {f"{name}_{axis}": vectors[:, k] for name, vectors in of.items() for k, axis in enumerate("xyz")}


def named(row, n):
    """Return the names of disks in contacts: the row if it is below `n`, else INTRUDER; names of walls do not change."""
    return np.where(row >= n, INTRUDER, row)


def present_contacts():
    """Return the table of all contacts at the present positions, from the loop of the scene."""
    from yade import O

    loop = scene.fast_loop()
    if loop:
        return loop.presentContacts()
    interactions = grain_loop.find("InteractionLoop")
    law, contact_maker = interactions.lawDispatcher.functors[0], interactions.physDispatcher.functors[0]
    table = engines.present_contacts(O._sceneObj, law, contact_maker)
    return {**table, "slip": table["slip_vector"]} if scene.dimensions() == 3 else table


def ordered(table):
    """Return a table of contacts sorted by ids, with the smaller id as i; walls are always second.

    Exchanging the two sides of a contact reverses the normal and the forces, which act on j. Slip is that of i against j: for
    disks it is a number along z x n and keeps its sign, for spheres it is a vector and is reversed.
    """
    turned = (table["j"] >= 0) & (table["i"] > table["j"])
    sides = dict(i=np.where(turned, table["j"], table["i"]), j=np.where(turned, table["i"], table["j"]))
    sign = np.where(turned, -1.0, 1.0)[:, None]
    turning = ["normal", "normal_force", "tangential_force"] + ["slip"] * (table["slip"].ndim == 2)
    vectors = {name: sign * table[name] for name in turning}
    scalars = {name: table[name] for name in ("overlap", "slip", "slipping") if name not in vectors}
    order = np.lexsort((sides["j"], sides["i"]))
    return {name: column[order] for name, column in {**sides, **vectors, **scalars}.items()}
