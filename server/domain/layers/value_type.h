#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "core/error.h"

namespace strata {

// The type of a layer's texels. The *bits* of a texel are its little-endian storage, extended to 32
// bits. The GPU keeps bits in unsigned formats (R8UI, R16UI, R32UI), and interprets them where it
// needs a value.
enum class ValueType : std::uint8_t { u8, u16, u32, i8, i16, i32, f16, f32 };

int bytes_per_texel(ValueType type);
std::string_view name(ValueType type);
std::optional<ValueType> parse_value_type(std::string_view name);
bool is_float(ValueType type);

// Returns whether each value of `from` exists in `to` with the same bits. True only for unsigned
// integers.
bool widens_to(ValueType from, ValueType to);

// Return the smallest and the largest finite value of the type.
double lowest_value(ValueType type);
double highest_value(ValueType type);

// Returns the bits of `value`. Returns an error, and does not clamp, for NaN, infinity, a fraction
// in an integer type, and a value outside the range of the type.
Result<std::uint32_t> encode_value(ValueType type, double value);
double decode_value(ValueType type, std::uint32_t bits);

}  // namespace strata
