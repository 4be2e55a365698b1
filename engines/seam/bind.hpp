/// Gives Python a class that Graindrive adds to YADE: keyword constructor, properties, `updateAttrs`, and no name that it does not have.
#pragma once
#include <boost/python/raw_function.hpp>

#include "engines/seam/registered.hpp"

namespace graindrive::seam {

namespace py = boost::python;

/// The names that may be assigned on objects of a Python class: `own`, then those of its bases.
py::list assignable_names(const py::object& cls, const py::list& own);

/// Raises AttributeError with the names that there are and the nearest to `key`.
[[noreturn]] void refuse_name(const std::string& class_name, const std::string& key, const py::list& names);

/// True if the object's class has a property of that name, or may have attributes of its own: Python derived it from `bound`.
bool may_have(const py::object& object, const PyTypeObject* bound, const std::string& key);

/// A getter and a setter of a property as Python's functions. All properties share their types, so that Boost.Python's templates are
/// compiled once, and not for each type of attribute of each class.
py::object getter(std::function<py::object(const py::object&)> get);
py::object setter(std::function<void(const py::object&, const py::object&)> set);

template <class Self>
[[noreturn]] void refuse_name(const std::string& key)
{
	py::list own;
	Self::attributes([&](const char* name, auto, const char*) { own.append(name); });
	PyTypeObject* bound = py::converter::registered<Self>::converters.get_class_object();
	const py::object cls(py::handle<>(py::borrowed(reinterpret_cast<PyObject*>(bound))));
	refuse_name(Self::class_name, key, assignable_names(cls, own));
}

/// `object.key = value`. Python would keep a name that no engine reads in the object's own dictionary, without a word.
template <class Self>
void assign(const py::object& object, const std::string& key, const py::object& value)
{
	if (!may_have(object, py::converter::registered<Self>::converters.get_class_object(), key)) refuse_name<Self>(key);
	if (PyObject_GenericSetAttr(object.ptr(), py::str(key).ptr(), value.ptr()) != 0) py::throw_error_already_set();
}

template <class Self>
void set_or_explain(Self& object, const std::string& key, const py::object& value)
{
	if (!object.set(key, value)) assign<Self>(py::object(py::ptr(&object)), key, value);  // dead, label, ...
}

/// An engine that Python may ask while it works has `take_turn`; its attributes are read and set between two steps.
template <class Self, class = void>
struct Waiting {
	explicit Waiting(const Self&) {}
};
template <class Self>
struct Waiting<Self, std::void_t<decltype(std::declval<const Self&>().take_turn())>> {
	explicit Waiting(const Self& object) : turn(object.take_turn()) {}
	decltype(std::declval<const Self&>().take_turn()) turn;
};

/// All values first, then one check, so that their order does not matter; if one is refused, none is taken.
template <class Self>
void update(Self& object, const py::dict& values)
{
	const Waiting<Self> waiting(object);
	const Snapshot before = object.snapshot();
	try {
		const py::list items = values.items();
		for (long i = 0; i < py::len(items); ++i) set_or_explain(object, py::extract<std::string>(items[i][0]), items[i][1]);
		object.callPostLoad();
	} catch (...) {
		before.restore();
		throw;
	}
}

/// `Class(a=1, b=2)`.
template <class Self>
py::object construct(const py::tuple& arguments, const py::dict& keywords)
{
	py::object made = arguments[0];
	if (py::len(arguments) > 1) {
		PyErr_SetString(PyExc_TypeError, (std::string(Self::class_name) + " takes keyword arguments only").c_str());
		py::throw_error_already_set();
	}
	made.attr("__init__")();
	update(static_cast<Self&>(py::extract<Self&>(made)), keywords);
	return {};
}

/// A property's new value is taken back if the object's check refuses it.
template <class Self, class Value>
void set_checked(Self& object, const char* name, Value& attribute, const py::object& value)
{
	const Waiting<Self> waiting(object);
	const auto take_back = keeper(attribute);
	from_python(attribute, Self::class_name, name, value);
	try {
		object.check();
		object.assigned(name);
	} catch (...) {
		take_back();
		throw;
	}
}

/// Registers a class with Boost.Python; more `.def`s may follow on what it returns.
template <class Self, class Base = yade::Engine>
auto bind(const char* documentation)
{
	py::class_<Self, boost::shared_ptr<Self>, py::bases<Base>, boost::noncopyable> cls(
		Self::class_name, documentation, py::no_init);
	cls.def("__init__", py::raw_function(&construct<Self>, 1));  // first: later overloads are tried before it
	cls.def(py::init<>());
	cls.def("updateAttrs", &update<Self>, "Set attributes from a dictionary: all of them, or none if one is refused.");
	cls.def("__setattr__", &assign<Self>);
	Self::attributes([&](const char* name, auto member, const char* doc) {
		const auto get = [member](const py::object& self) {
			const Self& object = py::extract<const Self&>(self);
			const Waiting<Self> waiting(object);
			return to_python(object.*member);
		};
		const auto set = [name, member](const py::object& self, const py::object& value) {
			Self& object = py::extract<Self&>(self);
			set_checked(object, name, object.*member, value);
		};
		cls.add_property(name, getter(get), setter(set), doc);
	});
	return cls;
}

}  // namespace graindrive::seam
