#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "domain/layers/key_numbers.h"
#include "domain/layers/palette.h"

namespace strata {

// What a column says of the record with a key, as text.
struct KeyText {
  std::uint32_t key = 0;
  std::string text;
};

// Palettes by key, made from palettes that colour by what records hold (Palette::column). Records
// that have no value there are in none of the lists, and get the colour of the others.
Palette colors_of_numbers(const Palette& palette, std::span<const KeyNumber> numbers);
Palette colors_of_texts(const Palette& palette, std::span<const KeyText> texts);

// A palette by key in which some keys (ascending) are to be seen before all others: they keep their
// colours, the others turn grey, or with `isolate` are not drawn.
Palette highlighted_colors(const Palette& by_key, std::span<const std::uint32_t> keys,
                           bool isolate);

}  // namespace strata
