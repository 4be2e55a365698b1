/// Where a sphere touches a Solid.
#pragma once
#include "engines/solids/Solid.hpp"

namespace graindrive {

class Ig2_Solid_Sphere_ScGeom : public Registered<Ig2_Solid_Sphere_ScGeom, yade::IGeomFunctor> {
public:
	static constexpr const char* class_name = "Ig2_Solid_Sphere_ScGeom";
	static const char* const documentation;
	template <class Visit>
	static void attributes(Visit&& visit)
	{
		visit("solidRadius", &Ig2_Solid_Sphere_ScGeom::solidRadius,
			"ScGeom.refR1 in radii of the sphere [-], for YADE's own Ip2_: 1 as for YADE's walls and facets");
	}
	void check() const;
	std::string get2DFunctorType1() const override { return "Solid"; }
	std::string get2DFunctorType2() const override { return "Sphere"; }
	std::string checkOrder() const override { return "Solid Sphere"; }

	bool go(const yade::shared_ptr<yade::Shape>& first, const yade::shared_ptr<yade::Shape>& second, const yade::State& state1,
		const yade::State& state2, const Vector3r& shift2, const bool& force,
		const yade::shared_ptr<yade::Interaction>& interaction) override;

	Real solidRadius = 1;
};

}  // namespace graindrive

BOOST_CLASS_EXPORT_KEY2(graindrive::Ig2_Solid_Sphere_ScGeom, "Ig2_Solid_Sphere_ScGeom")
