/// The box that YADE's collider sees around a Solid.
#pragma once
#include "engines/solids/Solid.hpp"

namespace graindrive {

class Bo1_Solid_Aabb : public Registered<Bo1_Solid_Aabb, yade::BoundFunctor> {
public:
	static constexpr const char* class_name = "Bo1_Solid_Aabb";
	static const char* const documentation;
	template <class Visit>
	static void attributes(Visit&&)
	{
	}
	std::string get1DFunctorType1() const override { return "Solid"; }
	void go(const yade::shared_ptr<yade::Shape>& shape, yade::shared_ptr<yade::Bound>& bound, const yade::Se3r& place,
		const yade::Body* body) override;
};

/// The box around a solid at its place. A solid that turns, or may be turned, has the box of the ball in which it turns: YADE's collider
/// looks again when bodies have moved by a while, and does not see that they turned.
geometry::Bounds<3> box_around(const Solid& solid, const yade::Se3r& place, const yade::State& state);

}  // namespace graindrive

BOOST_CLASS_EXPORT_KEY2(graindrive::Bo1_Solid_Aabb, "Bo1_Solid_Aabb")
