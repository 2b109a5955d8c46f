#pragma once

#include <cstdint>
#include <vector>

namespace strata::app {

// Returns a JPEG that stands for a close-up photo of fired clay in the demo: grain, pale flakes and
// a scale of 10 mm, drawn by formula. Another seed gives another picture.
std::vector<std::uint8_t> story_photo(int seed);

}  // namespace strata::app
