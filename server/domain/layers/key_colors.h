#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "domain/layers/key_numbers.h"
#include "domain/layers/palette.h"

namespace strata {

// A key, and the text in a column of its record.
struct KeyText {
  std::uint32_t key = 0;
  std::string text;
};

// Convert a palette that colors by a column of the records (Palette::column) to a palette by key.
// `numbers` and `texts` do not contain records without a value in the column, so these records get
// the color of the unlisted values.
Palette colors_of_numbers(const Palette& palette, std::span<const KeyNumber> numbers);
Palette colors_of_texts(const Palette& palette, std::span<const KeyText> texts);

// Returns a palette by key that highlights `keys`, which must be ascending. The highlighted keys
// keep their colors. The others are gray or, with `isolate`, are not drawn.
Palette highlighted_colors(const Palette& by_key, std::span<const std::uint32_t> keys,
                           bool isolate);

}  // namespace strata
