"""mu(I) and phi(I) beside the straight lines of da Cruz, Emam, Prochnow, Roux, Chevoir, Phys. Rev. E 72, 021309 (2005).

They shear disks between rough walls under a pressure and find mu* = mu_min + b I and nu = nu_max - a I in the dense flow, about
0.01 < I < 0.2, of disks with friction 0.4, with I = shear_rate sqrt(m/P), m the mean mass of a disk; friction matters little.
Their diameters differ by up to 20 % about the mean, ours by 9 %.
"""

import numpy as np

from .. import figures
from ..campaign.plots import canvas, draw_points, look
from ..campaign.verdicts import Agrees
from ..figures import BLACK, GREY
from .points import DISK, claim, points_of, up_to
from .rheology import LAST_STRAIGHT, straight_line

SOURCE = "da Cruz et al. 2005"
MU_MIN, B, NU_MAX, A = 0.25, 1.1, 0.81, 0.3  # printed as approximate
MEAN_SQUARE = (1.2**3 - 1) / (3 * 0.2)  # of diameters uniform between d and 1.2 d [d^2]
BY_MASS = float(np.sqrt(DISK * MEAN_SQUARE))  # their I over ours: 0.976
LEAST = 0.009  # of I: where mu begins to be a straight line


def straight(rows):
    """Return the runs whose I is where both laws are straight lines."""
    return up_to(rows[rows["inertial_number"] >= LEAST], LAST_STRAIGHT)


def claims(campaign, rows):
    """Their four numbers on disks of their friction, restitution and k_n/P, and on the drum's disks."""
    found = compared(rows, "μ_p 0.4, e 0.1")
    drums = straight(campaign.sweep("rheology"))
    return found + (compared(drums, "the drum's disks, μ_p 0.5, e 0.92") if len(drums) else [])


def compared(rows, words):
    """Return the four claims on the runs of one kind of disks."""
    chosen = straight(rows)
    (mu_min, b), (nu_max, a) = (line_of(chosen, name) for name in ("stress_ratio", "phi"))
    until = f"{words}, I = {chosen['inertial_number'].min():g} to {chosen['inertial_number'].max():g}"
    return [
        claim(chosen, f"μ at I → 0 of μ_min + b I; {until}", SOURCE, "≈ 0.25", mu_min, Agrees(MU_MIN, 0.01, 0.02)),
        claim(chosen, f"b of μ_min + b I; {until}", SOURCE, "≈ 1.1", b, Agrees(B, 0.1, 0.2)),
        claim(chosen, f"φ at I → 0 of φ_max − a I; {until}", SOURCE, "≈ 0.81", nu_max, Agrees(NU_MAX, 0.01, 0.01)),
        claim(chosen, f"−a of φ_max − a I; {until}", SOURCE, "≈ −0.3", a, Agrees(-A, 0.05, 0.1)),
    ]


def line_of(rows, name):
    """Return (value at 0, slope) of a quantity against their I."""
    inertial, points = points_of(rows, name)
    return straight_line(BY_MASS * inertial, points)


def draw(campaign, rows):
    """mu and phi of both kinds of disks against their I, with their lines."""
    figure, ((left, right),) = canvas(1, 2, width=2 * figures.COLUMN_WIDTH, height=2.5)
    kinds = [(rows, "μ_p 0.4, e 0.1"), (campaign.sweep("rheology"), "μ_p 0.5, e 0.92")]
    line = np.linspace(0, 0.25, 50)
    for axes, name, law, label in (
        (left, "stress_ratio", MU_MIN + B * line, "μ = τ/p"),
        (right, "phi", NU_MAX - A * line, "area fraction φ"),
    ):
        for k, (chosen, words) in enumerate(kinds):
            if len(chosen):
                inertial, points = points_of(up_to(chosen, 0.25), name)
                draw_points(axes, BY_MASS * inertial, points, **{**look(k, words), "linestyle": "none"})
        axes.plot(line, law, "--", color=GREY, linewidth=0.9, label="da Cruz et al. 2005")
        axes.axvline(BY_MASS * LAST_STRAIGHT, color=BLACK, linewidth=0.5, linestyle=":")
        axes.set(xlabel="I = γ̇ √(m/P)", ylabel=label)
        axes.legend()
    return figure
