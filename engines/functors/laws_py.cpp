/// The registry of contact laws as Python sees it: names, numbers, terms, critical time step.
#include "engines/functors/contact_law_functors.hpp"
#include "engines/laws/critical_step.hpp"
#include "engines/seam/bind.hpp"

namespace graindrive {

namespace {

namespace py = boost::python;

py::dict contact_laws()
{
	py::dict all;
	laws::Laws::for_each([&](const auto& law) {
		using Law = std::decay_t<decltype(law)>;
		py::dict numbers;
		Law::Given::quantities([&](const laws::Quantity& q, auto) {
			numbers[q.name] = py::make_tuple(q.symbol, q.unit, std::string(q.meaning) + " " + q.range.words);
		});
		all[law.name] = numbers;
	});
	return all;
}

py::dict law_functors()
{
	py::dict all;
	for_each_law_functor([&](auto kind) {
		using Functor = std::remove_cv_t<std::remove_pointer_t<decltype(kind)>>;
		all[Functor::class_name] = Functor::Law::name;
	});
	return all;
}

py::dict terms_of_law(const std::string& name, const py::dict& given, Real overlap, Real radius, Real mass)
{
	const auto terms = [&](const auto& kind) {
		using Law = std::decay_t<decltype(kind)>;
		typename Law::Given numbers;
		Law::Given::quantities([&](const laws::Quantity& q, auto member) { numbers.*member = py::extract<Real>(given[q.name]); });
		return Law::of(numbers, 0).terms(laws::Squeezed<Real>{ overlap, radius, mass });
	};
	const laws::Terms<Real> at = std::visit(terms, laws::law_named(name));
	py::dict all;
	all["elastic"] = at.elastic, all["energy"] = at.energy, all["stiffness"] = at.stiffness, all["dashpot"] = at.dashpot;
	all["tangential_stiffness"] = at.tangential_stiffness, all["tangential_dashpot"] = at.tangential_dashpot;
	return all;
}

}  // namespace

void bind_laws()
{
	py::def("contact_laws", contact_laws,
		"Every contact law: name -> its material constants, {name: (symbol, unit, rule)}. Names are those of GrainLoop.law and\n"
		"of GrainLoop's attributes.");
	py::def("law_functors", law_functors, "Our Law2_ functors: class -> name of the law.");
	py::def("terms_of_law", terms_of_law,
		(py::arg("law"), py::arg("given"), py::arg("overlap"), py::arg("effective_radius"), py::arg("effective_mass")),
		"The terms of a law at an overlap [m], for a reduced radius [m] and mass [kg]: elastic part of the normal force [N], "
		"its\n"
		"energy [J], stiffness [N/m], dashpot [N s/m], tangential_stiffness [N/m] and tangential_dashpot [N s/m]. `given` holds\n"
		"the constants that `contact_laws` lists. Raises ValueError for an unknown law or a number out of range.");
	py::def("critical_step", laws::critical_step, (py::arg("stiffness"), py::arg("dashpot"), py::arg("mass")),
		"Leapfrog's stability limit [s] of a damped oscillator: stiffness [N/m], dashpot [N s/m], mass [kg].");
}

}  // namespace graindrive
