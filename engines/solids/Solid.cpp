/// The class index, and the surface that the recipe describes.
#include "engines/solids/Solid.hpp"

namespace graindrive {

const char* const Solid::documentation =
	"A shape given by the distance to its surface and the normal there; graindrive.solids.surfaces makes such surfaces.\n\n"
	"Solid(surface) or Solid(recipe='ball 0 0 0 1'). The surface is given in the body's frame, whose origin is state.pos\n"
	"and whose axes are rotated by state.ori. Use it with Bo1_Solid_Aabb and Ig2_Solid_Sphere_ScGeom. O.save stores the\n"
	"recipe. Raises ValueError for an invalid recipe and names the word and its position.";

void Solid::check()
{
	if (recipe == described_.recipe) return;
	described_ = { recipe, recipe.empty() ? nullptr : solids::surface_of(recipe) };
}

void Solid::take(const solids::Described& given)
{
	described_ = given;
	recipe = given.recipe;
}

int& Solid::class_index()
{
	static int index = -1;
	return index;
}

const int& Solid::getBaseClassIndex(int depth) const
{
	static const yade::Shape base;
	return depth == 1 ? base.getClassIndex() : base.getBaseClassIndex(depth - 1);
}

void register_solid()
{
	Singleton<yade::ClassFactory>::instance().registerFactorable(
		Solid::class_name, []() -> yade::Factorable* { return new Solid; },
		[]() -> yade::shared_ptr<yade::Factorable> { return boost::make_shared<Solid>(); }, []() -> void* { return new Solid; });
}

}  // namespace graindrive

BOOST_CLASS_EXPORT_IMPLEMENT(graindrive::Solid)
