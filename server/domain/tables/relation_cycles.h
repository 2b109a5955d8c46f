#pragma once

#include <cstdint>
#include <map>
#include <vector>

namespace strata {

// The keys that each key names: "above", "cuts".
using Relation = std::map<std::int64_t, std::vector<std::int64_t>>;

// Finds the contradictions of a stratigraphy: keys that are above themselves, directly or through
// others. Returns for each strongly connected component of such keys one shortest cycle through its
// lowest key, in the order in which one names the next; ascending by that key. Linear in keys and
// pairs, for each component too. R. Tarjan, "Depth-first search and linear graph algorithms", 1972.
std::vector<std::vector<std::int64_t>> relation_cycles(const Relation& relation);

}  // namespace strata
