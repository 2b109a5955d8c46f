#pragma once

namespace strata {

// Combines several lambdas into one visitor for std::visit (from cppreference).
template <class... Visitors>
struct Overloaded : Visitors... {
  using Visitors::operator()...;
};
template <class... Visitors>
Overloaded(Visitors...) -> Overloaded<Visitors...>;

}  // namespace strata
