#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "domain/layers/key_numbers.h"
#include "domain/layers/palette.h"

namespace strata {

// The text in a column of the record with a key.
struct KeyText {
  std::uint32_t key = 0;
  std::string text;
};

// Convert palettes that color by a column of the records (Palette::column) to palettes by key.
// Records without a value in the column are in no list and get the color of the others.
Palette colors_of_numbers(const Palette& palette, std::span<const KeyNumber> numbers);
Palette colors_of_texts(const Palette& palette, std::span<const KeyText> texts);

// Returns a palette by key that highlights some keys (ascending): they keep their colors; the
// others turn gray or, with `isolate`, are not drawn.
Palette highlighted_colors(const Palette& by_key, std::span<const std::uint32_t> keys,
                           bool isolate);

}  // namespace strata
