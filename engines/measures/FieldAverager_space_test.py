"""FieldAverager in three dimensions on YADE's loop: which bodies count, axes and names, a bed at rest, windows, bad input."""

import math

import numpy as np
import pytest
from disks import disk, engine, engines, hertz, new_scene, run
from spheres import clump, frozen, loop, sphere
from yade import O, utils

LENGTH = 4.0  # edge of the periodic box
SMOOTH = dict(kernel="gaussian", width=0.5, cutoff=5)  # on points w/2.5 apart sums differ from integrals by exp(-25)
FIELDS = "solidFraction density velocity temperature contactStress kineticStress totalStress pressure".split()
CUBE = dict(low=(-2, -2, -2), high=(2, 2, 2), spacing=0.2)


@pytest.fixture(autouse=True)
def scene():
    new_scene(dt=1e-4)
    yield
    O.reset()


def averager(label="fields", **options):
    return engines.FieldAverager(label=label, **{"dimensions": 3, **SMOOTH, **CUBE, **options})


def crowd(*measures, friction=0.4):
    """A periodic crowd of 64 overlapping spheres that move and spin; returns the ids of the free ones."""
    new_scene(dt=1e-4, period=(LENGTH,) * 3)
    rng = np.random.default_rng(2)
    free = []
    for place in np.argwhere(np.ones((4, 4, 4))):
        velocity, spin, radius = rng.uniform(-1, 1, 3), rng.uniform(-2, 2, 3), rng.uniform(0.505, 0.53)
        blocked = "xyzXYZ" if place[2] == 0 else "z" if tuple(place) == (1, 1, 1) else ""
        body = sphere(place + 0.5, radius, velocity, spin, density=rng.uniform(1, 2), blocked=blocked)
        free += [body] if not blocked else []
    loop(hertz(gamma_n=100, gamma_t=100), friction=friction, before_newton=measures)
    return free


def fields_of(measure):
    return {name: getattr(measure, name) for name in FIELDS}


# ---- what is a grain, and what is it called ----


@pytest.mark.parametrize("along", ["", "x", "y", "z"])
def test_the_window_holds_the_volume_and_the_mass_of_its_free_spheres(along):
    fields = averager(averageAlong=along)
    free = crowd(fields)
    O.bodies[free[5]].state.pos += (3 * LENGTH, -2 * LENGTH, LENGTH)  # another image of the same place
    clump([(0, 0, 0), (0.1, 0, 0)], at=(1, 1, 3))
    run(1)
    assert len(free) == 64 - 16 - 1
    states = [O.bodies[i] for i in free]
    volume, mass = sum(4 / 3 * math.pi * b.shape.radius**3 for b in states), sum(b.state.mass for b in states)
    bin_volume = 0.2**3 if not along else 0.2**2 * LENGTH
    assert fields.solidFraction.sum() * bin_volume == pytest.approx(volume, rel=1e-9)
    assert fields.density.sum() * bin_volume == pytest.approx(mass, rel=1e-9)


def test_a_free_sphere_is_left_out_of_its_own_fields():
    ids = [sphere((0, 0, 0)), sphere((0, 2, 0))]
    loop(before_newton=[averager(body=ids[0], high=(2, 4, 2)), averager("fixed", high=(2, 4, 2))])
    run(1)
    own, fixed = (engine(name).solidFraction.sum() * 0.2**3 for name in ("fields", "fixed"))
    # The outer sphere is 2 = 4 w from the window's sides: a part erfc(4) is beyond each.
    assert own == pytest.approx(math.pi / 6, rel=1e-7) and fixed == pytest.approx(2 * math.pi / 6, rel=1e-7)


@pytest.mark.parametrize("other", ["grain", "frozen", "wall"])
@pytest.mark.parametrize("along", ["", "y"])
def test_a_bound_grain_counts_to_the_contact_point(other, along):
    overlap, axis = 0.02, np.array([0.0, 0.0, 1.0]) if other == "wall" else np.array([0.48, 0.6, 0.64])
    body = sphere((0, 0, 0))
    if other == "wall":
        O.bodies.append(utils.wall((0, 0, -0.5 + overlap), 2))
    else:
        (sphere if other == "grain" else frozen)(axis * (1 - overlap))
    loop(before_newton=[averager(averageAlong=along, low=(-3, -3, -3), high=(3, 3, 3))])
    run(1)
    length = {"grain": 1 - overlap, "frozen": 0.5 - overlap / 2, "wall": 0.5 - overlap}[other]
    force = np.linalg.norm(O.forces.f(body))
    assert force > 0
    stress = engine("fields").contactStress[0]
    total = stress.reshape(-1, 3, 3).sum(axis=0) * (0.2**2 * 6 if along else 0.2**3)
    np.testing.assert_allclose(total, force * length * np.outer(axis, axis), rtol=0, atol=1e-9 * force)


