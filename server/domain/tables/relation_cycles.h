#pragma once

#include <cstdint>
#include <map>
#include <vector>

namespace strata {

// For each key, the keys that it refers to in a relation such as "above" or "cuts".
using Relation = std::map<std::int64_t, std::vector<std::int64_t>>;

// Finds the contradictions in a stratigraphy: keys that are above themselves, directly or through
// other keys. Returns one shortest cycle for each strongly connected component of such keys. The
// cycle goes through the lowest key of the component, and each key refers to the next one. The
// cycles are ordered by their lowest key. The running time is linear in the number of keys and of
// pairs. R. Tarjan, "Depth-first search and linear graph algorithms", 1972.
std::vector<std::vector<std::int64_t>> relation_cycles(const Relation& relation);

}  // namespace strata
