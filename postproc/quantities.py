"""Every name that a run folder or a campaign's table holds, with its unit and its meaning: the one source of units.

Writers take units from here, and `as_markdown` makes the table of postproc/README.md.
"""

from typing import NamedTuple

SI, GRAIN = "SI", "grain"  # systems of units: that of the Magnus study, and d, rho, g of the wiggle study

# What a dimension is called in each system; disks have a mass per area, so that rho is in kg/m^2, spheres a mass per volume.
DIMENSIONS = {
    "length": ("m", "d"),
    "time": ("s", "sqrt(d/g)"),
    "velocity": ("m/s", "sqrt(g d)"),
    "spin": ("rad/s", "sqrt(g/d)"),
    "force": ("N", "rho g d^2"),
    "force on spheres": ("N", "rho g d^3"),
    "force squared": ("N^2", "rho^2 g^2 d^4"),
    "torque": ("N m", "rho g d^3"),
    "work": ("J", "rho g d^3"),
    "density": ("kg/m^2", "rho"),
    "temperature": ("m^2/s^2", "g d"),
    "stress": ("N/m", "rho g d"),
}


class Quantity(NamedTuple):
    """A name's `unit`: a key of DIMENSIONS, or a unit that all studies share ("-": a pure number, "": a word); `meaning`."""

    unit: str
    meaning: str


def of(unit, **meanings):
    """Return {name: Quantity} of names that share a unit."""
    return {name: Quantity(unit, meaning) for name, meaning in meanings.items()}


DISKS = {
    **of("-", id="YADE's id of the disk or sphere"),
    **of(
        "length",
        x="of the centre; in a periodic box within [0, period), but the driven body is never cut in two",
        y="of the centre; of spheres within the period as x",
        z="of the centre, spheres only, within the period as x",
        r="radius",
    ),
    **of(
        "velocity",
        vx="of the centre, half a time step before t",
        vy="of the centre, half a time step before t",
        vz="of the centre, spheres only, half a time step before t",
    ),
    **of(
        "spin",
        spin="angular velocity, counter-clockwise, half a time step before t; disks only",
        spin_x="angular velocity of a sphere, half a time step before t",
        spin_y="of a sphere",
        spin_z="of a sphere",
    ),
}

# Where a name stands -> {name: Quantity}. NAME_err, a standard error, has the unit of NAME and no line of its own.
# Names that several studies share; help takes a study's own part, see `study.observables`.
DRAG = "Magnus: mean force on the body along -V; lift study: along -x"
LIFT = "Magnus: mean force on the body along -omega x V; lift study: upwards"
TORQUE = "Magnus: mean torque on the body, counter-clockwise; drum: of the grains on the drum"
AREA_FRACTION = "mean area fraction; Magnus: between the walls, without the body; shear study: of the cell"

