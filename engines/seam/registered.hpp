/// What every class that Graindrive adds to YADE shares: name, attributes for Python and archives, and checks of what is set.
///
/// A class derives from `Registered<Self, Base>` and says once what it has:
///
///   class Kicker : public Registered<Kicker> {
///   public:
///       static constexpr const char* class_name = "Kicker";
///       template <class Visit> static void attributes(Visit&& visit) { visit("impulse", &Kicker::impulse, "impulse on the body [N s]"); }
///       void check() const { require(impulse >= 0, "Kicker.impulse must not be negative", impulse); }
///       void action() override;
///       Real impulse = 0;
///   };
///
/// From that come the keyword constructor, Python properties, `dict()`, `updateAttrs` and `O.save`/`O.load`.
#pragma once
#include <boost/archive/binary_iarchive.hpp>
#include <boost/archive/binary_oarchive.hpp>
#include <boost/archive/xml_iarchive.hpp>
#include <boost/archive/xml_oarchive.hpp>
#include <boost/python/raw_function.hpp>
#include <boost/serialization/export.hpp>
#include <boost/serialization/nvp.hpp>
#include <boost/serialization/string.hpp>
#include <boost/serialization/vector.hpp>
#include <boost/serialization/void_cast.hpp>
#include <sstream>
#include <stdexcept>

#include "engines/seam/yade.hpp"

namespace graindrive {

/// The house's answer to a bad value: the rule and what was given.
template <class T>
void require(bool holds, const char* rule, const T& got)
{
	if (holds) return;
	std::ostringstream message;
	message << rule << ", got " << got;
	throw std::invalid_argument(message.str());
}

namespace seam {

/// The attributes of YADE's bases that survive in an archive.
template <class Archive>
void serialize_base(Archive& archive, yade::Engine& engine)
{
	archive& boost::serialization::make_nvp("dead", engine.dead);
	archive& boost::serialization::make_nvp("ompThreads", engine.ompThreads);
	archive& boost::serialization::make_nvp("label", engine.label);
}
template <class Archive>
void serialize_base(Archive& archive, yade::Functor& functor)
{
	archive& boost::serialization::make_nvp("label", functor.label);
}
template <class Archive>
void serialize_base(Archive& archive, yade::FrictPhys& phys)
{
	archive& boost::serialization::make_nvp("kn", phys.kn);
	archive& boost::serialization::make_nvp("normalForce", phys.normalForce);
	archive& boost::serialization::make_nvp("ks", phys.ks);
	archive& boost::serialization::make_nvp("shearForce", phys.shearForce);
	archive& boost::serialization::make_nvp("tangensOfFrictionAngle", phys.tangensOfFrictionAngle);
}

inline const char* base_name(const yade::Engine*) { return "Engine"; }
inline const char* base_name(const yade::LawFunctor*) { return "LawFunctor"; }
inline const char* base_name(const yade::IPhysFunctor*) { return "IPhysFunctor"; }
inline const char* base_name(const yade::FrictPhys*) { return "FrictPhys"; }

/// An engine whose attributes a checkpoint keeps, to the last bit.
class Stateful {
public:
	virtual ~Stateful() = default;
	/// False if the engine reads no bodies but those that it names, and changes no others. Where none of O.engines reads them all,
	/// GrainLoop need not write every grain into YADE's bodies at every step.
	virtual bool reads_all_bodies() const { return true; }
	virtual std::string attribute_names() const = 0;
	virtual std::string packed() const = 0;
	virtual void unpack(const std::string& bytes) = 0;
};

/// Engines have that, functors and what they make have not: they are too many, and YADE's own archives keep them.
template <class Self, class Base>
class Kept : public Base {
};

template <class Self>
class Kept<Self, yade::Engine> : public yade::Engine, public Stateful {
	static constexpr auto plain = boost::archive::no_header | boost::archive::no_codecvt;

public:
	std::string attribute_names() const override
	{
		std::string names;
		Self::attributes([&](const char* name, auto, const char*) { names += std::string(names.empty() ? "" : ", ") + name; });
		return names;
	}
	std::string packed() const override
	{
		std::ostringstream bytes;
		boost::archive::binary_oarchive archive(bytes, plain);
		const_cast<Self&>(static_cast<const Self&>(*this)).serialize(archive, 0);  // boost's serialize reads and writes alike
		return bytes.str();
	}
	void unpack(const std::string& bytes) override
	{
		std::istringstream from(bytes);
		boost::archive::binary_iarchive archive(from, plain);
		static_cast<Self&>(*this).serialize(archive, 0);
	}
};

}  // namespace seam

template <class Self, class Base = yade::Engine>
class Registered : public seam::Kept<Self, Base> {
public:
	std::string getClassName() const override { return Self::class_name; }
	int getBaseClassNumber() const override { return 1; }
	std::string getBaseClassName(unsigned int i = 0) const override
	{
		return i == 0 ? seam::base_name(static_cast<const Base*>(nullptr)) : "";
	}
	void pyRegisterClass(boost::python::object) override {}  // `bind` has done it
	void callPostLoad() override { self().check(); }