def test_shapes_axes_and_names():
    sphere((0, 0, 0))
    window = dict(low=(-1, -0.8, -0.6), high=(1, 0.8, 0.6), spacing=0.2, width=1, cutoff=2, phases=2)
    shapes = {"": (6, 8, 10), "x": (6, 8), "y": (6, 10), "z": (8, 10)}
    measures = {along: averager(along or "whole", averageAlong=along, **window) for along in shapes}
    loop(before_newton=measures.values())
    run(1)
    for along, shape in shapes.items():
        fields = measures[along]
        assert fields.axes == "xyz".replace(along, "") and fields.samples.tolist() == [1, 0]
        for axis in fields.axes:
            edge = {"x": 1, "y": 0.8, "z": 0.6}[axis]
            np.testing.assert_allclose(getattr(fields, axis), np.arange(-edge + 0.1, edge, 0.2))
        for name in FIELDS:
            array = getattr(fields, name)
            rank = 2 if "Stress" in name else name == "velocity"
            assert array.shape == (2, *shape, *(3,) * rank), name
            assert np.isnan(array[1]).all() and not np.isnan(array[0]).any()
        if along:
            with pytest.raises(ValueError, match=f"no points along {along}; its axes are {fields.axes}"):
                getattr(fields, along)
        with pytest.raises(ValueError, match="areaFraction needs dimensions=2; in three dimensions read solidFraction"):
            fields.areaFraction
    plane = engines.FieldAverager()
    assert plane.axes == "xy" and plane.areaFraction.shape == (1, 60, 60)
    with pytest.raises(ValueError, match="solidFraction needs dimensions=3; in two dimensions read areaFraction, got"):
        plane.solidFraction
    with pytest.raises(ValueError, match="no points along z"):
        plane.z


def test_the_fields_lie_where_the_sphere_is_and_move_as_it_does():
    at, velocity = (0.5, -0.7, 0.3), (3, -2, 1)
    sphere(at, velocity=velocity, spin=(5, 6, 7))
    loop(before_newton=[averager(spacing=0.1), averager("row", averageAlong="y", spacing=0.1)])
    run(1)
    full, row = engine("fields"), engine("row")
    for fields, axes in ((full, "zyx"), (row, "zx")):
        phi = fields.solidFraction[0]
        for number, axis in enumerate(axes):
            across = phi.sum(axis=tuple(k for k in range(phi.ndim) if k != number))
            assert (across * getattr(fields, axis)).sum() / phi.sum() == pytest.approx(at["xyz".index(axis)], abs=1e-3)
        np.testing.assert_allclose(fields.velocity[phi[None] > 0], [velocity] * (phi > 0).sum(), rtol=1e-14)


# ---- many spheres ----


def test_averaged_along_an_axis_is_the_mean_of_the_slices():
    measures = [averager("whole"), *(averager(axis, averageAlong=axis) for axis in "xyz")]
    crowd(*measures)
    run(3)
    phi, stress, velocity = measures[0].solidFraction, measures[0].contactStress, measures[0].velocity
    for number, fields in zip((3, 2, 1), measures[1:]):
        np.testing.assert_allclose(fields.solidFraction, phi.mean(axis=number), rtol=1e-9)
        np.testing.assert_allclose(fields.contactStress, stress.mean(axis=number), atol=1e-9 * stress.max())
        flow = (phi[..., None] * velocity).mean(axis=number)
        np.testing.assert_allclose(fields.solidFraction[..., None] * fields.velocity, flow, atol=1e-9)


