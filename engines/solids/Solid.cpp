/// The class index, and the surface behind the recipe.
#include "engines/solids/Solid.hpp"

namespace graindrive {

const char* const Solid::documentation =
	"A shape given by the distance to its surface and the normal there: graindrive.solids.surfaces makes such surfaces.\n\n"
	"Solid(surface) or Solid(recipe='ball 0 0 0 1'). The surface is seen in the body's frame: its origin is state.pos, its axes "
	"are\n"
	"turned by state.ori. Stands with Bo1_Solid_Aabb and Ig2_Solid_Sphere_ScGeom. The recipe is what O.save keeps. Raises "
	"ValueError\n"
	"for a recipe that is none, naming the word and its place.";

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

BOOST_CLASS_EXPORT_GUID(graindrive::Solid, "Solid")
