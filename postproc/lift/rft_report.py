"""RFT on trial: plates, half-cylinders and the cylinder of a campaign, with claims and the figure against depth."""

from functools import partial

import numpy as np

from .. import figures
from ..campaign.claims import claim_on
from ..campaign.plots import canvas, draw_points, look
from ..campaign.runs import quantity
from ..campaign.verdicts import Agrees, above, below
from ..figures import BLACK
from ..measured import Measured
from . import rft

DING = "Ding et al. 2011"
LI = "Li et al. 2013"
GUILLARD = "Guillard et al. 2014, Fig. 8(b)"
SIDES = {"up": ("half_flat_up", above(0), "> 0"), "down": ("half_flat_down", below(0), "< 0")}
FORMS = (("published", rft.as_published), ("split", rft.as_split))
FITS = 4.0  # χ² over its degrees of freedom, of a fit whose points' errors may be half of what they should be
TOLERANCE = 0.2  # of a force, where Ding et al. speak of a good approximation

claim = partial(claim_on, dict(lid_density=("ρ*/ρ_g", ""), depth=("h", " d"), shape=("", "")))


# ---- from runs to plates ---------------------------------------------------------------------------------------------


def outline_of(campaign, row):
    """Return the corners (m, 2) [m] of the body of a run; a cylinder's are reckoned, so that runs which lack them serve too."""
    if row["shape"] == "cylinder":
        return rft.circle(float(row["body_height"] * row["grain_diameter"]))
    return campaign.run(row["run"]).group("intruder")["outline"]


def depth_of(row):
    """Return the effective depth of a run's axis [m]."""
    return float(row["effective_depth"] * row["grain_diameter"])


def breadth_of(row):
    """Return the body's breadth [m]."""
    return float(row["breadth"] * row["grain_diameter"])


def unit_of(row):
    """Return rho g [N/m^3]."""
    return float(row["pressure"]) / depth_of(row)


def plates_of(campaign, rows):
    """Return the `Plates` of a sweep of runs, ordered by tilt; at the mean of their depths, which differ by little."""
    found = []
    for _, row in rows.iterrows():
        beta, length = rft.longest_edge(outline_of(campaign, row))
        area = length * breadth_of(row) * depth_of(row)
        values = [(row[name] / area, row[f"{name}_err"] / area) for name in ("drag", "lift")]
        found.append((beta, values))
    found.sort(key=lambda plate: plate[0])
    values = np.array([values for _, values in found], dtype=float)  # plate, component, (value, error)
    depth = float(np.mean([depth_of(row) for _, row in rows.iterrows()]))
    return rft.Plates(np.array([beta for beta, _ in found]), values[:, :, 0].T, values[:, :, 1].T, depth)


def predicted(campaign, row, plates, form, weights=rft.linear):
    """Return (C_d, lift over buoyancy) of a run's body by RFT, as `Measured`, at the run's own depth."""
    elements = rft.leading_elements(outline_of(campaign, row))
    drag, lift = forces_on(elements, plates, depth_of(row), form, weights)
    breadth = breadth_of(row)
    over_drag = breadth / (row["drag"] / row["drag_coefficient"])
    over_lift = breadth / row["buoyancy"]
    return scaled(drag, over_drag), scaled(lift, over_lift)


def forces_on(elements, plates, depth, form, weights=rft.linear):
    """Return drag and lift per breadth [N/m] as `Measured`."""
    values, errors = rft.force(form(elements, plates, depth, weights), plates)
    return [Measured(float(value), float(error)) for value, error in zip(values, errors)]


def scaled(measured, factor):
    """Return a `Measured` times a number."""
    return Measured(measured.value * factor, measured.error * abs(factor))


def against_depth(plates, diameter, rho_g, depths, form, weights=rft.linear):
    """Return (C_d, lift over buoyancy) of a cylinder at depths (n,) [m] by RFT, each an array (n, 2) of values and errors."""
    elements = rft.leading_elements(rft.circle(diameter))
    found = []
    for depth in depths:
        drag, lift = forces_on(elements, plates, depth, form, weights)
        units = rho_g * depth * diameter, rho_g * np.pi * diameter**2 / 4
        found.append([(force.value / unit, force.error / unit) for force, unit in zip((drag, lift), units)])
    return np.moveaxis(np.array(found), 1, 0)


# ---- claims ----------------------------------------------------------------------------------------------------------


def rft_claims(campaign, rows):
    """What plates say of half-cylinders and of the cylinder, and whether their stress grows with depth as published."""
    if not complete(campaign, rows):
        return []
    plates = plates_of(campaign, rows)
    halves, cylinder, others = (campaign.sweep(name) for name in ("halves", "cylinder", "growth"))
    return [
        *fourier_claims(rows, plates),
        *half_claims(campaign, halves, plates),
        *cylinder_claims(campaign, cylinder, plates),
        *growth_claims(campaign, rows, others),
    ]