def test_pressure_and_total_are_made_of_both_stresses():
    fields = averager(averageAlong="y")
    crowd(fields)
    run(3)
    both = fields.contactStress + fields.kineticStress
    np.testing.assert_array_equal(fields.totalStress, both)
    np.testing.assert_allclose(fields.pressure, np.trace(both, axis1=-2, axis2=-1) / 3, rtol=1e-15)
    assert fields.pressure.min() > 0
    np.testing.assert_array_equal(fields.kineticStress, np.swapaxes(fields.kineticStress, -1, -2))
    # tr sigma_k = 3 rho T holds if all grains have one density and temperature. Here densities differ by up to a factor of two.
    ratio = np.trace(fields.kineticStress, axis1=-2, axis2=-1) / (3 * fields.density * fields.temperature)
    assert 0.5 < ratio.min() and ratio.max() < 2


@pytest.mark.parametrize("kernel", ["gaussian", "sphere"])
def test_a_window_over_the_periodic_sides_sees_the_other_sides(kernel):
    def seen(shift):
        new_scene(period=(8, 8, 8))
        for x, y, z in ((0.3, 0.2, 0.1), (1.2, 0.3, 0.2), (0.8, 1.1, -0.5), (-1.1, -0.7, 0.4), (-0.6, -0.7, -0.4)):
            sphere([(p + shift) % 8 for p in (x, y, z)], velocity=(x, y, z))
        loop(before_newton=[averager(kernel=kernel, origin=(shift,) * 3, cutoff=4.03)])  # no point exactly at the cut
        run(1)
        return fields_of(engine("fields"))

    inside, across = seen(4.0), seen(8.0)
    assert inside["contactStress"].max() > 0
    for name in FIELDS:
        np.testing.assert_allclose(across[name], inside[name], rtol=0, atol=1e-11 * np.nanmax(np.abs(inside[name])))


def test_the_window_goes_with_its_body_and_its_velocity():
    body = frozen((1, 2, 3), velocity=(3, -1, 2))
    sphere((2.5, 2.25, 3.5), velocity=(3, 1, 2))
    options = dict(body=body, kernel="sphere", width=1)
    loop(before_newton=[averager(relative=True, **options), averager("still", **options)])
    run(200)
    moving, still = engine("fields"), engine("still")
    place = 0, *(int(np.argmin(abs(axis - at))) for axis, at in ((moving.z, 0.5), (moving.y, 0.25), (moving.x, 1.5)))
    np.testing.assert_allclose(moving.velocity[place], (0, 2, 0), atol=1e-12)
    np.testing.assert_allclose(still.velocity[place], (3, 1, 2), atol=1e-12)
    assert moving.samples.tolist() == [200] and moving.solidFraction[place] == pytest.approx(1 / 8, rel=1e-12)


def test_a_settled_bed_carries_the_weight_above():
    """Spheres at rest on a base: sigma_zz is the weight above per area at every height, however it is averaged."""
    length, width, levels = 6, 4, 12
    new_scene(dt=4e-3, period=(length, width, 100))
    rng = np.random.default_rng(8)
    sites = [(x + 0.5, y + 0.5) for x in range(length) for y in range(width)]
    for x, y in sites:
        frozen((x, y, 0))
    grains = [
        sphere((x + rng.uniform(-0.1, 0.1), y + rng.uniform(-0.1, 0.1), 0.97 * z), rng.uniform(0.45, 0.495))
        for z in range(1, levels + 1)
        for x, y in sites
    ]
    options = dict(low=(0, 0, 3.5), high=(length, width, 8), spacing=0.5, kernel="gaussian", width=1, cutoff=3)
    measures = [averager("row", averageAlong="y", **options), averager("whole", **options)]
    measures.append(averager("spheres", **{**options, "kernel": "sphere"}, averageAlong="x"))
    for measure in measures:
        measure.dead = True
    law = hertz(k_n=3e3, k_t=3e3, gamma_n=20, gamma_t=20)
    loop(law, friction=0.3, gravity=(0, 0, -1), damping=0.4, before_newton=measures)
    run(8000)
    for measure in measures:
        measure.dead = False
    run(1)
    weight, height = np.array([(O.bodies[i].state.mass, O.bodies[i].state.pos[2]) for i in grains]).T
    speed = max(O.bodies[i].state.vel.norm() for i in grains)
    assert speed < 1e-2

    def above(z, share_above):
        return (weight * [share_above(h - z) for h in height]).sum() / (length * width)

    # Averaged over a plane, exp(-r^2/w^2) and a sphere become kernels of the height only, which are integrated from below.
    gaussian = [above(z, lambda h: 0.5 + 0.5 * math.erf(h)) for z in measures[0].z]
    cap = [above(z, lambda h: (2 + 3 * np.clip(h, -1, 1) - np.clip(h, -1, 1) ** 3) / 4) for z in measures[0].z]
    row, full, spheres = (m.contactStress[0, ..., 2, 2] for m in measures)
    assert gaussian[0] > 2 * gaussian[-1]
    # The cut at 3 w leaves exp(-9). On points half a radius apart a contact's share of a sphere is off by some tenth,
    # either way, and about a hundred contacts meet a row.
    np.testing.assert_allclose(row.mean(axis=1), gaussian, rtol=5e-4)
    np.testing.assert_allclose(full.mean(axis=(1, 2)), gaussian, rtol=5e-4)
    np.testing.assert_allclose(spheres.mean(axis=1), cap, rtol=0.01)
    assert 0.5 < measures[0].solidFraction[0, :6].mean() < 0.65
    np.testing.assert_allclose(row, full.mean(axis=1), rtol=1e-3)  # slices half a width apart; the cut leaves e^-9


