/// What is done with the value of an attribute: to Python, from Python, into an archive and out of it.
///
/// It depends on the type of the value, not on the class that has it. So it stands in functions of its own, which are compiled once
/// for each type that attributes usually have, in attributes.cpp; in every class anew they took half of the time of a build.
#pragma once
#include <boost/archive/binary_iarchive.hpp>
#include <boost/archive/binary_oarchive.hpp>
#include <boost/archive/xml_iarchive.hpp>
#include <boost/archive/xml_oarchive.hpp>
#include <boost/serialization/nvp.hpp>
#include <boost/serialization/string.hpp>
#include <boost/serialization/vector.hpp>
#include <functional>
#include <string>
#include <vector>

#include "engines/seam/yade.hpp"

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

namespace graindrive::seam {

namespace py = boost::python;

/// Raises TypeError: `key` of a class cannot be made from the value.
[[noreturn]] void refuse_type(const char* class_name, const std::string& key, const py::object& value);

template <class Value>
py::object to_python(const Value& value)
{
	return py::object(value);
}

/// Sets an attribute, without a check of its value. Raises TypeError if the value is of another type.
template <class Value>
void from_python(Value& attribute, const char* class_name, const std::string& key, const py::object& value)
{
	py::extract<Value> extracted(value);
	if (!extracted.check()) refuse_type(class_name, key, value);
	attribute = extracted();
}

template <class Archive, class Value>
void archive_value(Archive& archive, const char* name, Value& value)
{
	archive& boost::serialization::make_nvp(name, value);
}

/// Returns what gives the attribute the value that it has now.
template <class Value>
std::function<void()> keeper(Value& value)
{
	return [&value, before = value] { value = before; };
}

#define GRAINDRIVE_ATTRIBUTE_TYPE(linkage, Value)                                                                                \
	linkage template py::object to_python(const Value&);                                                                         \
	linkage template void from_python(Value&, const char*, const std::string&, const py::object&);                               \
	linkage template std::function<void()> keeper(Value&);                                                                       \
	linkage template void archive_value(boost::archive::binary_oarchive&, const char*, Value&);                                  \
	linkage template void archive_value(boost::archive::binary_iarchive&, const char*, Value&);                                  \
	linkage template void archive_value(boost::archive::xml_oarchive&, const char*, Value&);                                     \
	linkage template void archive_value(boost::archive::xml_iarchive&, const char*, Value&);
#define GRAINDRIVE_ATTRIBUTE_TYPES(linkage)                                                                                      \
	GRAINDRIVE_ATTRIBUTE_TYPE(linkage, bool)                                                                                     \
	GRAINDRIVE_ATTRIBUTE_TYPE(linkage, int)                                                                                      \
	GRAINDRIVE_ATTRIBUTE_TYPE(linkage, long)                                                                                     \
	GRAINDRIVE_ATTRIBUTE_TYPE(linkage, Real)                                                                                     \
	GRAINDRIVE_ATTRIBUTE_TYPE(linkage, std::string)                                                                              \
	GRAINDRIVE_ATTRIBUTE_TYPE(linkage, Vector3r)                                                                                 \
	GRAINDRIVE_ATTRIBUTE_TYPE(linkage, Quaternionr)                                                                              \
	GRAINDRIVE_ATTRIBUTE_TYPE(linkage, std::vector<int>)                                                                         \
	GRAINDRIVE_ATTRIBUTE_TYPE(linkage, std::vector<Real>)                                                                        \
	GRAINDRIVE_ATTRIBUTE_TYPE(linkage, std::vector<Vector3r>)                                                                    \
	GRAINDRIVE_ATTRIBUTE_TYPE(linkage, std::vector<std::string>)
GRAINDRIVE_ATTRIBUTE_TYPES(extern)

}  // namespace graindrive::seam