def complete(campaign, rows):
    """True if each plate of a sweep has its mirror image, so that sums around a body can be made."""
    if len(rows) < 3:
        return False
    try:
        rft.mirror(plates_of(campaign, rows))
    except ValueError:
        return False
    return True


def fourier_claims(rows, plates):
    """Whether the three Fourier terms that are left of the published sum pass through the plates; nothing for three or fewer."""
    freedom = len(plates.beta) - rft.TERMS
    if freedom < 1:
        return []
    error = float(np.sqrt(2 / freedom))  # standard deviation of chi^2 over its degrees of freedom
    return [
        claim(
            rows,
            f"{name} by tilt is three Fourier terms; χ² over its degrees of freedom",
            LI,
            "≈ 1",
            Measured(float(value), error),
            below(FITS),
        )
        for name, value in zip(("α_x", "α_z"), rft.misfit(plates))
    ]


def half_claims(campaign, rows, plates):
    """Sign of the lift on half-cylinders, and lift and drag over those by RFT."""
    claims = []
    for side, (name, rule, expected) in SIDES.items():
        found = rows[rows["shape"].str.contains(name)] if len(rows) else rows
        lift = quantity(found, "lift_over_buoyancy")
        claims.append(claim(found, f"half-cylinder, flat side {side}: lift over buoyancy", DING, expected, lift, rule))
        if len(found):
            claims += ratio_claims(campaign, found, plates, f"half-cylinder, flat side {side}", rft.as_published, "")
    return claims


def ratio_claims(campaign, rows, plates, what, form, form_name):
    """Measured drag and lift of the one run of `rows` over those by RFT."""
    row = rows.iloc[0]
    by_rft = predicted(campaign, row, plates, form)
    claims = []
    for name, quantity_name, number in zip(("drag", "lift"), ("drag_coefficient", "lift_over_buoyancy"), by_rft):
        ratio = quantity(rows.iloc[:1], quantity_name) / number
        text = f"{what}: {name} over RFT's{form_name}"
        claims.append(claim(rows.iloc[:1], text, DING, "1", ratio, Agrees(1, TOLERANCE, 2 * TOLERANCE)))
    return claims


def cylinder_claims(campaign, rows, plates):
    """Drag and lift on the cylinder at the plates' depth, and the lift at the largest depth by both forms."""
    if not len(rows):
        return []
    rows = rows.iloc[np.argsort(rows["effective_depth"].to_numpy())]
    nearest = np.argmin(np.abs([depth_of(row) - plates.depth for _, row in rows.iterrows()]))
    claims = ratio_claims(
        campaign, rows.iloc[[nearest]], plates, "cylinder, at the plates' depth", rft.as_published, ""
    )
    for name, form in FORMS:
        deepest = rows.iloc[[-1]]
        lift = quantity(deepest, "lift_over_buoyancy")
        ratio = predicted(campaign, deepest.iloc[0], plates, form)[1] / lift
        text = f"cylinder, deepest run: RFT's lift, {name} form, over the measured"
        claims.append(claim(deepest, text, GUILLARD, "1", ratio, Agrees(1, TOLERANCE, 2 * TOLERANCE)))
    return claims


def growth_claims(campaign, rows, others):
    """How the mirror-odd and the mirror-even part of alpha_z |z| of two plates grow from the smaller to the larger depth."""
    if len(others) < 2:
        return []
    few, plates = plates_of(campaign, others), plates_of(campaign, rows)
    chosen = [int(np.argmin(np.abs(plates.beta - beta))) for beta in few.beta]
    same = rft.Plates(few.beta, plates.alpha[:, chosen], plates.error[:, chosen], plates.depth)
    shallow, deep = sorted((few, same), key=lambda found: found.depth)
    growth, tilt = round(deep.depth / shallow.depth, 2), np.degrees(few.beta[-1])
    claims = []
    for sign, words in ((-1, "odd in β (up and down alike)"), (1, "even in β (lifts the cylinder)")):
        ratio = stress_part(deep, sign) / stress_part(shallow, sign)
        text = f"plates at ±{tilt:.3g}°, α_z|z| {words}: deep over shallow"
        allowed = round(TOLERANCE * growth, 2)
        rule = Agrees(growth, allowed, 2 * allowed)
        claims.append(claim(others, text, LI, f"{growth:.3g}, as the depths", ratio, rule))
    return claims


def stress_part(plates, sign):
    """Return half the difference (sign -1) or sum (1) of alpha_z |z| [Pa] of the last and the first plate."""
    value = 0.5 * (plates.alpha[1, -1] + sign * plates.alpha[1, 0]) * plates.depth
    error = 0.5 * np.hypot(plates.error[1, -1], plates.error[1, 0]) * plates.depth
    return Measured(float(value), float(error))


# ---- the figure ------------------------------------------------------------------------------------------------------


