/// Every law of the registry, for the tests that hold of all.
#pragma once
#include "engines/laws/registry.hpp"

namespace graindrive::laws {

/// Calls check(law) for each with the material that it has by default.
template <class Check>
void for_every_law_by_default(Check check, Real mu = 0.5)
{
	Laws::for_each([&](const auto& kind) {
		using Law = std::decay_t<decltype(kind)>;
		check(Law::of({}, mu));
	});
}

/// Also with dashpots where they have none by default.
template <class Check>
void for_every_law_damped_and_not(Check check, Real mu = 0.5)
{
	for_every_law_by_default(check, mu);
	check(HertzHistory<Real>::of({ 2e6, 2.46e6, 0, 0 }, mu));
	check(hertz_restitution(5e6, 0.3, 1, mu));
	check(spring_dashpot(2e5, 1e5, 1, mu));
	check(hertz_mindlin(5e6, 0.3, 0.3, 0.2, mu));
}

}  // namespace graindrive::laws