QUANTITIES = {
    "summary": {
        **of("1/s", particle_steps_per_second="grains times steps over the seconds spent in the loop"),
        **of(
            "-",
            steps="time steps from the start of the run",
            n_grains="free grains, without walls, base and driven body",
            dt_over_critical="time step over the critical one",
        ),
        **of(
            "stress",
            lid_pressure="wiggle: weight over width of the lid that was laid, also where the key is auto",
            pressure_at_body="wiggle: weight over width of bed and lid above the body's centre at rest",
        ),
        **of("d", travel="Magnus: how far the body goes in all, also where the key is auto"),
        **of(
            "s",
            wall_s="wall time of the run, interrupted parts included",
            core_seconds="processor time of all threads and programs of the run, interrupted parts included",
        ),
        **of("MB", peak_memory="largest memory that the program had in use"),
        **of("", shape="wiggle: the key"),
        **of(
            "length", amplitude="wiggle: the key A; a velocity with drive=velocity", y_final="rise of the body in all"
        ),
        **of(
            "time",
            period="wiggle: the key T",
            rise_until="when the last cycle of rise_rate ends: at arrest, else the run's last whole one",
        ),
        **of(
            "velocity",
            rise_rate="V_y, mean velocity upwards over the whole cycles from a tenth of the run (their middles) to arrest",
        ),
        **of(
            "length",
            fall_height="of the shape: from the lowest point with a vertical tangent to the top, the cavity model's l",
            intruder_height="extent of the body along y",
        ),
        **of("velocity", v0="Magnus: the key V0"),
        **of("-", spin_ratio="Magnus: the key Omega = omega_0 R/V0", mu="the key"),
        **of("force", drag=DRAG, lift=LIFT),
        **of("torque", torque=TORQUE),
        **of(
            "-",
            lift_to_drag="L/D, ratio of the means",
            contacts="mean number of contacts on the body",
            phi=AREA_FRACTION,
            slipping_share="part of the contacts on the body that slip",
            kappa="normal forces' part of the drag (Eq. 14)",
            front_share="part of the contacts within pi/2 of the velocity",
            contacts_std="standard deviation of the number of contacts in time",
            model_symmetric="L/D by Eq. 9 of the model",
            model_kappa="L/D by Eq. 15 of the model with the measured kappa",
            rise_resolved="1 if the run is long enough for the error of rise_rate, 0 if that error is likely too small",
            steady="1 if the averages' window was found steady, else 0",
        ),
        **of(
            "force",
            drag_std="standard deviation of the drag in time",
            lift_std="standard deviation of the lift in time",
        ),
        **of("d", steady_from="travel at which the averages begin", steady_travel="travel that the averages cover"),
        **of(
            "-",
            drag_coefficient="lift study: C_d, drag over P_0 D L, D the body's height and L its breadth",
            lift_over_buoyancy="lift study: lift, upwards, over the buoyancy",
            depth_over_d="lift study: effective depth of the axis over the body's height D",
            bulk_fraction="lift study: volume fraction of the bed at rest, away from base, surface and body",
            inertial_number="lift study: (U_0/D) d sqrt(rho_g/P_0)",
            peak_stress_over_pressure="lift study: largest normal stress by angle over P_0",
            rear_stress_over_pressure="lift study: mean normal stress within 30 degrees of the rear over P_0",
            tangential_share="lift study: sum of |tangential stress| over sum of normal stress",
            local_pressure_lift="lift study: lift over buoyancy that Eq. 4 makes of the normal stress by angle",
            drag_over_grip="lift study: drag over the friction that base and lid can bear; near 1 the bed slips as a whole",
            load_error="lift study: by how much base and body miss the weight of the bed at rest, over the weight",
        ),
        **of(
            "d",
            body_height="lift study: the body's extent along z, its D",
            effective_depth="lift study: of the axis, h~",
        ),
        **of(
            "-",
            stress_ratio="shear study: mu = tau/p, ratio of the means",
            flow_inertial_number="shear study: I = shear_rate d sqrt(rho/p) with the mean p",
            normal_stress_difference="shear study: (s_xx - s_yy)/p",
            coordination="shear study: contacts of a grain",
            kinetic_pressure_share="shear study: part of p by motion, not by contacts",
            kinetic_shear_share="shear study: part of tau by motion, not by contacts",
            profile_deviation="shear study: root mean square of v_x less the straight line, over the sides' velocity difference",
            steady_from_strain="shear study: strain at which the averages begin",
            mu_s="shear campaign: constant of mu(I)",
            mu_2="shear campaign: constant of mu(I)",
            i_0="shear campaign: constant of mu(I)",
            chi_squared="shear campaign: of the fit, over the degrees of freedom",
            measured="extremes: the case's number, a ratio or an error",
            expected="extremes: what the case's source says",
            bound="extremes: how far apart the two may be",
            error_over_bound="extremes: |measured - expected| over the bound; above 1 the answer is wrong",
        ),
        **of(
            "",
            outcome="extremes: right, guard, bound or wrong",
            source="extremes: where the expected number comes from",
            sentence="extremes: what was tried and found",
        ),
        **of("stress", shear_stress="shear study: tau = -s_xy", mean_pressure="shear study: p = (s_xx + s_yy)/2"),
        **of("spin", shear_rate="shear study: dv_x/dy, also where the key is auto"),
        **of("m", grain_diameter="lift study: d"),
        **of("Pa", pressure="lift study: P_0 = rho g times the effective depth"),
        **of("kg/m^3", bulk_density="lift study: rho, of the bed at rest"),
        **of(
            "-",
            thickness_over_diameter="drum: h/D, depth below the axis at which u = 0, the paper's h",
            layer_over_diameter="drum: depth below the free surface at which u = 0, over D",
            surface_over_diameter="drum: z of the free surface on the line through the axis, < 0 above the axis, over D",
            froude="drum: Omega^2 D/2g",
            packing_fraction="drum: solid fraction in the static part; of a continuum 0.825 times that of its granular phase",
            surface_speed="drum: largest u over Omega D",
            flow_down="drum: Q+, integral of fraction times u where u > 0, over Omega D^2",
            flow_up="drum: Q-, the same where u < 0",
            flow_balance="drum: (Q+ + Q-)/Q+, 0 in a steady state",
            rigid_deviation="drum: root mean square of u + Omega z in the static part over that of Omega z",
            dem_continuum_difference="drum: L2 norm of the difference of u(z) of grains and continuum over that of the grains",
            continuum_steps="drum: time steps of the continuum",
            continuum_steady="drum: 1 if the continuum's averages began when its flow was found steady, else 0",
            continuum_area_drift="drum: by how much the continuum's area of grains grew during the run, over that area",
            ill_posed_share="drum: part of the continuum's bed and of the time in which its equations were ill-posed",
        ),
        **of("s", continuum_core_seconds="drum: processor time of the continuum's steps"),
        **of(
            "degrees",
            surface_angle_deg="drum: angle of the free surface at the axis",
            centre_angle="drum: mean angle by which the grains' centre of mass is turned from below the axis",
            averaged_from="drum: turn at which the averages begin",
            averaged_turn="drum: turn that the averages cover",
        ),
        **of(
            "force",
            buoyancy="lift study: rho g times the body's volume",
            weight="lift study: of grains and lid as gravity acts on them",
            weight_on_base="lift study: mean force of the grains on the base, downwards",
            drag_on_base="lift study: mean force of the grains on the base along the body's motion",
        ),
    },
    "series": {
        **of("time", t="time; a row of Magnus is the mean over the block that ends then"),
        **of("length", x="centroid of the body, periods counted", y="centroid of the body"),
        **of("velocity", vx="of the body, half a time step before t", vy="of the body, half a time step before t"),
        **of("force", fx="of the grains on the body", fy="of the grains on the body"),
        **of("-", contacts="on the body", slipping="Magnus: contacts on the body that slip"),
        **of("work", work="wiggle, drum: done by the drive since the start"),
        **of("d", travel="Magnus: way of the body since the start"),
        **of("length", centre_x="drum: x of the grains' centre of mass from the axis"),
        **of(
            "degrees",
            turn="drum: how far it has turned since the start",
            centre_angle="drum: by how much the grains' centre of mass is turned from below the axis",
        ),
        **of("-", phi="area fraction; Magnus: between the walls, without the body; shear study: of the cell"),
        **of("force", normal_x="Magnus: normal forces on the body, along x"),
        **of(
            "force",
            fz="of the grains on the body, upwards",
            base_fx="lift study: of the grains on the base",
            base_fz="lift study: of the grains on the base",
        ),
        **of("length", lid_z="lift study: mean height of the lid's centres; 0 without a lid"),
        **of("torque", torque="Magnus, drum: on the body, counter-clockwise; of a drum the mean since the row before"),
        **of(
            "force squared", fx_var="Magnus: variance of fx within the block", fy_var="Magnus: of fy within the block"
        ),
        **of("-", contacts_var="Magnus: variance of the number of contacts within the block"),
        **of("-", strain="shear study: since the start", coordination="shear study: contacts of a grain"),
        **of(
            "stress",
            shear_stress="shear study: tau = -s_xy, mean over the steps since the row before, as all of the shear study's",
            mean_pressure="shear study: p = (s_xx + s_yy)/2, contacts and motion",
            contact_sxx="shear study: stress by contacts, > 0 in compression",
            contact_sxy="shear study: force along x, branch along y",
            contact_syx="shear study: force along y, branch along x",
            contact_syy="shear study: stress by contacts",
            kinetic_sxx="shear study: stress by motion against the mean flow",
            kinetic_sxy="shear study: the same",
            kinetic_syx="shear study: the same",
            kinetic_syy="shear study: the same",
        ),
        **of("spin", growth="shear study: dL/dt / L of the cell's height"),
        **of("length", height="shear study: L, the cell's height"),
    },
    "continuum": {
        **of("time", t="drum: time of a row of the continuum's history"),
        **of(
            "degrees",
            turn="drum: how far it has turned since the start",
            centre_angle="drum: by how much the bed's centre of mass is turned from below the axis",
        ),
        **of("velocity", speed="drum: root mean square of the bed's velocity"),
    },
    "flow": {
        **of("-", height="middles of the parts of the cell's height, over that height"),
        **of("velocity", vx="mean of v_x there, less the straight line of the mean flow"),
    },
    "frames/NNNN": {
        **of("time", t="attribute: time of the picture"),
        **of(
            "length",
            period="attribute: period of the box in x, which begins at 0; 0: it does not repeat; of spheres in x, y, z",
        ),
        **DISKS,
        **of("-", role="0 grain, 1 base, wall or lid (2, in exports, bead of the driven body)"),
    },
    "flow_frames/NNNN": {
        **of("time", t="attribute: time of the picture"),
        **of("length", x="drum: centres of the continuum's cells, the axis at 0, as of the grains", y="the same"),
        **of("-", area_fraction="solid fraction of the continuum, 0 in the wall"),
        **of("velocity", velocity="of the continuum and of the gas above, (x, y)"),
        **of("stress", pressure="of the continuum"),
    },
    "frames/NNNN/intruder": {
        **DISKS,
        **of("length", centre="(x, y) of the driven body's centroid, among spheres (x, y, z)"),
        **of("-", turn="among spheres: the body's orientation, a quaternion (w, x, y, z)"),
        **of("rad", angle="a single disk: how far it has turned since the start, up to whole turns"),
    },
    "frames/NNNN/contacts": {
        **of(
            "-",
            i="row of the first side in the frame's arrays; -1: the driven body",
            j="row of the second side; -1: the driven body; -2, -3, -4, -5, -6, -7: flat wall x_low, x_high,"
            " y_low, y_high, z_low, z_high",
            id_i="YADE's id of the first side, of a body its bead's",
            id_j="YADE's id of the second side, of a body its bead's; of a wall as j",
        ),
        **of(
            "force",
            fn="normal force: > 0 pushes the two apart, < 0 pulls them together (a damped contact that separates);"
            " of spheres in rho g d^3",
            ft="tangential force on i along z x n, n from i to j: > 0 drives i to the left of n; disks only",
        ),
        **of(
            "force on spheres",
            ft_x="tangential force on a sphere i",
            ft_y="tangential force on a sphere i",
            ft_z="tangential force on a sphere i",
        ),
        **of(
            "length",
            slip="tangential spring, way of i against j along z x n; disks only",
            slip_x="tangential spring, way of a sphere i against j",
            slip_y="of a sphere",
            slip_z="of a sphere",
            px="contact point, the middle of the overlap, next to i: in the periodic image in which i is drawn",
            py="contact point",
            pz="contact point of spheres",
        ),
    },
    "intruder": {
        **of(
            "length",
            beads="(x, y) of the beads about the centroid at the start",
            outline="(x, y) of the outline's corners about the centroid at the start, of a solid (x, z); a disk has none",
            bead_radius="radius of the beads, or of the disk",
            low="a solid among spheres: least (x, y, z) of the box around it; along an axis without end, of the run's box",
            high="a solid among spheres: greatest (x, y, z)",
            points="(x, y, z) of the corners of a mesh of a solid without an outline",
        ),
        **of(
            "-", quads="rows of points, the four corners of each face of that mesh, counter-clockwise seen from outside"
        ),
    },
    "fields/NAME": {
        **of(
            "length", x="middles of the bins from the window's origin, the body's centroid", y="the same", z="the same"
        ),
        **of(
            "-",
            samples="moments averaged, by phase",
            area_fraction="area of disks over area",
            solid_fraction="volume of spheres over volume",
            ill_posed="drum, continuum: share of the moments in which the equations were ill-posed there",
            part_of_the_bed="attribute, drum, continuum: solid fraction of the bed, area_fraction inside of it",
        ),
        **of("density", density="mass over area; of spheres over volume, kg/m^3"),
        **of("velocity", velocity="mean velocity (x, y), of spheres (x, y, z); nan where no grain was"),
        **of(
            "temperature",
            temperature="granular temperature, half the mean square of v - <v>, of spheres a third; nan where no grain was",
        ),
        **of(
            "stress",
            pressure="half the trace of the stress, contacts and motion; of spheres a third, N/m^2",
            contact_stress="stress by contacts, first index the force's, second the branch's; > 0 in compression; of"
            " spheres N/m^2",
            kinetic_stress="stress by motion about the mean velocity; of spheres N/m^2",
        ),
        **of(
            "",
            kernel="attribute: the averager's kernel",
            relative="attribute: velocities are relative to the body's",
            axes="attribute, of spheres: axes that the grid has points along; xz is averaged along y",
        ),
        **of("length", spacing="attribute: of the bins", width="attribute: w of the kernel"),
        **of(
            "-",
            cutoff="attribute: reach of the Gaussian over its width",
            every="attribute: time steps from moment to moment",
            phases="attribute: parts of the cycle; 1: all moments in one",
        ),
        **of("time", period="attribute: of the cycle", phaseStart="attribute: when the first cycle begins"),
    },
    "angular": {
        **of("d", first_travel="attribute: travel at which the averages begin"),
        **of("rad", theta="middles of the bins, angle from the velocity, counter-clockwise"),
        **of("force", normal="sum of the normal forces in the bin", tangential="of the tangential, counter-clockwise"),
        **of(
            "Pa",
            normal_stress="lift study: on the body, theta > 0 below its axis",
            tangential_stress="lift study: on the body, > 0 towards larger theta",
        ),
        **of(
            "-",
            contacts_by_angle="number of contacts in the bin",
            slipping_by_angle="of those that slip",
            mobilised="F_T/(mu F_N) of the sums: 1 where all slips, 1/(1 - 2p) where of |F_N| the share p pulls as contacts"
            " part; nan: no force",
        ),
    },
    "profile": {
        **of("length", z="middles of the slabs, heights above the base's centres"),
        **of("-", fraction="volume fraction of the grains in a slab at rest", fraction_after="at the end of the run"),
    },
    "depth/MODEL": {
        **of("length", z="drum: depths below the axis on the line normal to the surface, middles of squares of 1.2 d"),
        **of("velocity", u="velocity down the slope in a square; nan where nothing is"),
        **of("-", fraction="solid fraction in a square; of a continuum the volume fraction of its granular phase"),
    },
    "velocities": {
        **of("-", velocity="rounding study: middles of the bins of v_x and v_y over their root mean square"),
        **of(
            "-",
            longdouble="rounding study: density of the velocities in YADE with 64 bits",
            double="rounding study: density in GrainLoop, double precision",
            single="rounding study: density in GrainLoop, single precision",
        ),
    },
    "averages": {
        **of("m d^2/t_0^2", kinetic_energy="rounding study: of a disk, with 64 bits, double, single"),
        **of("m/t_0^2", pressure="rounding study: by motion and contacts, with 64 bits, double, single"),
        **of("-", kurtosis="rounding study: <v_x^4>/<v_x^2>^2, with 64 bits, double, single"),
    },
    "phase": {**of("T", phase="middle of the part of the cycle, t/T"), **of("velocity", vy="V_y in this part")},
    "table.csv": {
        **of("", run="name of the run's folder below runs/", sweeps="sweeps that want the run"),
        **of("", cpu="processor that ran it", code_version="of Graindrive"),
        **of("-", threads="threads that ran it"),
    },
}

