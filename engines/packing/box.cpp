/// Checks of boxes and grains, and the bookkeeping of the cell grid.
#include "engines/packing/box.hpp"

#include <sstream>
#include <stdexcept>
#include <string>

namespace graindrive::packing {

namespace {

template <int D>
constexpr Real fewest_cells = D == 2 ? 64 : 16;  // along an axis

}  // namespace

template <int D>
void require_box(const Box<D>& box)
{
	bool usable = true;
	for (int k = 0; k < D; ++k) usable = usable && std::isfinite(box.side(k)) && box.side(k) > 0;
	if (usable) return;
	std::ostringstream message;
	message << "box must have finite sides with x_min < x_max"
			<< (D == 2 ? " and y_min < y_max" : ", y_min < y_max and z_min < z_max") << ", got (";
	for (int k = 0; k < D; ++k) message << (k ? ", " : "") << box.low[k] << ", " << box.high[k];
	message << "); give them in this order";
	throw std::invalid_argument(message.str());
}

template <int D>
void require_grains(const std::vector<Real>& radii, const Points<D>& centres, const char* role)
{
	std::ostringstream message;
	if (!centres.empty() && centres.size() != radii.size()) {
		message << role << "s need one radius a centre, got " << radii.size() << " radii and " << centres.size() << " centres";
		throw std::invalid_argument(message.str());
	}
	for (std::size_t i = 0; i < radii.size(); ++i) {
		if (!(radii[i] > 0 && std::isfinite(radii[i])))
			message << "radii must be positive and finite, got " << radii[i] << " for " << role << " " << i;
		else if (!centres.empty() && !centres[i].allFinite())
			message << "centres must be finite, got a nan or inf for " << role << " " << i;
		else
			continue;
		throw std::invalid_argument(message.str());
	}
}

/// About as many cells as grains: narrower cells would cost memory without a gain.
template <int D>
CellGrid<D>::CellGrid(const Box<D>& box, Real reach, std::size_t expected) : box_(box)
{
	const Real most = 2 * std::pow(static_cast<Real>(expected), 1.0 / D) + fewest_cells<D>;
	const Real mean_side = std::pow(box.extent(), 1.0 / D);
	std::size_t all = 1;
	for (int k = 0; k < D; ++k) {
		const Real cells = std::min(box.side(k) / reach, most * std::max(1.0, box.side(k) / mean_side));
		cells_[k] = std::max(1L, static_cast<long>(cells));
		all *= static_cast<std::size_t>(cells_[k]);
	}
	first_.assign(all, -1);
	next_.reserve(expected);
}

template <int D>
void CellGrid<D>::add(std::size_t grain, const Point<D>& centre)
{
	long cell = 0;
	for (int k = D - 1; k >= 0; --k) cell = cell * cells_[k] + place(k, centre[k]);
	if (grain >= next_.size()) next_.resize(grain + 1, -1);
	next_[grain] = first_[cell];
	first_[cell] = static_cast<long>(grain);
}

template <int D>
long CellGrid<D>::place(int axis, Real coordinate) const
{
	Real part = (coordinate - box_.low[axis]) / box_.side(axis);
	if (box_.periodic[axis]) part -= std::floor(part);
	return static_cast<long>(std::clamp(part * cells_[axis], 0.0, cells_[axis] - 1.0));
}

template <int D>
typename CellGrid<D>::Three CellGrid<D>::beside(int axis, long place) const
{
	const long cells = cells_[axis];
	const bool periodic = box_.periodic[axis];
	if (cells == 2 && periodic) return { 0, 1, -1 };
	Three around{ place - 1, place, place + 1 };
	if (around[2] == cells) around[2] = periodic && cells > 1 ? 0 : -1;
	if (around[0] < 0 && periodic && cells > 2) around[0] = cells - 1;
	return around;
}

template void require_box(const Box<2>&);
template void require_box(const Box<3>&);
template void require_grains(const std::vector<Real>&, const Points<2>&, const char*);
template void require_grains(const std::vector<Real>&, const Points<3>&, const char*);
template class CellGrid<2>;
template class CellGrid<3>;

}  // namespace graindrive::packing
