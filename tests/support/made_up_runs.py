"""Made-up run folders of the Magnus study with known laws, for tests of figures, reports and exports."""

import itertools
import json

import h5py
import numpy as np


THETA = (np.arange(24) + 0.5) * np.pi / 12 - np.pi
KEYS = dict(
    phi=0.352,
    v0=1.0,
    spin_ratio=0.0,
    mu=0.5,
    width=300.0,
    height=200.0,
    travel=300.0,
    dt_factor=1.0,
    fields=0,
    seed=1,
    intruder_diameter=5.0,
)
KAPPA = {0.135: 1.0, 0.352: 0.95, 0.585: 0.93, 0.818: 0.90}


class MadeUpMagnus:
    """The laws: D = 1000 Φ V0^`power` (1 + `rise` Ω/20), L/D from Eq. 15 times Ω⁴/(1 + Ω⁴); errors of 1 %."""

    def __init__(self, power=2.0, rise=0.0, error=0.01):
        self.power, self.rise, self.error = power, rise, error

    def summary(self, keys, noise):
        """Return the summary of one run; `noise` draws standard normal numbers."""
        spin, mu, kappa = keys["spin_ratio"], keys["mu"], KAPPA[keys["phi"]]
        saturated = kappa * mu - (1 - kappa) / mu if mu else 0.0
        rise = self.rise if keys["phi"] > 0.8 else 0.0
        drag = 1000 * keys["phi"] * keys["v0"] ** self.power * (1 + rise * spin / 20)
        contacts = keys["phi"] * keys["v0"] * (1 - 0.3 * spin / 20) * (1 - 0.2 * keys["v0"] * (keys["phi"] > 0.8))
        exact = dict(drag=drag, contacts=contacts, kappa=kappa, lift_to_drag=saturated * spin**4 / (1 + spin**4))
        errors = {name: self.error * (abs(value) if name != "lift_to_drag" else 0.2) for name, value in exact.items()}
        exact["front_share"], errors["kappa"], errors["front_share"] = 0.99, 0.002, 0.001
        noisy = {name: value + errors[name] * noise() for name, value in exact.items()}
        return {**noisy, **{f"{name}_err": error for name, error in errors.items()}}


def angles(keys, noise):
    """Return distributions by angle: everything in front, slipping by tanh; tangential forces counter-clockwise."""
    normal = np.where(np.abs(THETA) < np.pi / 2, np.cos(THETA), 1e-4) * (1 + 0.01 * noise())
    against_spin = np.tanh(2 * (keys["spin_ratio"] - np.sin(THETA))) * keys["mu"] * normal
    arrays = dict(normal=normal, tangential=-against_spin, contacts_by_angle=normal / normal.sum())
    return dict(theta=THETA, **arrays, **{f"{name}_err": 0.01 * np.abs(array) for name, array in arrays.items()})


def fields(keys, noise):
    """Return fields with a wake that bends and widens, hottest on the side that the paper names; SI units, one phase.

    All lengths grow with the body's diameter, 5 d in what follows.
    """
    x, scale = np.arange(-12, 12, 0.25) + 0.125, keys["intruder_diameter"] / 5
    X, Y = np.meshgrid(x, x)
    spin = keys["spin_ratio"]
    side = {0.0: 0.0, 1.0: -1.0, 10.0: 1.0}[spin]
    bend = 0.15 * spin / 10 * np.clip(-X, 0, None) + 0.02 * noise()
    wake = (X < 0) & (np.abs(Y - bend) < 2.6 + 0.5 * spin / 10)
    empty = wake | (np.hypot(X, Y) < 2.5)
    heat = np.exp(-((X - 2) ** 2) / 4 - (Y - 2.5 * side + 0.05 * noise()) ** 2 / 2)
    shield = np.exp(-np.hypot(X, Y) / 4)
    velocity = keys["v0"] * np.stack([shield - 1, 0.2 * Y * shield], axis=-1)
    velocity[empty], heat[empty] = np.nan, np.nan
    arrays = dict(area_fraction=np.where(empty, 0.0, keys["phi"]), velocity=velocity, temperature=heat)
    return dict(
        x=0.02 * scale * x,
        y=0.02 * scale * x,
        samples=np.array([1000]),
        **{name: array[None] for name, array in arrays.items()},
    )


def write_run(folder, name, keys, summary, groups, study="magnus"):
    """Write a complete run folder with these parameters, this summary and these groups of arrays."""
    path = folder / "runs" / name
    path.mkdir(parents=True)
    with h5py.File(path / "run.h5", "w", libver="latest") as file:
        file.attrs.update(state="complete", study=study, digest=name)
        for key, value in keys.items():
            dataset = file.require_group("parameters").create_dataset(key, data=value)
            dataset.attrs["unit"] = "-"
        file["constants/d"] = 0.02
        file.create_group("provenance").attrs.update(cpu="a processor", code_version="1", threads=1)
        for group, arrays in groups.items():
            for array, values in arrays.items():
                file[f"{group}/{array}"] = values
    facts = dict(wall_s=10.0, steps=1000, n_grains=100, particle_steps_per_second=1e4, dt_over_critical=0.1)
    (path / "summary.json").write_text(json.dumps({**facts, **summary}))


def make_campaign(folder, laws, sweeps, *, seed=1):
    """Make the folder of a campaign, {sweep: grid of lists of values}, with a run for each combination."""
    noise = np.random.default_rng(seed).standard_normal
    runs = {}
    for sweep, grid in sweeps.items():
        for values in itertools.product(*grid.values()):
            keys = {**KEYS, **dict(zip(grid, values))}
            name = "-".join(f"{key}_{value:g}" for key, value in keys.items())
            if name not in runs:
                groups = {
                    "angular": angles(keys, noise),
                    **({"fields/around": fields(keys, noise)} if keys["fields"] else {}),
                }
                write_run(folder, name, keys, laws.summary(keys, noise), groups)
                runs[name] = dict(name=name, sweeps=[])
            runs[name]["sweeps"].append(sweep)
    plan = dict(name=folder.name, file="campaigns/x.yaml", study="magnus", report="magnus", runs=list(runs.values()))
    (folder / "campaign.json").write_text(json.dumps(plan))
    return folder
