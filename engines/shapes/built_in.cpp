/// A table of the built-in shapes: name, alias, default sizes in d, and the function that makes the outline.
#include "engines/shapes/built_in.hpp"

#include <array>
#include <cmath>
#include <sstream>
#include <stdexcept>

namespace graindrive::shapes {

namespace {

using Sizes = std::vector<Real>;

Outline rectangle(Real width, Real height)
{
	const Real x = width / 2, y = height / 2;
	return Outline({ { -x, -y }, { x, -y }, { x, y }, { -x, y } });
}

/// An equilateral triangle, apex up, about its centroid, which is a third of the height above the base.
Outline triangle(Real side)
{
	const Real height = side * std::sqrt(3.0) / 2;
	return Outline({ { -side / 2, -height / 3 }, { side / 2, -height / 3 }, { 0, 2 * height / 3 } });
}

struct Shape {
	const char* name;
	const char* alias;
	const char* takes;
	Sizes defaults;
	Outline (*draw)(const Sizes&);
};

const std::array<Shape, 5>& shapes()
{
	static const std::array<Shape, 5> table{ {
		{ "disk", "OS1", "diameter", { 7 }, [](const Sizes& s) { return Outline::disk(s[0]); } },
		{ "square", "OS2", "side", { 6.5 }, [](const Sizes& s) { return rectangle(s[0], s[0]); } },
		{ "tall", "OS3", "width, height", { 4.5, 9.5 }, [](const Sizes& s) { return rectangle(s[0], s[1]); } },
		{ "wide", "OS4", "width, height", { 9.5, 4.5 }, [](const Sizes& s) { return rectangle(s[0], s[1]); } },
		{ "triangle", "OS5", "side", { 9.5 }, [](const Sizes& s) { return triangle(s[0]); } },
	} };
	return table;
}

const Shape& shape_named(const std::string& name)
{
	std::string choices;
	for (const Shape& shape : shapes()) {
		if (name == shape.name || name == shape.alias) return shape;
		choices += (choices.empty() ? "" : ", ") + std::string(shape.name) + " (" + shape.alias + ")";
	}
	throw std::invalid_argument(
		"shape must be one of " + choices + ", got '" + name + "'; other shapes are read from files that end in .wkt or .csv");
}

void require_sizes(const Shape& shape, const Sizes& sizes)
{
	std::ostringstream message;
	if (sizes.size() != shape.defaults.size()) {
		message << "shape " << shape.name << " takes " << shape.defaults.size() << " size(s) (" << shape.takes << "), got "
				<< sizes.size();
		throw std::invalid_argument(message.str());
	}
	for (const Real size : sizes) {
		if (std::isfinite(size) && size >= smallest_length && size <= largest_length) continue;
		message << "sizes of shape " << shape.name << " (" << shape.takes << ") must be positive and finite, from "
				<< smallest_length << " to " << largest_length << ", got " << size;
		throw std::invalid_argument(message.str());
	}
}

}  // namespace

Outline outline_of(const std::string& name, const Sizes& sizes, Real orientation)
{
	const Shape& shape = shape_named(name);
	const Sizes& taken = sizes.empty() ? shape.defaults : sizes;
	require_sizes(shape, taken);
	return shape.draw(taken).turned(orientation);
}

std::vector<std::string> shape_names()
{
	std::vector<std::string> names;
	for (const Shape& shape : shapes()) names.push_back(shape.name);
	return names;
}

}  // namespace graindrive::shapes
