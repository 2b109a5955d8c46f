#pragma once

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>

namespace strata::mesh {

// Functions for numbers in the storage types of glTF accessors (glTF 2.0, 3.6.2), from any source
// of bytes.

constexpr int kByte = 5120, kUnsignedByte = 5121, kShort = 5122, kUnsignedShort = 5123,
              kUnsignedInt = 5125, kFloat = 5126;

inline int bytes_of_component(int type) {
  switch (type) {
    case kByte:
    case kUnsignedByte: return 1;
    case kShort:
    case kUnsignedShort: return 2;
    case kUnsignedInt:
    case kFloat: return 4;
    default: return 0;
  }
}

inline std::string name_of_component(int type) {
  switch (type) {
    case kByte: return "BYTE";
    case kUnsignedByte: return "UNSIGNED_BYTE";
    case kShort: return "SHORT";
    case kUnsignedShort: return "UNSIGNED_SHORT";
    case kUnsignedInt: return "UNSIGNED_INT";
    case kFloat: return "FLOAT";
    default: return "numbers of type " + std::to_string(type);
  }
}

// Converts a stored number. A normalized integer becomes a share of the largest number of its type,
// 0…1 or −1…1. Types with 4 bytes are never normalized.
inline double gltf_number(double stored, int type, bool normalized) {
  if (!normalized) return stored;
  switch (type) {
    case kByte: return std::max(stored / 127, -1.0);
    case kUnsignedByte: return stored / 255;
    case kShort: return std::max(stored / 32767, -1.0);
    case kUnsignedShort: return stored / 65535;
    default: return stored;
  }
}

template <class Number>
Number load_number(const std::uint8_t* at) {
  Number value;
  std::memcpy(&value, at, sizeof value);
  return value;
}

inline double stored_number(const std::uint8_t* at, int type) {
  switch (type) {
    case kByte: return load_number<std::int8_t>(at);
    case kUnsignedByte: return at[0];
    case kShort: return load_number<std::int16_t>(at);
    case kUnsignedShort: return load_number<std::uint16_t>(at);
    case kUnsignedInt: return load_number<std::uint32_t>(at);
    default: return static_cast<double>(load_number<float>(at));
  }
}

inline std::uint32_t stored_index(const std::uint8_t* at, int type) {
  if (type == kUnsignedByte) return at[0];
  return type == kUnsignedShort ? load_number<std::uint16_t>(at) : load_number<std::uint32_t>(at);
}

inline bool is_index_type(int type) {
  return type == kUnsignedByte || type == kUnsignedShort || type == kUnsignedInt;
}

}  // namespace strata::mesh
