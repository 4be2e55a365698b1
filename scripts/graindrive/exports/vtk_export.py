"""Frames and fields of a run for ParaView: grains, contacts, driven body as .vtp, continuum, fields as .vti, times as .pvd."""

from pathlib import Path

import numpy as np

from .vtk_files import image, in_plane, modules, polydata, write, write_collection

CORNERS = 72  # of the polygon that represents a single disk

__all__ = ["export", "export_fields", "export_flow", "modules"]

# Names in these files -> names in frames.
GRAINS = {"id": "id", "radius": "r", "velocity": "vx", "spin": "spin", "role": "role"}
CONTACTS = {"i": "id_i", "j": "id_j", "normal_force": "fn", "tangential_force": "ft", "slip": "slip"}


def export(frames, folder, body=None, units=()):
    """Write `grains_NNNN.vtp`, `contacts_NNNN.vtp`, `intruder_NNNN.vtp` and `grains.pvd` … into `folder`.

    `frames` yields `graindrive.postproc.reader.Frame`s; `body` holds the arrays of the group `intruder`, `units` maps the
    frames' names to units. Grains are points with id, radius, velocity, spin and role, the driven body's disks among them
    with role 2: in ParaView, use sphere glyphs, scaled by radius with factor 2. Contacts are lines from centre to centre with
    ids i, j, slip, normal force (< 0: attractive) and tangential force (on i along z x n). The intruder is its outline as one
    closed line; a single disk is a circle with a spoke, which shows its rotation, a drum is the ring of its wall's disks.
    Spheres have spin, slip and tangential force as vectors. A driven body among them is its beads, or, if it is a solid, a
    surface of polygons; an endless solid is closed at the box's sides. Raises UsageError without python3-vtk9.
    """
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    units, written = dict(units), {"grains": [], "contacts": []}
    for number, frame in enumerate(frames, start=1):
        parts = {"grains": grain_points(frame, units), "contacts": contact_lines(frame, units)}
        if body and len(frame.axes) == 2 and len(frame.intruder.get("x", ())):
            parts["intruder"] = outline(frame, body)
        if body and len(frame.axes) == 3 and "high" in body:
            parts["intruder"] = solid(frame, body)
        for kind, data in parts.items():
            name = f"{kind}_{number:04d}.vtp"
            write(data, folder / name)
            written.setdefault(kind, []).append((frame.t, name))
    for kind, entries in written.items():
        write_collection(folder / f"{kind}.pvd", entries)


def grain_points(frame, units):
    """Return the vtkPolyData of a frame's grains."""
    g = frame.disks()
    n = len(g["x"])
    arrays = {name: g[column] for name, column in GRAINS.items() if column in g and name != "velocity"}
    arrays["velocity"] = as_vectors(frame.along_axes(g, "v{}"))
    names = GRAINS
    if len(frame.axes) == 3:
        arrays["spin"], names = frame.along_axes(g, "spin_{}"), {**GRAINS, "spin": "spin_x"}
    cells = np.arange(n).reshape(n, 1)
    return polydata(as_vectors(frame.along_axes(g)), "verts", cells, arrays, renamed(units, names), on_points=True)


def as_vectors(columns):
    """Return (n, 2) or (n, 3) numbers as vectors in space."""
    return in_plane(*columns.T) if columns.shape[1] == 2 else np.ascontiguousarray(columns, dtype=float)


def contact_lines(frame, units):
    """Return the vtkPolyData of a frame's contacts; a line across a periodic side ends beyond it, at j's image."""
    c, names = frame.contacts, CONTACTS
    n = len(c["fn"]) if c else 0
    ends = frame.contact_ends() if n else (np.zeros((0, len(frame.axes))),) * 2
    arrays = {name: c[column] for name, column in CONTACTS.items() if column in c} if n else {}
    if n and len(frame.axes) == 3:
        names = {**CONTACTS, "tangential_force": "ft_x", "slip": "slip_x"}
        arrays.update(tangential_force=frame.along_axes(c, "ft_{}"), slip=frame.along_axes(c, "slip_{}"))
    points, cells = as_vectors(np.concatenate(ends)), np.arange(2 * n).reshape(2, n).T
    return polydata(points, "lines", cells, arrays, renamed(units, names), on_points=False)


