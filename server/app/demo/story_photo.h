#pragma once

#include <cstdint>
#include <vector>

namespace strata::app {

// Returns a JPEG for the demo that looks like a close-up photo of fired clay, with grain, pale
// flakes and a scale of 10 mm. It is computed; another seed gives another picture.
std::vector<std::uint8_t> story_photo(int seed);

}  // namespace strata::app
