#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.h"

namespace strata::mesh {

enum class PlyType : std::uint8_t { i8, u8, i16, u16, i32, u32, f32, f64 };
int bytes_of(PlyType type);

struct PlyProperty {
  std::string name;
  PlyType type = PlyType::f32;        // of the value, or of a list's items
  std::optional<PlyType> count_type;  // lists only
};

struct PlyElement {
  std::string name;
  std::uint64_t count = 0;
  std::vector<PlyProperty> properties;

  // index of the first that is there
  std::optional<int> find(std::initializer_list<std::string_view> names) const;
  // Least bytes that one such element takes (a list may be empty; ascii needs a digit and a blank a
  // value).
  std::uint64_t least_bytes(bool ascii) const;
};

enum class PlyEncoding { ascii, little_endian, big_endian };

struct PlyHeader {
  PlyEncoding encoding = PlyEncoding::ascii;
  std::vector<PlyElement> elements;
  std::vector<std::string> texture_files;  // pictures named in comments, by texnumber
  std::size_t data_offset = 0;             // first byte after the header

  // of all elements that have properties; no more than fits 64 bits
  std::uint64_t element_count() const;
};

// Refuses what is no PLY, a header of more than 16 MB, and counts that the rest of the file cannot
// hold. Line ends are LF, CRLF or CR, of lines of any length; a UTF-8 byte order mark may stand
// before them.
Result<PlyHeader> parse_ply_header(std::span<const std::uint8_t> bytes);

}  // namespace strata::mesh