# Of a run of both models: what `keep` of the drum study says of the continuum, beside the same of the grains.
OF_BOTH_MODELS = (
    "torque centre_angle surface_angle_deg thickness_over_diameter layer_over_diameter surface_over_diameter packing_fraction"
    " rigid_deviation flow_down flow_up flow_balance surface_speed"
)
QUANTITIES["summary"].update(
    {
        f"continuum_{name}": Quantity(QUANTITIES["summary"][name].unit, f"drum, model=both: {name} of the continuum")
        for name in OF_BOTH_MODELS.split()
    }
)

# Of the rounding study: the same of each kind of numbers.
OF_NUMBERS = dict(
    float128="YADE with 113 bits",
    longdouble="YADE with 64 bits",
    yade_double="YADE with 53 bits",
    double="GrainLoop, double precision",
    single="GrainLoop, single precision",
)
OF_EACH_NUMBER = {
    **of("d", drift="root mean square distance from 150 digits at the end of the comparison"),
    **of("1/t_0", lyapunov_rate="d ln(distance)/dt while it grows, chaotic scene"),
    **of("t_0", horizon="when the distance reaches 0.01 d, chaotic scene"),
    **of("-", drift_order="power of time by which the distance grows, regular scene"),
}
OF_AVERAGED_NUMBER = {
    **of("m d^2/t_0^2", kinetic_energy="mean kinetic energy of a disk"),
    **of("m/t_0^2", pressure="mean pressure by motion and contacts"),
    **of("-", kurtosis="mean of <v_x^4>/<v_x^2>^2"),
}
for number, words in OF_NUMBERS.items():
    told = {**OF_EACH_NUMBER, **(OF_AVERAGED_NUMBER if number in ("longdouble", "double", "single") else {})}
    QUANTITIES["summary"].update(
        {
            f"{name}_{number}": Quantity(known.unit, f"rounding, {words}: {known.meaning}")
            for name, known in told.items()
        }
    )
    QUANTITIES["series"][f"distance_{number}"] = Quantity("d", f"rounding, {words}: distance from 150 digits")
