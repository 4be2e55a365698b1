/// The Python module `graindrive._engines`: proves YADE's layout, then registers every engine, functor and function.
#include <boost/python.hpp>

#include "engines/seam/layout.hpp"

namespace graindrive {
void bind_bulk();
void bind_clumps();
void bind_shapes();
void bind_packing();
void bind_solids();
void bind_functors();
void bind_drives();
void bind_measures();
void bind_fields();
void bind_loop();
void bind_continuum();
}  // namespace graindrive

static void register_everything()
{
	boost::python::docstring_options docs(true, true, false);
	graindrive::seam::bind_layout();
	graindrive::seam::prove_layout({});
	graindrive::bind_bulk();
	graindrive::bind_clumps();
	graindrive::bind_shapes();
	graindrive::bind_packing();
	graindrive::bind_solids();
	graindrive::bind_functors();
	graindrive::bind_drives();
	graindrive::bind_measures();
	graindrive::bind_fields();
	graindrive::bind_loop();
	graindrive::bind_continuum();
}

/// BOOST_PYTHON_MODULE would return the half-made module beside the exception, which Python reports as a SystemError without its text.
extern "C" __attribute__((visibility("default"))) PyObject* PyInit__engines()
{
	static PyModuleDef definition = { PyModuleDef_HEAD_INIT, "_engines", nullptr, -1, nullptr, nullptr, nullptr, nullptr,
		nullptr };
	PyObject* module = boost::python::detail::init_module(definition, register_everything);
	if (!PyErr_Occurred()) return module;
	Py_XDECREF(module);
	return nullptr;
}
