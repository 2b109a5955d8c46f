#pragma once

#include <bit>
#include <cstdint>
#include <string>
#include <vector>

#include "support/shape_files.h"

namespace strata::test {

// A little-endian TIFF with one uncompressed strip, written byte by byte.
struct TiffFile {
  struct Tag {
    std::uint16_t id, type;  // types: 2 text, 3 u16, 4 u32, 12 f64
    std::uint32_t count;
    std::string bytes;
  };
  std::uint32_t width = 0, height = 0;
  std::uint16_t bits = 8, samples = 1, format = 1, photometric = 1;
  std::string pixels;
  std::vector<Tag> more{};  // with ids above 339, ascending
  std::uint16_t orientation = 1;

  static Tag texts(std::uint16_t id, const std::string& text) {
    return {id, 2, static_cast<std::uint32_t>(text.size() + 1), text + '\0'};
  }
  static Tag shorts(std::uint16_t id, const std::vector<std::uint16_t>& values) {
    std::string bytes;
    for (const auto value : values) bytes += little_endian(value, 2);
    return {id, 3, static_cast<std::uint32_t>(values.size()), bytes};
  }
  static Tag doubles(std::uint16_t id, const std::vector<double>& values) {
    std::string bytes;
    for (const auto value : values) bytes += number(value);
    return {id, 12, static_cast<std::uint32_t>(values.size()), bytes};
  }

  std::string write() const {
    const auto one = [](std::uint16_t id, std::uint16_t type, std::uint32_t value) {
      return Tag{id, type, 1, little_endian(value, type == 3 ? 2 : 4)};
    };
    std::vector<std::uint16_t> every_bits(samples, bits), every_format(samples, format);
    std::vector<Tag> tags{
        one(256, 4, width),       one(257, 4, height),
        shorts(258, every_bits),  one(259, 3, 1),
        one(262, 3, photometric), one(273, 4, 0),
        one(274, 3, orientation), one(277, 3, samples),
        one(278, 4, height),      one(279, 4, static_cast<std::uint32_t>(pixels.size())),
        one(284, 3, 1),           shorts(339, every_format)};
    if (photometric == 2 && samples == 4) tags.insert(tags.end() - 1, one(338, 3, 2));
    tags.insert(tags.end(), more.begin(), more.end());
    std::size_t at = 8 + 2 + 12 * tags.size() + 4;
    std::string held;
    for (Tag& tag : tags) {
      if (tag.bytes.size() <= 4) continue;
      const auto offset = at + held.size();
      held += tag.bytes;
      if (held.size() % 2) held += '\0';
      tag.bytes = little_endian(offset);
    }
    std::string file = std::string("II*\0", 4) + little_endian(8) + little_endian(tags.size(), 2);
    for (Tag& tag : tags) {
      if (tag.id == 273) tag.bytes = little_endian(at + held.size());
      tag.bytes.resize(4, '\0');
      file += little_endian(tag.id, 2) + little_endian(tag.type, 2) + little_endian(tag.count) +
              tag.bytes;
    }
    return file + little_endian(0) + held + pixels;
  }
};

}  // namespace strata::test
