/// Common parts of all classes that Graindrive adds to YADE: name, attributes for Python and archives, and checks of values.
///
/// A class derives from `Registered<Self, Base>` and declares its attributes once:
///
///   class Kicker : public Registered<Kicker> {
///   public:
///       static constexpr const char* class_name = "Kicker";
///       template <class Visit> static void attributes(Visit&& visit) { visit("impulse", &Kicker::impulse, "impulse on the body [N s]"); }
///       void check() const { require(impulse >= 0, "Kicker.impulse must not be negative", impulse); }
///       void action() override;
///       Real impulse = 0;
///   };
///   BOOST_CLASS_EXPORT_KEY2(graindrive::Kicker, "Kicker")  // outside of the namespace; in the source BOOST_CLASS_EXPORT_IMPLEMENT
///
/// The name for archives stands in the header, because every source that uses the class must agree on it. From the attributes come
/// `dict()`, `O.save` and `O.load`, and with `seam::bind` (bind.hpp) what Python sees: the keyword constructor, properties,
/// `updateAttrs`.
#pragma once
#include <boost/serialization/export.hpp>
#include <boost/serialization/void_cast.hpp>
#include <functional>
#include <sstream>
#include <stdexcept>

#include "engines/seam/attributes.hpp"
#include "engines/seam/yade.hpp"

namespace graindrive {

/// The usual error for a bad value: the rule and the value received.
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
template <class Visit>
void visit_base(yade::Engine& engine, Visit&& visit)
{
	visit("dead", engine.dead);
	visit("ompThreads", engine.ompThreads);
	visit("label", engine.label);
}
template <class Visit>
void visit_base(yade::Functor& functor, Visit&& visit)
{
	visit("label", functor.label);
}
template <class Visit>
void visit_base(yade::Shape& shape, Visit&& visit)
{
	visit("color", shape.color);
	visit("wire", shape.wire);
	visit("highlight", shape.highlight);
}
template <class Visit>
void visit_base(yade::FrictPhys& phys, Visit&& visit)
{
	visit("kn", phys.kn);
	visit("normalForce", phys.normalForce);
	visit("ks", phys.ks);
	visit("shearForce", phys.shearForce);
	visit("tangensOfFrictionAngle", phys.tangensOfFrictionAngle);
}

/// The values of an object's attributes, to go back to if new ones are refused.
class Snapshot {
public:
	template <class Self, class Base>
	Snapshot(Self& object, Base& base)
	{
		Self::attributes([&](const char*, auto member, const char*) { put_back_.push_back(keeper(object.*member)); });
		visit_base(base, [&](const char*, auto& value) { put_back_.push_back(keeper(value)); });
	}
	void restore() const
	{
		for (const auto& put_back : put_back_) put_back();
	}

private:
	std::vector<std::function<void()>> put_back_;
};

inline const char* base_name(const yade::Engine*) { return "Engine"; }
inline const char* base_name(const yade::LawFunctor*) { return "LawFunctor"; }
inline const char* base_name(const yade::IPhysFunctor*) { return "IPhysFunctor"; }
inline const char* base_name(const yade::IGeomFunctor*) { return "IGeomFunctor"; }
inline const char* base_name(const yade::BoundFunctor*) { return "BoundFunctor"; }
inline const char* base_name(const yade::FrictPhys*) { return "FrictPhys"; }
inline const char* base_name(const yade::Shape*) { return "Shape"; }

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
		Self::attributes([&](const char* name, auto member, const char*) { all[name] = seam::to_python(self().*member); });
		return all;
	}

	/// Takes the value back if `check` refuses it.
	void pySetAttr(const std::string& key, const boost::python::object& value) override
	{
		const seam::Snapshot before = snapshot();
		try {
			if (!set(key, value)) Base::pySetAttr(key, value);
			self().check();
		} catch (...) {
			before.restore();
			throw;
		}
	}

	seam::Snapshot snapshot() { return { self(), static_cast<Base&>(*this) }; }

	/// Sets one of our own attributes without a check; false if there is no attribute of that name.
	bool set(const std::string& key, const boost::python::object& value)
	{
		bool found = false;
		Self::attributes([&](const char* name, auto member, const char*) {
			if (key != name) return;
			found = true;
			seam::from_python(self().*member, Self::class_name, key, value);
		});
		if (found) self().assigned(key);
		return found;
	}

	void check() const {}
	/// Called with the name of every attribute that Python assigns, but not by archives. If it throws, the old value is restored.
	void assigned(const std::string&) {}

	template <class Archive>
	void serialize(Archive& archive, unsigned)
	{
		boost::serialization::void_cast_register<Self, Base>();
		seam::visit_base(
			static_cast<Base&>(*this), [&](const char* name, auto& value) { seam::archive_value(archive, name, value); });
		Self::attributes([&](const char* name, auto member, const char*) { seam::archive_value(archive, name, self().*member); });
		if constexpr (Archive::is_loading::value) self().callPostLoad();
	}

private:
	Self& self() { return static_cast<Self&>(*this); }
	const Self& self() const { return static_cast<const Self&>(*this); }
};

}  // namespace graindrive
