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

  // index of the first name that is present
  std::optional<int> find(std::initializer_list<std::string_view> names) const;
  // The minimum bytes of one such element (a list may be empty; ascii needs a digit and a blank for
  // each value).
  std::uint64_t least_bytes(bool ascii) const;
};

enum class PlyEncoding { ascii, little_endian, big_endian };

struct PlyHeader {
  PlyEncoding encoding = PlyEncoding::ascii;
  std::vector<PlyElement> elements;
  std::vector<std::string> texture_files;  // pictures named in comments, by texnumber
  std::size_t data_offset = 0;             // first byte after the header

  // number of all elements that have properties; fits in 64 bits
  std::uint64_t element_count() const;
};

// Refuses a file that is no PLY, a header of more than 16 MB, and counts that the rest of the file
// cannot hold. Lines end at LF, CRLF or CR and may be of any length; the file may begin with a
// UTF-8 byte order mark.
Result<PlyHeader> parse_ply_header(std::span<const std::uint8_t> bytes);

}  // namespace strata::mesh
