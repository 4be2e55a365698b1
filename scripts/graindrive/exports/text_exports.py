"""Frames of a run as text for other particle codes: extended XYZ (OVITO, ASE) and LAMMPS's dump (LAMMPS, OVITO)."""

import numpy as np

DIGITS = "%.12g"


def box_of(frames):
    """Return (low, high), arrays (3,), of a box around all grains of all frames; periodic axes have the box's period."""
    low, high, radius, periods = np.inf, -np.inf, 0.0, np.zeros(2)
    for frame in frames:
        d, periods = frame.disks(), frame.periods
        places = frame.along_axes(d)
        low = np.minimum(low, (places - d["r"][:, None]).min(axis=0))
        high = np.maximum(high, (places + d["r"][:, None]).max(axis=0))
        radius = max(radius, d["r"].max())
    low, high = np.where(periods > 0, 0, low), np.where(periods > 0, periods, high)
    return (low, high) if len(low) == 3 else (np.append(low, -radius), np.append(high, radius))


def columns_of(frame):
    """Return a frame's grains and the driven body's beads as columns, dict of (n,), with positions inside the period."""
    d = frame.disks()
    columns = {**d, "zero": np.zeros(len(d["x"]))}
    for axis, period in zip(frame.axes, frame.periods):
        if period:
            inside = np.mod(d[axis], period)
            columns[axis] = np.where(inside < period, inside, 0.0)  # np.mod(-1e-20, period) is the period
    return columns


def vectors_of(frame):
    """Return the names of the columns of positions, velocities and spins: x, y, z each; for disks only the spin about z."""
    if len(frame.axes) == 3:
        return ("x", "y", "z"), ("vx", "vy", "vz"), ("spin_x", "spin_y", "spin_z")
    return ("x", "y", "zero"), ("vx", "vy", "zero"), ("spin",)


def write_rows(file, columns, integers, numbers):
    """Write a line per disk: columns of whole numbers, then of numbers, given by their names."""
    table = np.column_stack([columns[name] for name in (*integers, *numbers)])
    np.savetxt(file, table, fmt=["%d"] * len(integers) + [DIGITS] * len(numbers))


def write_xyz(frames, file, units, dt):
    """Write frames, a list that may be read twice, into an open text file as extended XYZ.

    Columns: id (YADE's), type (the role), pos, radius, velo, spin (of disks one number, about z). The comment line holds
    Lattice, Origin, pbc, Time and the units; all frames have one box. Format: https://github.com/libAtoms/extxyz.
    """
    low, high = box_of(frames)
    size = high - low
    lattice = " ".join(DIGITS % value for value in np.diag(size).ravel())
    origin = " ".join(DIGITS % value for value in low)
    units = {**units, **({"spin": units["spin_x"]} if "spin_x" in units else {})}
    said = " ".join(f'{key}_unit="{units[name]}"' for key, name in UNITS_SAID.items() if name in units)
    for frame in frames:
        columns, (places, velocities, spins) = columns_of(frame), vectors_of(frame)
        periodic = " ".join("T" if period else "F" for period in np.append(frame.periods, 0)[:3])
        properties = f"id:I:1:type:I:1:pos:R:3:radius:R:1:velo:R:3:spin:R:{len(spins)}"
        file.write(f"{len(columns['x'])}\n")
        file.write(
            f'Lattice="{lattice}" Origin="{origin}" pbc="{periodic}" Properties={properties} Time={frame.t!r} {said}'.rstrip()
            + "\n"
        )
        write_rows(file, columns, ("id", "role"), (*places, "r", *velocities, *spins))


UNITS_SAID = {"length": "x", "velocity": "vx", "spin": "spin", "time": "t"}


def write_lammps(frames, file, units, dt):
    """Write frames, a list that may be read twice, into an open text file as LAMMPS's dump does.

    id is YADE's + 1 and type the role + 1, for LAMMPS counts from 1; the step is the time over the run's `dt`. As in
    LAMMPS's own two-dimensional dumps z of disks is periodic. Format: LAMMPS's manual, `dump custom` and `read_dump`.
    """
    low, high = box_of(frames)
    style = "si" if units.get("x") == "m" else "lj"
    for frame in frames:
        columns = columns_of(frame)
        columns.update(number=columns["id"] + 1, type=columns["role"] + 1)
        places, velocities, spins = vectors_of(frame)
        sides = ["pp" if period else "ff" for period in frame.periods] + ["pp"] * (3 - len(frame.axes))
        spin_names = "omegax omegay omegaz" if len(spins) == 3 else "omegaz"
        file.write(f"ITEM: UNITS\n{style}\nITEM: TIME\n{frame.t!r}\nITEM: TIMESTEP\n{round(frame.t / dt)}\n")
        file.write(f"ITEM: NUMBER OF ATOMS\n{len(columns['x'])}\nITEM: BOX BOUNDS {' '.join(sides)}\n")
        file.write("".join(f"{DIGITS % a} {DIGITS % b}\n" for a, b in zip(low, high)))
        file.write(f"ITEM: ATOMS id type x y z vx vy vz radius {spin_names}\n")
        write_rows(file, columns, ("number", "type"), (*places, *velocities, "r", *spins))