	boost::python::dict pyDict() const override
	{
		boost::python::dict all = Base::pyDict();
		Self::attributes([&](const char* name, auto member, const char*) { all[name] = boost::python::object(self().*member); });
		return all;
	}

	void pySetAttr(const std::string& key, const boost::python::object& value) override
	{
		if (set(key, value))
			self().assigned(key);
		else
			Base::pySetAttr(key, value);
	}

	/// Sets one of our own attributes; false if there is none of that name.
	bool set(const std::string& key, const boost::python::object& value)
	{
		bool found = false;
		Self::attributes([&](const char* name, auto member, const char*) {
			if (key != name) return;
			found = true;
			using Value = std::decay_t<decltype(self().*member)>;
			boost::python::extract<Value> extracted(value);
			if (!extracted.check()) {
				const std::string got = boost::python::extract<std::string>(boost::python::str(value));
				PyErr_SetString(
					PyExc_TypeError, (std::string(Self::class_name) + "." + key + " cannot be made from " + got).c_str());
				boost::python::throw_error_already_set();
			}
			self().*member = extracted();
		});
		return found;
	}

	void check() const {}
	/// Hears that Python has set the attribute of that name. What it throws takes the new value back.
	void assigned(const std::string&) {}

	template <class Archive>
	void serialize(Archive& archive, unsigned)
	{
		boost::serialization::void_cast_register<Self, Base>();
		seam::serialize_base(archive, static_cast<Base&>(*this));
		Self::attributes(
			[&](const char* name, auto member, const char*) { archive& boost::serialization::make_nvp(name, self().*member); });
		if constexpr (Archive::is_loading::value) self().callPostLoad();
	}

private:
	Self& self() { return static_cast<Self&>(*this); }
	const Self& self() const { return static_cast<const Self&>(*this); }
};

namespace seam {

namespace py = boost::python;

template <class Self>
void set_or_explain(Self& object, const std::string& key, const py::object& value)
{
	if (object.set(key, value)) return;
	const py::object wrapped(py::ptr(&object));
	if (PyObject_HasAttrString(wrapped.ptr(), key.c_str())) {  // dead, label, ...
		object.pySetAttr(key, value);
		return;
	}
	std::string names;
	Self::attributes([&](const char* name, auto, const char*) { names += std::string(names.empty() ? "" : ", ") + name; });
	PyErr_SetString(PyExc_AttributeError,
		(std::string(Self::class_name) + " has no attribute '" + key + "'; it has " + names + ", label, dead").c_str());
	py::throw_error_already_set();
}

/// `Class(a=1, b=2)`: all values first, then one check, so that their order does not matter.
template <class Self>
py::object construct(const py::tuple& arguments, const py::dict& keywords)
{
	py::object made = arguments[0];
	if (py::len(arguments) > 1) {
		PyErr_SetString(PyExc_TypeError, (std::string(Self::class_name) + " takes keyword arguments only").c_str());
		py::throw_error_already_set();
	}
	made.attr("__init__")();
	Self& object = py::extract<Self&>(made);
	const py::list items = keywords.items();
	for (long i = 0; i < py::len(items); ++i) set_or_explain(object, py::extract<std::string>(items[i][0]), items[i][1]);
	object.check();
	return {};
}

/// A property whose new value is taken back if the object's check refuses it.
template <class Self, class Value>
void set_checked(Self& object, const std::string& name, Value Self::*member, const Value& value)
{
	const Value before = object.*member;
	object.*member = value;
	try {
		object.check();
		object.assigned(name);
	} catch (...) {
		object.*member = before;
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
	Self::attributes([&](const char* name, auto member, const char* doc) {
		using Value = std::decay_t<decltype(std::declval<Self&>().*member)>;
		const auto get = [member](const Self& object) -> Value { return object.*member; };
		const auto set = [member, name](Self& object, const Value& value) {
			set_checked(object, name, static_cast<Value Self::*>(member), value);
		};
		cls.add_property(name, py::make_function(get, py::default_call_policies(), boost::mpl::vector<Value, const Self&>()),
			py::make_function(set, py::default_call_policies(), boost::mpl::vector<void, Self&, const Value&>()), doc);
	});
	return cls;
}

}  // namespace seam
}  // namespace graindrive

namespace boost::serialization {

template <class Archive>
void serialize(Archive& archive, graindrive::Vector3r& v, unsigned)
{
	archive& make_nvp("x", v[0]) & make_nvp("y", v[1]) & make_nvp("z", v[2]);
}
template <class Archive>
void serialize(Archive& archive, graindrive::Quaternionr& q, unsigned)
{
	archive& make_nvp("w", q.w()) & make_nvp("x", q.x()) & make_nvp("y", q.y()) & make_nvp("z", q.z());
}

}  // namespace boost::serialization
