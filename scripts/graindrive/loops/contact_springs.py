"""Transfers the tangential springs of contacts from YADE's interactions to GrainLoop's springs and wallSprings, and back."""

from .loop_laws import only

# Law2_ -> the attribute of the contact's phys in which it remembers a force [N]; laws of our own remember a spring [m], `slip`
REMEMBERED = {
    "Law2_ScGeom_FrictPhys_CundallStrack": "shearForce",
    "Law2_ScGeom_MindlinPhys_Mindlin": "shearElastic",
}


def springs_of(contacts, dimensions):
    """Return the tangential springs of the present contacts of an InteractionLoop, in the form of springs and wallSprings.

    For disks: id, id, number along z x n; for spheres: id, id and the vector of the first against the second. In wallSprings
    the solid comes first, and the vector is that of the grain against the solid.
    """
    from yade import O

    attribute = REMEMBERED.get(type(only(contacts.lawDispatcher.functors, "Law2_")).__name__, "slip")
    springs, at_solids = [], []
    for contact in O.interactions:
        if contact.isReal:
            remembered = getattr(contact.phys, attribute)
            x, y, _ = contact.geom.normal
            along = remembered if dimensions == 3 else [x * remembered[1] - y * remembered[0]]
            if is_solid(contact.id1):  # YADE's first body; the number along z x n is the same for both sides
                at_solids += [contact.id1, contact.id2, *(along if dimensions == 2 else -along)]
            else:
                springs += [contact.id1, contact.id2, *along]
    return {"springs": springs, "wallSprings": at_solids}


def is_solid(ident):
    """Tell whether a body of O.bodies is a Solid."""
    from yade import O

    return type(O.bodies[ident].shape).__name__ == "Solid"


def give_springs(contacts, loop):
    """Set the tangential springs of the present contacts of an InteractionLoop from GrainLoop's springs and wallSprings."""
    from yade import O

    attribute = REMEMBERED.get(type(only(contacts.lawDispatcher.functors, "Law2_")).__name__, "slip")
    dimensions = loop.dimensions
    remembered = by_ids(loop.springs, dimensions)
    for (solid, grain), spring in by_ids(loop.wallSprings, dimensions).items():
        remembered[grain, solid] = spring  # of the grain against the solid
    for contact in O.interactions:
        if contact.isReal:
            setattr(contact.phys, attribute, spring_between(remembered, contact, dimensions))


def by_ids(numbers, dimensions):
    """Return {(id, id): spring} for a list in GrainLoop's form."""
    width = 3 if dimensions == 2 else 5
    rows = (numbers[k : k + width] for k in range(0, len(numbers), width))
    return {(int(row[0]), int(row[1])): row[2:] for row in rows}


def spring_between(remembered, contact, dimensions):
    """Return the spring of a YADE interaction as a vector, from `remembered`, {(id, id): numbers}; zero if it has none.

    Exchanging the two sides reverses a vector; the number along z x n of disks keeps its sign.
    """
    from yade.minieigenHP import Vector3

    forth, back = (contact.id1, contact.id2), (contact.id2, contact.id1)
    found, sign = (remembered[forth], 1.0) if forth in remembered else (remembered.get(back), -1.0)
    if found is None:
        return Vector3.Zero
    if dimensions == 3:
        return Vector3(*found) * sign
    x, y, _ = contact.geom.normal
    return Vector3(-y, x, 0) * found[0]
