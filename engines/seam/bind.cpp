/// Names of attributes: which there are, and which is nearest to a misspelt one.
#include "engines/seam/bind.hpp"

namespace graindrive::seam {

namespace {

bool is_special(const std::string& name) { return name.compare(0, 2, "__") == 0; }
bool is_property(const py::object& member) { return PyObject_TypeCheck(member.ptr(), &PyProperty_Type); }

std::string nearest(const std::string& key, const py::list& names)
{
	const py::object found = py::import("difflib").attr("get_close_matches")(key, names, 1, 0.0);
	return py::extract<std::string>(found[0]);
}

}  // namespace

py::object getter(std::function<py::object(const py::object&)> get)
{
	return py::make_function(std::move(get), py::default_call_policies(), boost::mpl::vector<py::object, const py::object&>());
}

py::object setter(std::function<void(const py::object&, const py::object&)> set)
{
	return py::make_function(
		std::move(set), py::default_call_policies(), boost::mpl::vector<void, const py::object&, const py::object&>());
}

py::list assignable_names(const py::object& cls, const py::list& own)
{
	const py::object all = py::import("builtins").attr("dir")(cls);
	py::list names(own);
	for (long i = 0; i < py::len(all); ++i) {
		const std::string name = py::extract<std::string>(all[i]);
		if (is_special(name) || py::extract<bool>(own.contains(name))()) continue;
		const py::object member = cls.attr(name.c_str());
		if (is_property(member) && !py::object(member.attr("fset")).is_none()) names.append(name);
	}
	return names;
}

void refuse_name(const std::string& class_name, const std::string& key, const py::list& names)
{
	const std::string all = py::extract<std::string>(py::str(", ").join(names));
	const std::string message =
		class_name + " has no attribute '" + key + "'; did you mean '" + nearest(key, names) + "'? Its attributes are " + all;
	PyErr_SetString(PyExc_AttributeError, message.c_str());
	py::throw_error_already_set();
	throw std::logic_error("unreachable");
}

bool may_have(const py::object& object, const PyTypeObject* bound, const std::string& key)
{
	if (is_special(key) || Py_TYPE(object.ptr()) != bound) return true;
	const py::object cls(py::handle<>(py::borrowed(reinterpret_cast<PyObject*>(Py_TYPE(object.ptr())))));
	return PyObject_HasAttrString(cls.ptr(), key.c_str()) && is_property(cls.attr(key.c_str()));
}

}  // namespace graindrive::seam
