#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "core/error.h"

namespace strata {

// The type of a layer's texels. A texel's *bits* are its little-endian storage widened to 32 bits;
// the GPU keeps bits in unsigned formats (R8UI, R16UI, R32UI) and interprets them where a value is
// needed.
enum class ValueType : std::uint8_t { u8, u16, u32, i8, i16, i32, f16, f32 };

int bytes_per_texel(ValueType type);
std::string_view name(ValueType type);
std::optional<ValueType> parse_value_type(std::string_view name);
bool is_float(ValueType type);

// Whether `to` contains every value of `from` with the same bits: only for unsigned integers.
bool widens_to(ValueType from, ValueType to);

// Smallest and largest finite value of the type.
double lowest_value(ValueType type);
double highest_value(ValueType type);

// Returns the bits of `value`. Refused, never clamped: NaN, infinity, a fraction in an integer
// type, a value outside the type.
Result<std::uint32_t> encode_value(ValueType type, double value);
double decode_value(ValueType type, std::uint32_t bits);

}  // namespace strata
