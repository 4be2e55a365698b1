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
	loop::Stepper* operator->() const { return &stepper; }
	loop::Stepper& operator*() const { return stepper; }

private:
	GrainLoop::Turn turn;
	loop::Stepper& stepper;
};

/// Columns that contacts between grains and with walls have in common: i, slipping, overlap, slip, point, normal, forces.
py::dict contact_table(const std::vector<loop::Contact>& contacts, const std::vector<int>& grain_id);

void bind_checkpoint(GrainLoopClass& cls);
void bind_walls(GrainLoopClass& cls);
void bind_energy(GrainLoopClass& cls);

}  // namespace graindrive
