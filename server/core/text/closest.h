#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace strata {

// Returns the `names` of which `wrong` is probably a misspelling, the most similar first. Returns
// at most `most` names. Ignores case and accents. Up to a third of the characters may be missing,
// superfluous, different, or exchanged with their neighbor. A name also matches if it begins with
// `wrong` or if `wrong` begins with it. Texts of more than 100 bytes are not compared. The result
// may be empty.
std::vector<std::string> closest_names(std::string_view wrong, std::span<const std::string> names,
                                       std::size_t most = 3);

}  // namespace strata
