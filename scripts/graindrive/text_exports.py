"""Frames of a run as text for other particle codes: extended XYZ (OVITO, ASE) and LAMMPS's dump (LAMMPS, OVITO)."""

import numpy as np

DIGITS = "%.12g"


def box_of(frames):
    """Return (low, high), arrays (3,), of a box around all disks of all frames; in x the period where there is one."""
    low, high, radius, period = np.full(2, np.inf), np.full(2, -np.inf), 0.0, 0.0
    for frame in frames:
        d, period = frame.disks(), frame.period
        places = np.column_stack([d["x"], d["y"]])
        low = np.minimum(low, (places - d["r"][:, None]).min(axis=0))
        high = np.maximum(high, (places + d["r"][:, None]).max(axis=0))
        radius = max(radius, d["r"].max())
    if period:
        low[0], high[0] = 0, period
    return np.append(low, -radius), np.append(high, radius)


def columns_of(frame):
    """Return a frame's disks as columns, dict of (n,): all x inside the period, beads of the driven body too."""
    d = frame.disks()
    x = np.mod(d["x"], frame.period) if frame.period else d["x"]
    return {**d, "x": np.where(x < frame.period, x, 0.0) if frame.period else x, "zero": np.zeros(len(x))}


def write_rows(file, columns, integers, numbers):
    """Write a line per disk: columns of whole numbers, then of numbers, given by their names."""
    table = np.column_stack([columns[name] for name in (*integers, *numbers)])
    np.savetxt(file, table, fmt=["%d"] * len(integers) + [DIGITS] * len(numbers))


def write_xyz(frames, file, units, dt):
    """Write frames, a list that may be read twice, into an open text file as extended XYZ.

    Columns: id (YADE's), type (the role), pos, radius, velo, spin. The comment line holds Lattice, Origin, pbc, Time and the
    units; all frames have one box. Format: https://github.com/libAtoms/extxyz.
    """
    low, high = box_of(frames)
    size = high - low
    lattice = " ".join(DIGITS % value for value in np.diag(size).ravel())
    origin = " ".join(DIGITS % value for value in low)
    properties = "id:I:1:type:I:1:pos:R:3:radius:R:1:velo:R:3:spin:R:1"
    said = " ".join(f'{key}_unit="{units[name]}"' for key, name in UNITS_SAID.items() if name in units)
    for frame in frames:
        columns, periodic = columns_of(frame), "T F F" if frame.period else "F F F"
        file.write(f"{len(columns['x'])}\n")
        file.write(
            f'Lattice="{lattice}" Origin="{origin}" pbc="{periodic}" Properties={properties} Time={frame.t!r} {said}'.rstrip()
            + "\n"
        )
        write_rows(file, columns, ("id", "role"), ("x", "y", "zero", "r", "vx", "vy", "zero", "spin"))


UNITS_SAID = {"length": "x", "velocity": "vx", "spin": "spin", "time": "t"}


def write_lammps(frames, file, units, dt):
    """Write frames, a list that may be read twice, into an open text file as LAMMPS's dump does.

    id is YADE's + 1 and type the role + 1, for LAMMPS counts from 1; the step is the time over the run's `dt`. As in
    LAMMPS's own two-dimensional dumps z is periodic. Format: LAMMPS's manual, `dump custom` and `read_dump`.
    """
    low, high = box_of(frames)
    style = "si" if units.get("x") == "m" else "lj"
    for frame in frames:
        columns = columns_of(frame)
        columns.update(number=columns["id"] + 1, type=columns["role"] + 1)
        sides = ["pp" if frame.period else "ff", "ff", "pp"]
        file.write(f"ITEM: UNITS\n{style}\nITEM: TIME\n{frame.t!r}\nITEM: TIMESTEP\n{round(frame.t / dt)}\n")
        file.write(f"ITEM: NUMBER OF ATOMS\n{len(columns['x'])}\nITEM: BOX BOUNDS {' '.join(sides)}\n")
        file.write("".join(f"{DIGITS % a} {DIGITS % b}\n" for a, b in zip(low, high)))
        file.write("ITEM: ATOMS id type x y z vx vy vz radius omegaz\n")
        write_rows(file, columns, ("number", "type"), ("x", "y", "zero", "vx", "vy", "zero", "r", "spin"))
