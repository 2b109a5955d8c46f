#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "query/rasters/raster_rows.h"

namespace strata::query {

// Storage of one number in a file.
struct SampleForm {
  enum class Kind { unsigned_whole, signed_whole, real, truth };
  Kind kind = Kind::unsigned_whole;
  int bytes = 1;  // 1, 2, 4 or 8; of real numbers from 2, of truth values 1
  bool is_big_endian = false;
};
// "16-bit signed whole numbers"
std::string describe(const SampleForm& form);

// Converts numbers of a file to the values of a layer of any type. Integers must fit the layer's
// type; real numbers are rounded to the nearest of a float layer, and must be finite.
class SampleReader {
 public:
  // `nodata`: a number that means "not painted", from the file.
  SampleReader(const Layer& layer, const SampleForm& form, std::optional<double> nodata = {});

  bool is_zero(const std::uint8_t* sample) const { return number(sample) == 0; }
  // Whether it is NaN or the file's nodata.
  bool is_nodata(const std::uint8_t* sample) const;
  // Refused (invalid): a number that does not fit; the message has its row and column.
  Result<void> put(TileMapBuilder& builder, int x, int file_row, const std::uint8_t* sample) const;

 private:
  // Holds each 64-bit number, integer or real, exactly.
  using Number = long double;
  Number number(const std::uint8_t* sample) const;
  std::optional<std::uint32_t> bits_of(Number number) const;

  const ValueType type_;
  const SampleForm form_;
  const bool is_of_layer_;  // with the same bits
  std::optional<Number> nodata_;
};

}  // namespace strata::query
