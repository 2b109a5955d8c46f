#pragma once

namespace strata {

// Combines several lambdas to one visitor of std::visit, as on cppreference.
template <class... Visitors>
struct Overloaded : Visitors... {
  using Visitors::operator()...;
};
template <class... Visitors>
Overloaded(Visitors...) -> Overloaded<Visitors...>;

}  // namespace strata
