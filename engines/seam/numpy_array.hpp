/// Vectors as NumPy arrays, for the bindings.
#pragma once
#include <boost/python/numpy.hpp>
#include <vector>

namespace graindrive::seam {

/// A copy of `values`, of shape (n,), or (n / width, width) for a width above 1.
template <class T>
boost::python::numpy::ndarray array_of(const std::vector<T>& values, int width = 1)
{
	namespace py = boost::python;
	namespace np = boost::python::numpy;
	const long rows = long(values.size()) / width;
	np::ndarray array = width > 1 ? np::zeros(py::make_tuple(rows, width), np::dtype::get_builtin<T>())
	                              : np::zeros(py::make_tuple(rows), np::dtype::get_builtin<T>());
	std::copy(values.begin(), values.end(), reinterpret_cast<T*>(array.get_data()));
	return array;
}

}  // namespace graindrive::seam