def outline(frame, body):
    """Return the vtkPolyData of the driven body's outline in a frame."""
    corners = body["outline"] if len(body.get("outline", ())) else ring(body)
    places = frame.place(corners, body["beads"])
    cells = np.append(np.arange(len(places)), 0)[None, :]
    return polydata(in_plane(*places.T), "lines", cells, {}, on_points=False)


def solid(frame, body):
    """Return the vtkPolyData of the surface of a driven solid in a frame."""
    points, faces = swept(body) if len(body["outline"]) else (body["points"], [body["quads"]])
    return polydata(frame.place_solid(points), "polys", faces, {}, on_points=False)


def swept(body):
    """Return points (2 m, 3) and faces, arrays of rows, of an outline (m, 2) of x and z that is swept along y with both ends."""
    outline, m = np.asarray(body["outline"]), len(body["outline"])
    if area(outline) < 0:
        outline = outline[::-1]
    points = [np.insert(outline, 1, body[end][1], axis=1) for end in ("low", "high")]
    here, there = np.arange(m), np.roll(np.arange(m), -1)
    sides = np.stack([here, here + m, there + m, there], axis=1)
    return np.concatenate(points), [sides, here[None, :], (here[::-1] + m)[None, :]]


def area(outline):
    """Return the area within an outline (m, 2), > 0 for corners that go round counter-clockwise."""
    (x, y), (x_next, y_next) = outline.T, np.roll(outline, -1, axis=0).T
    return np.sum(x * y_next - x_next * y) / 2


def ring(body):
    """Return the outline (m, 2) of a body that has none: through its disks in turn, as of a drum's wall, or one disk's circle."""
    beads = np.asarray(body["beads"], dtype=float)
    if len(beads) == 1:
        return circle_with_spoke(body)
    return beads[np.argsort(np.arctan2(beads[:, 1], beads[:, 0]), kind="stable")]


def circle_with_spoke(body):
    """Return a single disk's outline (m, 2) about its centre: centre and circle, which a closed line joins by a spoke."""
    angles = np.linspace(0, 2 * np.pi, CORNERS + 1)
    radius = float(np.atleast_1d(body["bead_radius"])[0])
    return np.concatenate([[[0.0, 0.0]], radius * np.column_stack([np.cos(angles), np.sin(angles)])])


def renamed(units, names):
    """Return the units of the arrays of a file."""
    return {name: units[column] for name, column in names.items() if column in units}


def export_flow(frames, units, folder):
    """Write `flow_NNNN.vti` and `flow.pvd` of pictures of a continuum, in the frame of reference of the grains' files.

    `frames` yields `graindrive.postproc.drum.flow_frames.FlowFrame`s, `units` maps their names to units.
    """
    entries = []
    for number, frame in enumerate(frames, start=1):
        file = f"flow_{number:04d}.vti"
        write(image(frame.x, frame.y, frame.arrays, units), Path(folder) / file)
        entries.append((frame.t, file))
    write_collection(Path(folder) / "flow.pvd", entries)


def export_fields(fields, name, folder):
    """Write `fields_NAME_PP.vti`, one per phase, and `fields_NAME.pvd`, at the middles of the phases in time.

    `fields` is a `graindrive.postproc.fields.Fields`. Places are those of the averager's window: about the driven body.
    """
    phases = len(fields.samples)
    period, start = (float(fields.settings.get(key, 0)) for key in ("period", "phaseStart"))
    entries = []
    for phase in range(phases):
        file = f"fields_{name}_{phase + 1:02d}.vti"
        arrays = {field: values[phase] for field, values in fields.arrays.items()}
        write(image(fields.x, fields.y, arrays, fields.units, fields.axes), Path(folder) / file)
        entries.append((start + (phase + 0.5) / phases * period, file))
    write_collection(Path(folder) / f"fields_{name}.pvd", entries)
