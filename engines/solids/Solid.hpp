/// A body's shape given by distance and normal: any `geometry::Surface<3>` that has a recipe.
#pragma once
#include "engines/seam/registered.hpp"
#include "engines/solids/recipe.hpp"

namespace graindrive {

/// The surface is seen in the body's frame, whose origin is state.pos and whose axes state.ori turns.
class Solid : public Registered<Solid, yade::Shape> {
public:
	static constexpr const char* class_name = "Solid";
	static const char* const documentation;
	template <class Visit>
	static void attributes(Visit&& visit)
	{
		visit("recipe", &Solid::recipe, "text that defines the surface; see graindrive.solids.surfaces");
	}
	Solid() { createIndex(); }

	/// Makes the surface if the recipe is a new one.
	/// @throws std::invalid_argument for a recipe that is none; an empty one is allowed, for YADE makes shapes before it fills them
	void check();

	/// Takes a surface that there is, with its recipe.
	void take(const solids::Described& given);

	const solids::SharedSurface<3>& surface() const { return described_.surface; }  ///< none for an empty recipe
	const solids::Described& described() const { return described_; }

	static int& class_index();
	int& modifyClassIndex() override { return class_index(); }
	const int& getClassIndex() const override { return class_index(); }
	const int& getBaseClassIndex(int depth) const override;

	std::string recipe;

private:
	solids::Described described_;
};

/// True for a Solid; costs one comparison.
inline bool is_solid(const yade::Shape* shape) { return shape && shape->getClassIndex() == Solid::class_index(); }

/// Registers Solid in YADE's class factory, so that dispatchers find the class that functors name.
void register_solid();

}  // namespace graindrive

BOOST_CLASS_EXPORT_KEY2(graindrive::Solid, "Solid")
