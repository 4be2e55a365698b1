/// Checks of boxes and disks, and the bookkeeping of the cell grid.
#include "engines/packing/box.hpp"

#include <sstream>
#include <stdexcept>

namespace graindrive::packing {

namespace {

/// About as many cells as disks: narrower ones would cost memory and find nothing more.
long cells_along(Real side, Real reach, Real most) { return std::max(1L, static_cast<long>(std::min(side / reach, most))); }

}  // namespace

void require_box(const Box& box)
{
	const bool finite = std::isfinite(box.width()) && std::isfinite(box.height());
	if (finite && box.width() > 0 && box.height() > 0) return;
	std::ostringstream message;
	message << "box must have finite sides with x_min < x_max and y_min < y_max, got (" << box.x_min << ", " << box.x_max << ", "
			<< box.y_min << ", " << box.y_max << "); give them in this order";
	throw std::invalid_argument(message.str());
}

void require_disks(const std::vector<Real>& radii, const Points& centres, const char* role)
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

CellGrid::CellGrid(const Box& box, Real reach, std::size_t expected) : box_(box)
{
	const Real most = 2 * std::sqrt(static_cast<Real>(expected)) + 64;
	columns_ = cells_along(box.width(), reach, most * std::max(1.0, std::sqrt(box.width() / box.height())));
	rows_ = cells_along(box.height(), reach, most * std::max(1.0, std::sqrt(box.height() / box.width())));
	first_.assign(columns_ * rows_, -1);
	next_.reserve(expected);
}

void CellGrid::add(std::size_t disk, const Vector2r& centre)
{
	long& first = first_[row_of(centre.y()) * columns_ + column_of(centre.x())];
	if (disk >= next_.size()) next_.resize(disk + 1, -1);
	next_[disk] = first;
	first = static_cast<long>(disk);
}

long CellGrid::column_of(Real x) const
{
	Real part = (x - box_.x_min) / box_.width();
	if (box_.periodic_x) part -= std::floor(part);
	return static_cast<long>(std::clamp(part * columns_, 0.0, columns_ - 1.0));
}

long CellGrid::row_of(Real y) const
{
	return static_cast<long>(std::clamp((y - box_.y_min) / box_.height() * rows_, 0.0, rows_ - 1.0));
}

CellGrid::Three CellGrid::columns_around(long column) const
{
	Three around{ { column - 1, column, column + 1 } };
	if (around.column[2] == columns_) around.column[2] = box_.periodic_x && columns_ > 1 ? 0 : -1;
	if (around.column[0] < 0 && box_.periodic_x && columns_ > 2)
		around.column[0] = columns_ - 1;  // with two, it has been visited
	if (columns_ == 2 && box_.periodic_x) return { { 0, 1, -1 } };
	return around;
}

}  // namespace graindrive::packing