def draw(campaign, rows):
    """alpha by tilt; C_d and lift over buoyancy against depth, by RFT and as measured; half-cylinders."""
    figure, axes = canvas(2, 2, width=2 * figures.COLUMN_WIDTH, height=4.8)
    ((stress, halves), (drag, lift)) = axes
    if complete(campaign, rows):
        plates = plates_of(campaign, rows)
        rho_g = float(np.mean([unit_of(row) for _, row in rows.iterrows()]))
        draw_plates(stress, plates, rho_g)
        draw_halves(halves, campaign, plates)
        draw_depths(drag, lift, campaign.sweep("cylinder"), plates, rho_g)
    return figure


def draw_plates(axes, plates, rho_g):
    """alpha over rho g by tilt, with the linear interpolation and the Fourier fit."""
    beta = np.linspace(-np.pi / 2, np.pi / 2, 361)
    for k, label in enumerate((r"$\alpha_x$", r"$\alpha_z$")):
        style = look(k, label)
        points = [Measured(*pair) for pair in zip(plates.alpha[k] / rho_g, plates.error[k] / rho_g)]
        draw_points(axes, np.degrees(plates.beta), points, linestyle="", **style)
        for weights, dash in ((rft.linear, "-"), (rft.fourier, ":")):
            axes.plot(np.degrees(beta), weights(beta, plates) @ plates.alpha[k] / rho_g, dash, color=style["color"])
    axes.axhline(0, color=BLACK, linewidth=0.4)
    misfit = rft.misfit(plates)
    axes.set_title(rf"dotted: Fourier, $\chi^2/\nu$ = {misfit[0]:.0f}, {misfit[1]:.0f}", fontsize=7)
    axes.set(
        xlabel=r"tilt $\beta$ [°], > 0: leading face looks down", ylabel=r"$\alpha/\rho g$", xticks=range(-90, 91, 45)
    )
    axes.legend()


def draw_halves(axes, campaign, plates):
    """Measured drag and lift of the half-cylinders over D L P_0 beside RFT's."""
    rows, places = campaign.sweep("halves"), []
    for k, (side, (name, *_)) in enumerate(SIDES.items()):
        found = rows[rows["shape"].str.contains(name)] if len(rows) else rows
        if not len(found):
            continue
        row = found.iloc[0]
        by_rft = predicted(campaign, row, plates, rft.as_published)
        measured = quantity(found, "drag_coefficient"), quantity(found, "lift_over_buoyancy")
        to_pressure = row["buoyancy"] / (row["drag"] / row["drag_coefficient"])
        for component, (seen, told) in enumerate(zip(measured, by_rft)):
            factor = to_pressure if component else 1.0
            place = 2 * k + component
            label = ("measured", "RFT") if place == 0 else (None, None)
            draw_points(axes, [place - 0.1], [scaled(seen, factor)], **look(0, label[0]), linestyle="")
            draw_points(axes, [place + 0.1], [scaled(told, factor)], **look(1, label[1]), linestyle="")
            places.append((place, f"{('drag', 'lift')[component]},\nflat {side}"))
    axes.axhline(0, color=BLACK, linewidth=0.4)
    axes.set_xticks([place for place, _ in places], [label for _, label in places])
    axes.set(ylabel=r"half-cylinders: force over $P_0 H L$")
    axes.legend()


def draw_depths(drag, lift, rows, plates, rho_g):
    """C_d and the lift over the buoyancy of the cylinder against h~/D: lines by RFT with bands, points as measured."""
    if not len(rows):
        return
    row = rows.iloc[0]
    diameter = float(row["body_height"] * row["grain_diameter"])
    depths = np.linspace(2, 1.1 * max(rows["depth_over_d"]), 40)
    for k, (name, form) in enumerate(FORMS, start=1):
        curves = against_depth(plates, diameter, rho_g, depths * diameter, form)
        for axes, found in zip((drag, lift), curves):
            colour = look(k, "")["color"]
            axes.plot(depths, found[:, 0], color=colour, label=f"RFT, {name} form", linestyle=("-", "--")[k - 1])
            axes.fill_between(
                depths, found[:, 0] - found[:, 1], found[:, 0] + found[:, 1], color=colour, alpha=0.2, lw=0
            )
    for axes, name in ((drag, "drag_coefficient"), (lift, "lift_over_buoyancy")):
        points = [quantity(rows.iloc[[n]], name) for n in range(len(rows))]
        draw_points(axes, rows["depth_over_d"], points, linestyle="", **look(0, "measured"))
        axes.axvline(plates.depth / diameter, color=BLACK, linewidth=0.4, linestyle=":")
        axes.set(xlabel=r"$\tilde h/D$; dotted: depth of the plates")
    drag.set(ylabel=r"$C_d$", ylim=(0, 1.2 * drag.get_ylim()[1]))
    lift.set(ylabel="lift over buoyancy")
    lift.axhline(0, color=BLACK, linewidth=0.4)
    lift.legend(fontsize=6)
