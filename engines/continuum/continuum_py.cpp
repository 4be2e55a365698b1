/// The continuum solver as Python sees it: made from words and arrays, advanced, looked at, kept and restored.
#include <boost/python/raw_function.hpp>

#include "engines/continuum/flow_words.hpp"
#include "engines/seam/numpy_array.hpp"
#include "engines/solids/Solid.hpp"

namespace graindrive {

namespace py = boost::python;
namespace np = boost::python::numpy;

namespace continuum {

namespace {

using solids::Described;

void take(const char*, double& number, const py::object& value) { number = py::extract<double>(value); }
void take(const char* name, std::string& word, const py::object& value)
{
	py::extract<std::string> text(value);
	if (!text.check()) throw std::invalid_argument(std::string(name) + " must be a word");
	word = text();
}

py::list flow_words()
{
	py::list all;
	FlowWords().list(
		[&](const char* name, const auto& value, const char* meaning) { all.append(py::make_tuple(name, value, meaning)); });
	return all;
}

FlowWords words_of(const py::dict& given)
{
	FlowWords words;
	py::list left = given.keys();
	std::string names;
	words.list([&](const char* name, auto& value, const char*) {
		names += names.empty() ? name : std::string(", ") + name;
		if (!given.has_key(name)) return;
		take(name, value, py::object(given[name]));
		left.remove(py::object(name));
	});
	if (py::len(left) > 0)
		throw std::invalid_argument("a flow does not know '" +
									std::string(py::extract<std::string>(py::str(py::object(left[0])))) + "'; it knows " + names);
	return words;
}

/// An array of shape (ny, nx), whatever its kind of numbers.
std::vector<double> rows(const char* name, const py::object& array_like, int nx, int ny)
{
	const np::ndarray given = np::from_object(array_like, np::dtype::get_builtin<double>(), np::ndarray::CARRAY_RO);
	if (given.get_nd() != 2 || given.shape(0) != ny || given.shape(1) != nx)
		throw std::invalid_argument(std::string(name) + " must have the shape (" + std::to_string(ny) + ", " +
									std::to_string(nx) + "), got " +
									std::string(py::extract<std::string>(py::str(given.attr("shape")))));
	const double* first = reinterpret_cast<const double*>(given.get_data());
	return { first, first + std::size_t(nx) * std::size_t(ny) };
}

/// nx by ny entries of a padded array.
np::ndarray window(const Grid& grid, const Values& values, int nx, int ny)
{
	std::vector<double> inner;
	inner.reserve(std::size_t(nx) * std::size_t(ny));
	for (int j = 0; j < ny; ++j) {
		const auto row = values.begin() + std::ptrdiff_t(grid.at(0, j));
		inner.insert(inner.end(), row, row + nx);
	}
	return seam::array_of(inner, nx);
}

np::ndarray in_cells(const TwoPhaseFlow& flow, const Values& values)
{
	return window(flow.grid(), values, flow.grid().nx, flow.grid().ny);
}

boost::shared_ptr<TwoPhaseFlow> flow_of(const py::object& fraction, const py::object& solid, const py::dict& given)
{
	const FlowWords words = words_of(given);
	const Grid grid = words.grid();
	const std::vector<double> filled = rows("fraction", fraction, grid.nx, grid.ny);
	const auto fraction_at = [&](double x, double y) {
		const int i = int(std::floor((x - grid.low_x) / grid.spacing)), j = int(std::floor((y - grid.low_y) / grid.spacing));
		return filled[std::size_t(j) * std::size_t(grid.nx) + std::size_t(i)];
	};
	if (solid.is_none())
		return boost::make_shared<TwoPhaseFlow>(grid, Domain(grid), words.all_fluids(), words.all_settings(), fraction_at);
	const Described& described = py::extract<const Described&>(solid);
	const geometry::Surface<3>& surface = *described.surface;
	const Distance distance = [&](double x, double y) { return surface.nearest({ x, y, 0 }).distance; };
	const double half_width = words.transition * grid.spacing;
	const Domain domain(grid, distance, half_width, words.wall);
	return boost::make_shared<TwoPhaseFlow>(
		grid, domain, words.all_fluids(), words.all_settings(), fraction_at, WallLayer(grid, domain, distance, half_width));
}

py::object construct(const py::tuple& arguments, const py::dict& keywords)
{
	if (py::len(arguments) != 3) throw std::invalid_argument("make a flow as TwoPhaseFlow(fraction, solid, cells_x=…, …)");
	const py::object self(arguments[0]), fraction(arguments[1]), solid(arguments[2]);
	return self.attr("__init__")(fraction, solid, keywords);
}

np::ndarray velocity(const TwoPhaseFlow& flow)
{
	const Grid& grid = flow.grid();
	const FaceValues& v = flow.state().velocity;
	std::vector<double> means;
	grid.for_cells([&](int, int, std::size_t c) {
		means.push_back(0.5 * (v.x[c] + v.x[c + 1]));
		means.push_back(0.5 * (v.y[c] + v.y[c + grid.stride()]));
	});
	return seam::array_of(means, 2).reshape(py::make_tuple(grid.ny, grid.nx, 2));
}

py::dict state(const TwoPhaseFlow& flow)
{
	py::dict all;
	FlowState now = flow.state();
	now.arrays([&](const char* name, const Values& values) { all[name] = seam::array_of(values); });
	all["time"] = now.time;
	all["steps"] = now.steps;
	return all;
}

void restore(TwoPhaseFlow& flow, const py::dict& given)
{
	FlowState next = flow.state();
	const auto entry = [&](const char* name) {
		if (!given.has_key(name)) throw std::invalid_argument(std::string("the state of a flow must have '") + name + "'");
		return py::object(given[name]);
	};
	next.arrays([&](const char* name, Values& values) {
		const np::ndarray array = np::from_object(entry(name), np::dtype::get_builtin<double>(), 1, 1, np::ndarray::CARRAY_RO);
		const double* first = reinterpret_cast<const double*>(array.get_data());
		values.assign(first, first + array.shape(0));
	});
	next.time = py::extract<double>(entry("time"));
	next.steps = py::extract<long>(entry("steps"));
	flow.restore(next);
}

py::dict report(const TwoPhaseFlow& flow)
{
	const StepReport& last = flow.report();
	py::dict all;
	all["pressure_iterations"] = last.pressure_iterations;
	all["potential_iterations"] = last.potential_iterations;
	all["viscous_iterations"] = last.viscous_iterations;
	all["courant"] = last.courant;
	return all;
}

py::dict part_times(const TwoPhaseFlow& flow)
{
	const PartTimes& times = flow.part_times();
	py::dict all;
	all["material"] = times.material;
	all["forces"] = times.forces;
	all["pressure"] = times.pressure;
	all["viscosity"] = times.viscosity;
	all["surface"] = times.surface;
	return all;
}

/// Without the interpreter's lock, so that other threads of Python go on.
void advance(TwoPhaseFlow& flow, long steps)
{
	if (steps < 0) throw std::invalid_argument("a flow must advance by 0 steps or more, got " + std::to_string(steps));
	struct Unlocked {
		PyThreadState* kept = PyEval_SaveThread();
		~Unlocked() { PyEval_RestoreThread(kept); }
	} unlocked;
	flow.advance(steps);
}

template <class Get>
py::object attribute(Get&& get)
{
	return py::make_function(
		get, py::default_call_policies(), boost::mpl::vector<decltype(get(std::declval<TwoPhaseFlow&>())), TwoPhaseFlow&>());
}

}  // namespace

}  // namespace continuum

void bind_continuum()
{
	using namespace continuum;
	py::class_<TwoPhaseFlow, boost::shared_ptr<TwoPhaseFlow>, boost::noncopyable>("TwoPhaseFlow",
		"Grains and gas as two incompressible fluids in a moving vessel, in two dimensions; graindrive.continuum.continuum\n"
		"runs them.\n\n"
		"TwoPhaseFlow(fraction, solid, cells_x=…, cells_y=…, spacing=…, …): `fraction` [-] of the dense fluid in the cells,\n"
		"shape (cells_y, cells_x); `solid`, a Surface whose section at z = 0 is the vessel, or None; flow_words() lists the\n"
		"keywords. Equations: Oba, Otsuki (2025), section II.3. Raises ValueError with the rule and the value for bad input.",
		py::no_init)
		.def("__init__", py::raw_function(&construct, 1))
		.def("__init__", py::make_constructor(&flow_of))
		.def("advance", &advance, (py::arg("steps")),
			"Advance by `steps` steps. Raises RuntimeError if the flow is too fast for the time step, or a solver fails.")
		.add_property("time", attribute([](TwoPhaseFlow& f) { return f.state().time; }))
		.add_property("steps", attribute([](TwoPhaseFlow& f) { return f.state().steps; }))
		.add_property("time_step", attribute([](TwoPhaseFlow& f) { return f.settings().time_step; }),
			&TwoPhaseFlow::set_time_step, "time step dt; an assigned value applies from the next step on")
		.add_property(
			"stable_step", &TwoPhaseFlow::stable_step, "the largest dt that explicit viscosity allows; inf with viscosity='full'")
		.add_property("fraction", attribute([](TwoPhaseFlow& f) { return in_cells(f, f.state().fraction); }),
			"alpha [-], (cells_y, cells_x)")
		.add_property(
			"pressure", attribute([](TwoPhaseFlow& f) { return in_cells(f, f.state().pressure); }), "p; its mean in the gas is 0")
		.add_property("potential", attribute([](TwoPhaseFlow& f) { return in_cells(f, f.state().potential); }), "S of SMAC")
		.add_property("velocity", &velocity, "mean over the faces of each cell, (cells_y, cells_x, 2)")
		.add_property("face_velocity_x",
			attribute([](TwoPhaseFlow& f) { return window(f.grid(), f.state().velocity.x, f.grid().nx + 1, f.grid().ny); }),
			"velocity on the faces normal to x, (cells_y, cells_x + 1)")
		.add_property("face_velocity_y",
			attribute([](TwoPhaseFlow& f) { return window(f.grid(), f.state().velocity.y, f.grid().nx, f.grid().ny + 1); }),
			"velocity on the faces normal to y, (cells_y + 1, cells_x)")
		.add_property("shear_rate", attribute([](TwoPhaseFlow& f) { return in_cells(f, f.present_shear_rate()); }), "(G:G/2)^1/2")
		.add_property(
			"shear_viscosity", attribute([](TwoPhaseFlow& f) { return in_cells(f, f.present_viscosity()); }), "of the mixture")
		.add_property("ill_posed", attribute([](TwoPhaseFlow& f) { return in_cells(f, f.ill_posed()); }),
			"1 in cells where the dense fluid's equations are ill-posed, else 0")
		.add_property("openness", attribute([](TwoPhaseFlow& f) { return in_cells(f, f.domain().cell_open); }),
			"chi: 1 in the fluid, 0 in the solid")
		.add_property("area", &TwoPhaseFlow::area, "of the dense fluid in the cells that are wholly open; it is conserved")
		.add_property("part_times", &part_times, "wall time [s] of each part of the step, summed over all steps")
		.add_property("report", &report, "iterations and residuals of the last step")
		.def("state", &state, "The complete state of the flow: {name: array or number}.")
		.def("restore", &restore, (py::arg("state")),
			"Continue from what `state` returned, with the same bits. Raises ValueError if it does not fit.");
	py::def("flow_words", &flow_words, "[(name, default, meaning)] of the keywords of TwoPhaseFlow.");
	py::def(
		"pressure_solvers",
		+[] {
			py::list all;
			for (const std::string& name : pressure_solvers()) all.append(name);
			return all;
		},
		"Names of the pressure solvers of this build.");
	py::def(
		"well_posed_range",
		+[](double mu_s, double mu_2, double I_0) {
			const laws::WellPosed range = laws::well_posed_range(laws::MuOfI({ mu_s, mu_2, I_0 }));
			return py::make_tuple(range.low, range.high);
		},
		(py::arg("static_friction"), py::arg("dynamic_friction"), py::arg("inertial_scale")),
		"Range of inertial numbers in which mu(I) is well-posed (Barker et al. 2015); low > high if there is none.");
}

}  // namespace graindrive