for number in ("double", "single"):
    text = f"rounding, {OF_NUMBERS[number]}: largest difference of the averages from 64 bits, in its standard errors"
    QUANTITIES["summary"][f"averages_apart_{number}"] = Quantity("-", text)


def place_of(group):
    """Return the key of QUANTITIES that a group of run.h5 stands under: frames/0001/contacts is frames/NNNN/contacts."""
    parts = group.split("/")
    if len(parts) > 1:
        parts[1] = {"frames": "NNNN", "flow_frames": "NNNN", "fields": "NAME", "depth": "MODEL"}.get(parts[0], parts[1])
    return "/".join(parts)


def unit_of(group, name, system):
    """Return the unit of a name in a group, in the system SI or GRAIN; None if it is a word or nobody knows it.

    `system` is "" for a study whose units are its own: of it the units that all studies share are known.
    """
    known = QUANTITIES.get(place_of(group), {})
    found = known.get(name) or known.get(name.removesuffix("_err"))
    if found is None or not found.unit:
        return None
    if found.unit in DIMENSIONS:
        return DIMENSIONS[found.unit][system == GRAIN] if system else None
    return found.unit


def meaning_of(group, name):
    """Return what a name in a group means; "" where nobody here knows."""
    known = QUANTITIES.get(place_of(group), {})
    found = known.get(name)
    return found.meaning if found else ""


