#pragma once

#include <cstdint>
#include <vector>

namespace strata::app {

// Returns a JPEG for the demo that looks like a close-up photo of fired clay. It shows grain, pale
// flakes and a scale bar of 10 mm. The image is computed, and differs for each seed.
std::vector<std::uint8_t> story_photo(int seed);

}  // namespace strata::app
