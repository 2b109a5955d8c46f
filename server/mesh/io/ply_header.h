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
  PlyType type = PlyType::f32;        // of the value, or of the items of a list
  std::optional<PlyType> count_type;  // for lists only
};

struct PlyElement {
  std::string name;
  std::uint64_t count = 0;
  std::vector<PlyProperty> properties;

  // Returns the index of the first of these names that is present.
  std::optional<int> find(std::initializer_list<std::string_view> names) const;
  // Returns the minimum number of bytes of one such element. A list may be empty. In ASCII each
  // value needs a digit and a blank.
  std::uint64_t least_bytes(bool ascii) const;
};

enum class PlyEncoding { ascii, little_endian, big_endian };

struct PlyHeader {
  PlyEncoding encoding = PlyEncoding::ascii;
  std::vector<PlyElement> elements;
  std::vector<std::string> texture_files;  // images named in comments, indexed by texnumber
  std::size_t data_offset = 0;             // position of the first byte after the header

  // Returns the number of all elements that have properties. It fits in 64 bits.
  std::uint64_t element_count() const;
};

// Refuses files that are not PLY, headers of more than 16 MB, and counts that the rest of the file
// cannot hold. Lines end with LF, CRLF or CR and may have any length. The file may begin with a
// UTF-8 byte order mark.
Result<PlyHeader> parse_ply_header(std::span<const std::uint8_t> bytes);

}  // namespace strata::mesh
