#pragma once

namespace strata {

// One visitor of std::visit made of several lambdas, as cppreference has it.
template <class... Visitors>
struct Overloaded : Visitors... {
  using Visitors::operator()...;
};
template <class... Visitors>
Overloaded(Visitors...) -> Overloaded<Visitors...>;

}  // namespace strata
