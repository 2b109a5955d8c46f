#pragma once

#include <cstdint>
#include <map>
#include <vector>

namespace strata {

// Which keys each key names: "above", "cuts".
using Relation = std::map<std::int64_t, std::vector<std::int64_t>>;

// What cannot be in a stratigraphy: keys that lie above themselves, by way of others or not. Of
// each knot of such keys (strongly connected component) one shortest cycle through its lowest key,
// in the order in which one names the next; ascending by that key. Linear in keys and pairs but for
// the knots, where it is so for each. R. Tarjan, "Depth-first search and linear graph algorithms",
// 1972.
std::vector<std::vector<std::int64_t>> relation_cycles(const Relation& relation);

}  // namespace strata
