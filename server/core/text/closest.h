#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace strata {

// Returns those of `names` for which `wrong` is probably a typing mistake, the most similar first,
// at most `most`: without regard to case and accents, up to a third of the characters may be
// missing, superfluous, different, or exchanged with their neighbor; or one begins with the other.
// Names without a similar one give nothing. Longer texts than 100 bytes are not compared.
std::vector<std::string> closest_names(std::string_view wrong, std::span<const std::string> names,
                                       std::size_t most = 3);

}  // namespace strata
