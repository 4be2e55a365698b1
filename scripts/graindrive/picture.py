"""Pictures of the scene for a run folder: grains, the driven body and the contacts between them at this moment.

Contacts are those at the present positions, with the forces that the next step will find, under either loop; looking changes
nothing. All x lie in one periodic image: grains in [0, period), the body whole with its centre there, a contact point next to
its first side.
"""

from typing import NamedTuple

import numpy as np

from . import engines, grain_loop, scene
from .postproc.reader import INTRUDER

NOT_SHOWN = -1  # row of a disk that is in none of a picture's arrays


class Picture(NamedTuple):
    """The scene at one moment, as `RunFolder.frame` stores it; the columns are those of `postproc.quantities`.

    `grains` holds grains and base, `contacts` those between anything shown, `intruder` the driven body's disks with its
    `centre` and, for a single disk, its `angle`; dicts of arrays. `period` is the box's in x, 0 without.
    """

    grains: dict
    contacts: dict
    intruder: dict
    period: float


def taken(grains, base, intruder):
    """Return the `Picture` of this moment, of the disks with the ids `grains` and `base` and the body `intruder`."""
    from yade import O

    shown = np.concatenate([np.asarray(grains, int), np.asarray(base, int)])
    beads = np.array(scene.members(intruder) if O.bodies[intruder].isClump else [intruder])
    ids, n = np.concatenate([shown, beads]), len(shown)
    period = float(O.cell.size[0]) if O.periodic else 0.0
    rows, centre = scene.rows_of(ids), np.array(O.bodies[intruder].state.pos)[:2]
    rows["x"] = in_one_image(rows["x"], n, centre, period)
    disks = [
        {"id": ids[part], **{name: column[part] for name, column in rows.items()}}
        for part in (slice(n), slice(n, None))
    ]
    disks[0]["role"] = np.r_[np.zeros(len(grains), int), np.ones(len(base), int)]
    return Picture(disks[0], contacts(ids, rows, n), {**disks[1], **pose(intruder, centre)}, period)


def in_one_image(x, n, centre, period):
    """Return x with the first `n` and `centre`, an array (2,), moved into [0, period), the rest beside the centre."""
    if period == 0:
        return x
    beside = x[n:] - centre[0]
    centre[0] = wrapped(centre[:1], period)[0]
    return np.r_[wrapped(x[:n], period), centre[0] + beside - period * np.round(beside / period)]


def wrapped(x, period):
    """Return x moved by whole periods into [0, period)."""
    x = np.mod(x, period)
    return np.where(x < period, x, 0.0)  # np.mod(-1e-20, period) is the period


def pose(intruder, centre):
    """Return the centre of a body and, of a single disk, the angle by which it has turned [rad], in (-pi, pi].

    A clump's places of beads say how it has turned.
    """
    from yade import O

    body = O.bodies[intruder]
    if body.isClump:
        return {"centre": centre}
    axis, angle = body.state.ori.toAxisAngle()
    return {"centre": centre, "angle": np.arctan2(*(f(angle * axis[2]) for f in (np.sin, np.cos)))}


def contacts(ids, rows, n):
    """Return the contacts between disks `ids`, of which the first `n` are shown as grains and base, and with flat walls.

    `rows` are the disks' columns. Each contact stands once, from its smaller id; they come by rising ids.
    """
    from yade import O

    row_of_id = np.full(len(O.bodies) + 1, NOT_SHOWN)
    row_of_id[ids] = np.arange(len(ids))
    table = ordered(present_contacts())
    i, j = row_of_id[table["i"]], np.where(table["j"] >= 0, row_of_id[table["j"]], table["j"])
    kept = (i != NOT_SHOWN) & (j != NOT_SHOWN)
    i, j, table = i[kept], j[kept], {name: column[kept] for name, column in table.items()}
    normal = table["normal"][:, :2]
    reach = rows["r"][i] - table["overlap"] / 2
    return dict(
        i=named(i, n),
        j=named(j, n),
        id_i=table["i"],
        id_j=table["j"],
        fn=np.sum(table["normal_force"][:, :2] * normal, axis=1),
        ft=-np.sum(table["tangential_force"][:, :2] * np.c_[-normal[:, 1], normal[:, 0]], axis=1),
        slip=table["slip"],
        px=rows["x"][i] + reach * normal[:, 0],
        py=rows["y"][i] + reach * normal[:, 1],
    )


def named(row, n):
    """Return what a contact calls a disk: its row among the first `n`, INTRUDER beyond; walls stay as they are."""
    return np.where(row >= n, INTRUDER, row)


def present_contacts():
    """Return the table of all contacts at the present positions, from the loop that runs."""
    from yade import O

    loop = scene.fast_loop()
    if loop:
        return loop.presentContacts()
    interactions = grain_loop.find("InteractionLoop")
    law, contact_maker = interactions.lawDispatcher.functors[0], interactions.physDispatcher.functors[0]
    return engines.present_contacts(O._sceneObj, law, contact_maker)


def ordered(table):
    """Return a table of contacts with the smaller id as i, by rising ids; walls are second in any case.

    Turning a contact round turns the normal and forces, which act on j; slip is along z x n and of i against j: it stays.
    """
    turned = (table["j"] >= 0) & (table["i"] > table["j"])
    sides = dict(i=np.where(turned, table["j"], table["i"]), j=np.where(turned, table["i"], table["j"]))
    sign = np.where(turned, -1.0, 1.0)[:, None]
    vectors = {name: sign * table[name] for name in ("normal", "normal_force", "tangential_force")}
    scalars = {name: table[name] for name in ("overlap", "slip", "slipping")}
    order = np.lexsort((sides["j"], sides["i"]))
    return {name: column[order] for name, column in {**sides, **vectors, **scalars}.items()}
