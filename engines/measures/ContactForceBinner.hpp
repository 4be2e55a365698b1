/// Forces on one body or clump by contact angle, streamed while the scene runs.
#pragma once
#include <memory>

#include "engines/measures/angular_kernel.hpp"
#include "engines/seam/registered.hpp"
#include "engines/seam/scene_contacts.hpp"

namespace graindrive {

class ContactForceBinner : public Registered<ContactForceBinner> {
public:
	static constexpr const char* class_name = "ContactForceBinner";
	static const char* const documentation;
	/// What is kept of every bin.
	enum Channel { normal, tangential, contacts, slipping, force_x, force_y, force_z, channels };
	/// What is kept of the whole body, behind the bins: force, torque, contacts, slipping contacts, the normal forces' share in the force.
	enum Total { total_force = 0, total_torque = 3, total_contacts = 6, total_slipping = 7, total_normal = 8, totals = 11 };

	template <class Visit>
	static void attributes(Visit&& visit)
	{
		using Self = ContactForceBinner;
		visit("body", &Self::body, "id of the body or clump");
		visit("kernel", &Self::kernel, "'bins', or 'gaussian' for the points of Guillard et al. 2014, Eq. (A4)");
		visit("count", &Self::count, "number of bins or points; 0: 24 bins, 64 points");
		visit("width", &Self::width, "standard deviation of the Gaussian [rad]; default 8 degrees");
		visit("reference", &Self::reference, "angle 0 is along 'direction' ('fixed') or along the body's velocity ('motion')");
		visit("direction", &Self::direction, "direction of angle 0 with reference='fixed', and before the body moves");
		visit("planeNormal", &Self::planeNormal,
			"axis of the angle, counter-clockwise about it: z in 2D, the cylinder's axis in 3D");
		visit("every", &Self::every, "number of steps between two samples");
		visit("samples", &Self::samples, "number of samples so far");
		visit("meanData", &Self::meanData, "running means, for save and load");
		visit("squaresData", &Self::squaresData, "running sums of squared deviations, for save and load");
		visit("sampleData", &Self::sample_, "the last sample, for save and load");
		visit("zeroDirection", &Self::last_direction_, "direction of angle 0 at the last sample; 0 before the first one");
	}
	void check() const;
	void callPostLoad() override;
	void action() override;
	bool reads_all_bodies() const override { return false; }

	void clear();
	/// Mean (`variance` false) or variance over samples of one channel, bin by bin.
	std::vector<Real> statistic(int channel, bool variance) const;
	Real total_statistic(int which, bool variance) const;
	const std::vector<Real>& last_sample() const { return sample_; }
	std::vector<Real> angles() const;
	int bin_count() const { return count > 0 ? count : kernel == "gaussian" ? 64 : 24; }

	int body = -1, count = 0, every = 1;
	std::string kernel = "bins", reference = "fixed";
	Real width = 8 * pi / 180;
	Vector3r direction = Vector3r::UnitX(), planeNormal = Vector3r::UnitZ();
	long samples = 0;
	std::vector<Real> meanData, squaresData;

private:
	std::size_t slot(int channel, int bin) const { return std::size_t(channel) * bin_count() + bin; }
	std::size_t total_slot(int which) const { return std::size_t(channels) * bin_count() + which; }
	std::size_t row_size() const { return total_slot(totals); }
	Vector3r zero_direction();
	void take_sample();
	void add(const BodyContact& contact, const Vector3r& e1, const Vector3r& e2, const AngularKernel& kernel);

	SceneContacts source_;
	std::vector<BodyContact> found_;
	std::vector<BinShare> shares_;
	std::vector<Real> sample_;
	Vector3r last_direction_ = Vector3r::Zero();
};

}  // namespace graindrive

BOOST_CLASS_EXPORT_KEY2(graindrive::ContactForceBinner, "ContactForceBinner")
