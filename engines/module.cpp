/// The Python module `graindrive._engines`: proves YADE's layout, then registers every engine, functor and function.
#include <boost/python.hpp>

#include "engines/seam/layout.hpp"

namespace graindrive {
void bind_functors();
void bind_drives();
void bind_measures();
}  // namespace graindrive

BOOST_PYTHON_MODULE(_engines)
{
	boost::python::docstring_options docs(true, true, false);
	graindrive::seam::bind_layout();
	graindrive::seam::prove_layout({});
	graindrive::bind_functors();
	graindrive::bind_drives();
	graindrive::bind_measures();
}
