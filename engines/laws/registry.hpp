/// The registry of contact laws: every law is listed here, once; kernels, checks, checkpoints and Python take names and numbers from it.
#pragma once
#include <string>
#include <variant>
#include <vector>

#include "engines/laws/cundall_strack.hpp"
#include "engines/laws/hertz_history.hpp"
#include "engines/laws/hertz_mindlin.hpp"
#include "engines/laws/hertz_restitution.hpp"
#include "engines/laws/spring_dashpot.hpp"

namespace graindrive::laws {

template <template <class> class... Law>
struct LawList {
	static constexpr std::size_t size = sizeof...(Law);

	template <class P>
	using Any = std::variant<Law<P>...>;  ///< one of them, of the number type P

	/// Calls visit(law) for each law; only the type of the argument matters.
	template <class Visit>
	static void for_each(Visit&& visit)
	{
		(visit(Law<Real>{}), ...);
	}
};

/// A new law is one more name in this line.
using Laws = LawList<HertzHistory, HertzRestitution, SpringDashpot, CundallStrack, HertzMindlin>;

using ContactLaw = Laws::Any<Real>;

const char* name_of(const ContactLaw& law);
std::vector<Real> constants_of(const ContactLaw& law);  ///< in the order of the law's `constants`
inline bool same(const ContactLaw& one, const ContactLaw& other)
{
	return one.index() == other.index() && constants_of(one) == constants_of(other);
}

/// The law of that name. @throws std::invalid_argument listing the names
ContactLaw law_named(const std::string& name);
/// The same with its constants. @throws std::invalid_argument for a law that has another number of them
ContactLaw law_with(const std::string& name, const std::vector<Real>& constants);
/// @throws std::invalid_argument naming law, constant, rule and value
void require_in_range(const ContactLaw& law);

/// The same law in numbers of another type, as the kernels for single precision take it.
template <class P>
Laws::Any<P> converted(const ContactLaw& law);
extern template Laws::Any<float> converted<float>(const ContactLaw&);
extern template Laws::Any<double> converted<double>(const ContactLaw&);

/// Names in quotes, with `last` before the last one: 'a', 'b' or 'c'.
std::string listed(const std::vector<std::string>& names, const std::string& last, const char* quote = "");
std::vector<std::string> law_names();

/// Names of the laws whose type fulfils a condition.
template <class Condition>
std::vector<std::string> names_where(Condition condition)
{
	std::vector<std::string> names;
	Laws::for_each([&](const auto& law) {
		if (condition(law)) names.push_back(law.name);
	});
	return names;
}

/// "cundallStrack and hertzMindlin": those whose contacts keep a force [N] where others keep a spring [m].
std::string laws_that_remember_forces();

/// What the laws call a number of the grains' material: "K_n [Pa] (hertzHistory) or k_n [N/m] (springDashpot)".
std::string explained(const std::string& quantity);

}  // namespace graindrive::laws
