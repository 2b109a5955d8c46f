#pragma once

#include <bit>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace strata::test {

// Writes shapefiles byte by byte as ESRI's specification describes them, so the tests of the reader
// do not depend on Strata's writer.

inline std::string big_endian(std::uint32_t value) {
  std::string bytes;
  for (const int shift : {24, 16, 8, 0}) bytes += static_cast<char>(value >> shift & 0xff);
  return bytes;
}
inline std::string little_endian(std::uint64_t value, int bytes = 4) {
  std::string text;
  for (int i = 0; i < bytes; ++i) text += static_cast<char>(value >> (8 * i) & 0xff);
  return text;
}
inline std::string number(double value) {
  return little_endian(std::bit_cast<std::uint64_t>(value), 8);
}

using ShapeRings = std::vector<std::vector<std::pair<double, double>>>;

// Returns the content of a polygon's record, or a null shape if there are no rings. Type 15 has a Z
// of 0 everywhere.
inline std::string polygon_record(const ShapeRings& rings, std::uint32_t type = 5) {
  if (rings.empty()) return little_endian(0);
  std::string starts, points;
  std::uint32_t count = 0;
  double low_x = 1e300, low_y = 1e300, high_x = -1e300, high_y = -1e300;
  for (const auto& ring : rings) {
    starts += little_endian(count);
    for (const auto& [x, y] : ring) {
      points += number(x) + number(y);
      low_x = std::min(low_x, x), low_y = std::min(low_y, y), high_x = std::max(high_x, x),
      high_y = std::max(high_y, y);
      ++count;
    }
  }
  std::string record = little_endian(type) + number(low_x) + number(low_y) + number(high_x) +
                       number(high_y) + little_endian(rings.size()) + little_endian(count) +
                       starts + points;
  if (type == 15) record += std::string(16 + 8 * std::size_t{count}, '\0');
  return record;
}

inline std::string shp_of(const std::vector<std::string>& records, std::uint32_t type = 5) {
  std::string body;
  for (std::size_t i = 0; i < records.size(); ++i)
    body += big_endian(static_cast<std::uint32_t>(i + 1)) +
            big_endian(static_cast<std::uint32_t>(records[i].size() / 2)) + records[i];
  return big_endian(9994) + std::string(20, '\0') +
         big_endian(static_cast<std::uint32_t>((100 + body.size()) / 2)) + little_endian(1000) +
         little_endian(type) + std::string(64, '\0') + body;
}

// A field of a .dbf: type 'N' or 'C', with the values as the file stores them.
struct DbfField {
  std::string name;
  char type = 'N';
  int width = 10, decimals = 0;
  std::vector<std::string> values;
};

inline std::string dbf_of(const std::vector<DbfField>& fields) {
  std::size_t record = 1;
  std::string described;
  for (const DbfField& field : fields) {
    std::string one = field.name.substr(0, 10);
    one.resize(11, '\0');
    one += field.type;
    one.append(4, '\0');
    one += static_cast<char>(field.width);
    one += static_cast<char>(field.decimals);
    one.resize(32, '\0');
    described += one;
    record += static_cast<std::size_t>(field.width);
  }
  const std::size_t rows = fields.empty() ? 0 : fields[0].values.size();
  std::string dbf = std::string("\x03\x7c\x01\x01", 4) + little_endian(rows) +
                    little_endian(33 + described.size(), 2) + little_endian(record, 2) +
                    std::string(20, '\0') + described + "\r";
  for (std::size_t row = 0; row < rows; ++row) {
    dbf += ' ';
    for (const DbfField& field : fields) {
      std::string value = field.values[row].substr(0, static_cast<std::size_t>(field.width));
      const std::size_t missing = static_cast<std::size_t>(field.width) - value.size();
      dbf +=
          field.type == 'N' ? std::string(missing, ' ') + value : value + std::string(missing, ' ');
    }
  }
  return dbf + '\x1a';
}

inline ShapeRings square(double x, double y, double size) {
  return {{{x, y}, {x, y + size}, {x + size, y + size}, {x + size, y}, {x, y}}};
}

}  // namespace strata::test
