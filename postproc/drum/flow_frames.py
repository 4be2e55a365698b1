"""Pictures of a continuum in time, the groups `flow_frames/NNNN` of a run folder, read one by one."""

from dataclasses import dataclass

import numpy as np

from .flow import SURFACE_LEVEL, FlowField

GROUP = "flow_frames"


@dataclass(frozen=True)
class FlowFrame:
    """A continuum at time `t`: `x` (nx,), `y` (ny,), the drum's axis at 0; `arrays` area_fraction, pressure, velocity."""

    t: float
    x: np.ndarray
    y: np.ndarray
    arrays: dict

    @property
    def field(self):
        """The `FlowField` of this moment."""
        velocity = self.arrays["velocity"]
        return FlowField(
            self.x, self.y, self.arrays["area_fraction"], velocity[..., 0], velocity[..., 1], SURFACE_LEVEL["continuum"]
        )


class FlowFrames:
    """The pictures of a continuum in a run (reader.Run), a sequence in the order of time, each read when it is asked for."""

    def __init__(self, run):
        self.run, self.names = run, sorted(run.names(GROUP), key=int)

    def __len__(self):
        return len(self.names)

    def __getitem__(self, k):
        if not 0 <= k < len(self):
            raise IndexError(k)
        name = f"{GROUP}/{self.names[k]}"
        arrays = self.run.group(name)
        return FlowFrame(self.time(k), arrays.pop("x"), arrays.pop("y"), arrays)

    def time(self, k):
        """Return the time of a picture."""
        return float(self.run.labels(f"{GROUP}/{self.names[k]}")[1]["t"])

    @property
    def units(self):
        """{name: unit} of a picture's arrays."""
        return self.run.labels(f"{GROUP}/{self.names[0]}")[0] if self.names else {}
