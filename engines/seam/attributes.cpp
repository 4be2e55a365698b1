/// Compiles what is done with values of attributes, once for each type.
#include "engines/seam/attributes.hpp"

namespace graindrive::seam {

void refuse_type(const char* class_name, const std::string& key, const py::object& value)
{
	const std::string got = py::extract<std::string>(py::str(value));
	PyErr_SetString(PyExc_TypeError, (std::string(class_name) + "." + key + " cannot be made from " + got).c_str());
	py::throw_error_already_set();
	throw std::logic_error("unreachable");
}

GRAINDRIVE_ATTRIBUTE_TYPES()

}  // namespace graindrive::seam
