/// What the files of GrainLoop's Python binding share.
#pragma once
#include <boost/python/numpy.hpp>

#include "engines/loop/GrainLoop.hpp"
#include "engines/seam/bind.hpp"
#include "engines/seam/numpy_array.hpp"

namespace graindrive {

namespace py = boost::python;
namespace np = boost::python::numpy;

using seam::array_of;
using GrainLoopClass = decltype(seam::bind<GrainLoop>(""));

yade::Scene* scene_of_yade();

/// The loop, ready to be asked, and kept between two steps meanwhile. YADE tells an engine its scene at every step; a call from Python
/// may come before the first one.
class Running {
public:
	explicit Running(GrainLoop& loop);
	loop::Mirror* operator->() const { return &mirror; }
	loop::Mirror& operator*() const { return mirror; }

private:
	GrainLoop::Turn turn;
	loop::Mirror& mirror;
};

/// Columns of contacts: i, j, slipping, overlap, slip, point, normal, forces.
py::dict contact_table(const std::vector<loop::SeenContact>& contacts, int dimensions);

void bind_checkpoint(GrainLoopClass& cls);
void bind_walls(GrainLoopClass& cls);
void bind_energy(GrainLoopClass& cls);

}  // namespace graindrive
