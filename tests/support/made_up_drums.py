"""Made-up run folders of the drum study with known laws, for tests of its figure and of its campaigns' report."""

import itertools
import json

import numpy as np
from drum_fields import MadeUpDrum
from made_up_runs import write_run

from graindrive.postproc.drum.flow import analysed

KEYS = dict(model="both", drum_diameter=60.0, angular_velocity=0.01, froude=3e-3, seed=1)
KEYS.update(continuum_dt=0.02, cells=75, largest_viscosity=8e4, tolerance=1e-5)
KEYS.update(static_friction=0.246, dynamic_friction=0.401, inertial_scale=0.133)


class MadeUpDrums:
    """The laws: h/D = a + b Fr, in the continuum larger by `apart`, with errors of 1 %; bed and layer as in `MadeUpDrum`.

    `thicker` is the increase of the thickness over D from a drum of D to one of 2 D.
    """

    def __init__(self, intercept=0.11, slope=1.2, apart=0.0, thicker=0.0):
        self.intercept, self.slope, self.apart, self.thicker = intercept, slope, apart, thicker

    def thickness(self, keys, model):
        """h/D of a run."""
        more = self.thicker * np.log2(keys["drum_diameter"] / 60) + self.apart * (model == "continuum")
        return self.intercept + self.slope * keys["froude"] + more

    def seconds(self, keys):
        """Seconds of one core that the continuum takes, by cells and time step."""
        return 1e-3 * keys["cells"] ** 2 / keys["continuum_dt"]

    def flow(self, keys, model):
        """Return the made-up drum in which u = 0 at that h."""
        wanted, shape = self.thickness(keys, model) * keys["drum_diameter"], dict(spacing=keys["drum_diameter"] / 50)
        shape.update(diameter=keys["drum_diameter"], omega=keys["angular_velocity"])
        layers = np.linspace(0.05, 0.6, 400) * keys["drum_diameter"]
        found = [MadeUpDrum(layer=layer, **shape).thickness for layer in layers]
        return MadeUpDrum(
            layer=float(np.interp(wanted, found, layers)), density=1.0 if model == "continuum" else 0.825, **shape
        )

    def run(self, keys, noise):
        """Return (summary, groups) of a run of these keys; `noise` draws standard normal numbers."""
        models = ["dem", "continuum"] if keys["model"] == "both" else [keys["model"]]
        summary, groups = dict(froude=keys["froude"], steady=1, averaged_from=90.0), {}
        for k, model in enumerate(models):
            field = self.flow(keys, model).field(0.5)
            found = analysed(field, keys["drum_diameter"], keys["angular_velocity"])
            exact = {**found.numbers, "thickness_over_diameter": self.thickness(keys, model)}
            errors = {name: 0.01 * abs(value) + 1e-4 for name, value in exact.items()}
            values = {name: value + errors[name] * noise() for name, value in exact.items()}
            values.update({f"{name}_err": error for name, error in errors.items()})
            summary.update({f"continuum_{name}" if k else name: value for name, value in values.items()})
            profile, scale = found.profile, keys["angular_velocity"] * keys["drum_diameter"]
            error = np.full(len(profile.z), 0.005 * scale)
            groups[f"depth/{model}"] = dict(z=profile.z, u=profile.u, u_err=error, fraction=profile.fraction)
            velocity = np.stack([field.velocity_x, field.velocity_y], axis=-1)
            groups[f"fields/{model}"] = dict(
                x=field.x, y=field.y, samples=np.array([9]), area_fraction=field.fraction[None], velocity=velocity[None]
            )
        if "continuum" in models:
            summary.update(continuum_core_seconds=self.seconds(keys))
        if len(models) == 2:
            summary.update(dem_continuum_difference=3 * self.apart + 0.02, dem_continuum_difference_err=0.005)
        return summary, groups


def make_drums(folder, laws, sweeps, *, seed=1):
    """Make the folder of a campaign, {sweep: grid of lists of values}, with a run for each combination; Omega follows Fr."""
    noise, runs = np.random.default_rng(seed).standard_normal, {}
    for sweep, grid in sweeps.items():
        for values in itertools.product(*grid.values()):
            keys = {**KEYS, **dict(zip(grid, values))}
            keys["angular_velocity"] = float(np.sqrt(2 * keys["froude"] / keys["drum_diameter"]))
            name = "-".join(f"{key}_{value}" for key, value in keys.items())
            if name not in runs:
                write_run(folder, name, keys, *laws.run(keys, noise), study="drum")
                runs[name] = dict(name=name, sweeps=[])
            runs[name]["sweeps"].append(sweep)
    plan = dict(name=folder.name, file="campaigns/x.yaml", study="drum", report="drum", runs=list(runs.values()))
    (folder / "campaign.json").write_text(json.dumps(plan))
    return folder