# ---- save, load, bad input ----


def test_save_and_load_go_on_averaging(tmp_path):
    crowd(averager(averageAlong="y", phases=2, period=1e-3))
    run(8)
    before = fields_of(engine("fields"))
    O.save(str(tmp_path / "scene.yade.gz"), quiet=True)
    O.load(str(tmp_path / "scene.yade.gz"), quiet=True)
    fields = engine("fields")
    assert fields.samples.tolist() == [5, 3] and fields.averageAlong == "y" and fields.dimensions == 3
    for name in FIELDS:
        np.testing.assert_array_equal(getattr(fields, name), before[name])
    run(2)
    assert fields.samples.tolist() == [5, 5]


@pytest.mark.parametrize(
    "change", [{"averageAlong": "z"}, {"averageAlong": "y"}, {"high": (2, 2, 2.2)}, {"dimensions": 2}]
)
def test_changing_what_decides_the_fields_begins_anew(change):
    sphere((0, 0, 0))
    fields = averager()
    loop(before_newton=[fields])
    run(2)
    for name, value in change.items():
        setattr(fields, name, value)
    assert fields.samples.tolist() == [0] and np.isnan(fields.density).all()
    run(2)
    assert fields.samples.tolist() == [2] and not np.isnan(fields.density).any()


@pytest.mark.parametrize(
    "wrong, words",
    [
        ({"dimensions": 1}, "FieldAverager.dimensions must be 2 or 3, got 1"),
        ({"kernel": "diskBin"}, "take 'gaussian' or 'sphere' for spheres; FieldAverager.dimensions, got 3"),
        ({"averageAlong": "w"}, "averageAlong must be 'x', 'y', 'z' or '' for no axis, got w"),
        ({"averageAlong": "y", "dimensions": 2}, "averageAlong needs dimensions=3; FieldAverager.dimensions, got 2"),
        ({"high": (2, 2, -2)}, "high must exceed low, by up to 1e6 spacings, in x, y and z"),
        ({"high": (2, 2, 2.1)}, "whole number of bins in x, y and z"),
        ({"high": (2, -2, 2), "averageAlong": "y"}, "high must exceed low along averageAlong; high - low, got 0"),
        ({"width": 0.17, "kernel": "sphere"}, "at least 0.87 spacing"),
        ({"width": 0.14, "kernel": "sphere", "averageAlong": "y"}, "at least 0.71 spacing"),
        ({"spacing": 0.01}, "at most 2e8 numbers"),
    ],
)
def test_bad_values_are_refused_with_the_rule(wrong, words):
    with pytest.raises(ValueError, match=words.replace("(", r"\(").replace(".", r"\.")):
        averager(**wrong)


def test_a_window_averaged_over_needs_no_whole_bins_along_its_axis():
    assert averager(averageAlong="y", high=(2, 2.13, 2)).solidFraction.shape == (1, 20, 20)


def test_fields_of_the_plane_refuse_spheres_at_several_heights():
    sphere((0, 0, 0))
    sphere((1, 0, 0.7))
    loop(before_newton=[engines.FieldAverager()])
    with pytest.raises(RuntimeError, match="grains 0 and 1 differ in z by more than a radius; set dimensions=3"):
        O.step()


def test_fields_of_space_refuse_a_scene_of_disks():
    disk(0, 0)
    loop(before_newton=[averager()])
    with pytest.raises(
        RuntimeError, match="every grain of this scene is blocked along z or about x or y; set dimensions=2"
    ):
        O.step()
