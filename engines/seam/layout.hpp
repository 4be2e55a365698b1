/// Proof, at import, that YADE's classes lie in memory as `yade_classes.hpp` declares them.
#pragma once
#include <boost/python.hpp>

namespace graindrive::seam {

/// Compares version, sizes, every named member and the virtual functions with the running YADE.
///
/// A sentinel is written through YADE's own Python attribute and looked for at the declared offset; nothing is written to
/// YADE's memory, and memory is read through /proc/self/mem, so that a wrong layout cannot crash the proof itself.
/// @param damage  {"State.vel": 8} shifts a declared offset, for the test that the proof can fail
/// @return number of facts proven
/// @throws a Python ImportError that names class, member, expected and found
int prove_layout(const boost::python::dict& damage);

void bind_layout();

}  // namespace graindrive::seam