def units(group, names, system):
    """Return {name: unit} of names, parted by spaces, in a group; KeyError for one that it does not have."""
    return {name: unit_of(group, name, system) for name in names.split() if QUANTITIES[place_of(group)][name]}


def labelled(group, arrays, system):
    """Return arrays of a group with their units, {name: (array, unit)}; what comes with its unit, or has none, stays."""

    def with_unit(name, content):
        part, _, last = f"{group}/{name}".rpartition("/")
        unit = None if isinstance(content, tuple) else unit_of(part, last, system)
        return content if unit is None else (content, unit)

    return {name: with_unit(name, content) for name, content in arrays.items()}


def of_spheres(contacts, system):
    """Return a frame's contacts between spheres with the unit of their normal force, which is another than that of disks."""
    if system and "fn" in contacts:
        return {**contacts, "fn": (contacts["fn"], DIMENSIONS["force on spheres"][system == GRAIN])}
    return contacts


def with_units(group, values, system, known=()):
    """Return plain values with NAME_unit behind each that has a unit; `known` maps names to units of their own."""
    known, told = dict(known), {}
    for name, value in values.items():
        told[name] = value
        unit = None if name.endswith("_err") else known.get(name, unit_of(group, name, system))
        if unit is not None:
            told[f"{name}_unit"] = unit
    return told


def as_markdown():
    """Return the table of all names as Markdown, in the order of QUANTITIES."""
    rows = ["| where | name | SI | d, ρ, g | meaning |", "|---|---|---|---|---|"]
    for group, names in QUANTITIES.items():
        for name, (unit, meaning) in names.items():
            si, grain = DIMENSIONS.get(unit, (unit, unit))
            rows.append(f"| `{group}` | `{name}` | {si} | {grain} | {meaning} |")
    return "\n".join(rows)
