/// The registry of contact laws: names, constants, other number types.
#include "engines/laws/registry.hpp"

#include <stdexcept>

namespace graindrive::laws {

namespace {

template <class Law>
std::vector<Real> numbers(const Law& law)
{
	std::vector<Real> all;
	Law::constants([&](const Quantity&, auto constant) { all.push_back(law.*constant); });
	return all;
}

template <class Law>
Law made_of(const std::vector<Real>& numbers)
{
	Law law{};
	std::size_t k = 0;
	Law::constants([&](const Quantity&, auto constant) { law.*constant = numbers[k++]; });
	return law;
}

}  // namespace

const char* name_of(const ContactLaw& law)
{
	return std::visit([](const auto& l) { return l.name; }, law);
}

std::vector<Real> constants_of(const ContactLaw& law)
{
	return std::visit([](const auto& l) { return numbers(l); }, law);
}

ContactLaw law_named(const std::string& name)
{
	ContactLaw found;
	bool known = false;
	Laws::for_each([&](const auto& law) {
		if (law.name != name) return;
		found = law;
		known = true;
	});
	if (!known) throw std::invalid_argument("law must be " + listed(law_names(), " or ", "'") + ", got " + name);
	return found;
}

ContactLaw law_with(const std::string& name, const std::vector<Real>& constants)
{
	ContactLaw law = law_named(name);
	std::visit(
		[&](auto& l) {
			using Law = std::decay_t<decltype(l)>;
			if (const std::size_t n = numbers(l).size(); constants.size() != n)
				throw std::invalid_argument("law " + name + " has " + std::to_string(n) + " constants, got " +
											std::to_string(constants.size()) + "; they were written by another version");
			l = made_of<Law>(constants);
		},
		law);
	return law;
}

void require_in_range(const ContactLaw& law)
{
	const auto check = [](const auto& l) {
		l.constants([&](const Quantity& quantity, auto constant) {
			try {
				require(quantity, l.*constant);
			} catch (const std::invalid_argument& refusal) {
				throw std::invalid_argument(std::string("law ") + l.name + ": " + refusal.what());
			}
		});
	};
	std::visit(check, law);
}

namespace {

template <class P, template <class> class Law>
Law<P> with_numbers(const Law<Real>& law)
{
	const std::vector<Real> all = numbers(law);
	Law<P> other{};
	std::size_t k = 0;
	Law<P>::constants([&](const Quantity&, auto constant) { other.*constant = P(all[k++]); });
	return other;
}

}  // namespace

template <class P>
Laws::Any<P> converted(const ContactLaw& law)
{
	return std::visit([](const auto& l) -> Laws::Any<P> { return with_numbers<P>(l); }, law);
}
template Laws::Any<float> converted<float>(const ContactLaw&);
template Laws::Any<double> converted<double>(const ContactLaw&);

std::string listed(const std::vector<std::string>& names, const std::string& last, const char* quote)
{
	std::string all;
	for (std::size_t k = 0; k < names.size(); ++k)
		all += (k == 0 ? "" : k + 1 == names.size() ? last : ", ") + (quote + names[k] + quote);
	return all;
}

std::vector<std::string> law_names()
{
	return names_where([](const auto&) { return true; });
}

std::string laws_that_remember_forces()
{
	return listed(names_where([](const auto& law) { return law.remembers_force; }), " and ");
}

std::string explained(const std::string& quantity)
{
	struct Meaning {
		std::string words, laws;
	};
	std::vector<Meaning> meanings;
	Laws::for_each([&](const auto& law) {
		using Given = typename std::decay_t<decltype(law)>::Given;
		Given::quantities([&](const Quantity& q, auto) {
			if (q.name != quantity) return;
			const std::string words = std::string(q.meaning) + ", " + q.symbol + " [" + q.unit + "]";
			for (Meaning& known : meanings)
				if (known.words == words) return void(known.laws += std::string(", ") + law.name);
			meanings.push_back({ words, law.name });
		});
	});
	std::string all;
	for (const Meaning& one : meanings) all += (all.empty() ? "" : "; ") + one.words + " (" + one.laws + ")";
	return all;
}

}  // namespace graindrive::laws
