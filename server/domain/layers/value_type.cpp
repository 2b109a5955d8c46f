#include "domain/layers/value_type.h"

#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <string>

#include <glm/gtc/packing.hpp>

#include "core/text/number_text.h"

namespace strata {
namespace {

struct Traits {
  std::string_view name;
  int bytes;
  double lowest, highest;
  bool floating;
};

std::string limit_text(const Traits& t, double limit) {
  return t.floating ? short_number(limit) : std::to_string(static_cast<std::int64_t>(limit));
}

constexpr std::array<Traits, 8> kTraits{{
    {"u8", 1, 0, 255, false},
    {"u16", 2, 0, 65535, false},
    {"u32", 4, 0, 4294967295.0, false},
    {"i8", 1, -128, 127, false},
    {"i16", 2, -32768, 32767, false},
    {"i32", 4, -2147483648.0, 2147483647.0, false},
    {"f16", 2, -65504, 65504, true},
    {"f32", 4, -3.4028234663852886e38, 3.4028234663852886e38, true},
}};

const Traits& traits(ValueType type) { return kTraits[static_cast<std::size_t>(type)]; }

}  // namespace

int bytes_per_texel(ValueType type) { return traits(type).bytes; }
std::string_view name(ValueType type) { return traits(type).name; }
bool is_float(ValueType type) { return traits(type).floating; }
double lowest_value(ValueType type) { return traits(type).lowest; }
double highest_value(ValueType type) { return traits(type).highest; }

bool widens_to(ValueType from, ValueType to) {
  const auto is_unsigned = [](ValueType type) {
    return !is_float(type) && lowest_value(type) == 0;
  };
  return is_unsigned(from) && is_unsigned(to) && bytes_per_texel(to) > bytes_per_texel(from);
}

std::optional<ValueType> parse_value_type(std::string_view name) {
  for (std::size_t i = 0; i < kTraits.size(); ++i)
    if (kTraits[i].name == name) return static_cast<ValueType>(i);
  return std::nullopt;
}

Result<std::uint32_t> encode_value(ValueType type, double value) {
  const Traits& t = traits(type);
  if (!std::isfinite(value))
    return fail(ErrorCode::invalid, "Value is not finite", "A value must be a finite number.",
                "value");
  if (value < t.lowest || value > t.highest)
    return fail(
        ErrorCode::invalid, "Value out of range",
        "This layer can store only values of type " + std::string(t.name) + ", from " +
            limit_text(t, t.lowest) + " to " + limit_text(t, t.highest) + "." +
            (widens_to(type, ValueType::u32) && value > 0
                 ? " To store larger values, change the type of the layer (PATCH {\"type\": \"u32\"})."
                 : ""),
        "value");
  if (!t.floating && value != std::floor(value))
    return fail(ErrorCode::invalid, "Not a whole number",
                "This layer can store only whole numbers (" + std::string(t.name) +
                    "). Send a value without a fraction.",
                "value");
  switch (type) {
    // Adding 0 turns -0 into 0, because classes are compared by their bits.
    case ValueType::f32: return std::bit_cast<std::uint32_t>(static_cast<float>(value) + 0.0f);
    case ValueType::f16: return glm::packHalf1x16(static_cast<float>(value) + 0.0f);
    case ValueType::i8: return static_cast<std::uint8_t>(static_cast<std::int8_t>(value));
    case ValueType::i16: return static_cast<std::uint16_t>(static_cast<std::int16_t>(value));
    case ValueType::i32: return static_cast<std::uint32_t>(static_cast<std::int32_t>(value));
    default: return static_cast<std::uint32_t>(value);
  }
}

double decode_value(ValueType type, std::uint32_t bits) {
  switch (type) {
    case ValueType::f32: return std::bit_cast<float>(bits);
    case ValueType::f16: return glm::unpackHalf1x16(static_cast<std::uint16_t>(bits));
    case ValueType::i8: return static_cast<std::int8_t>(bits);
    case ValueType::i16: return static_cast<std::int16_t>(bits);
    case ValueType::i32: return static_cast<std::int32_t>(bits);
    default: return bits;
  }
}

}  // namespace strata
