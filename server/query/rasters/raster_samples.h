#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "query/rasters/raster_rows.h"

namespace strata::query {

// How a file keeps one number.
struct SampleForm {
  enum class Kind { unsigned_whole, signed_whole, real, truth };
  Kind kind = Kind::unsigned_whole;
  int bytes = 1;  // 1, 2, 4 or 8; of real ones from 2, of truths 1
  bool is_big_endian = false;
};
// "16-bit signed whole numbers"
std::string describe(const SampleForm& form);

// Brings numbers of a file into a layer of any type. Whole numbers must be of the layer's type;
// real ones are rounded to the nearest of a layer of floats, which must be finite.
class SampleReader {
 public:
  // `nodata`: a number that stands for "not painted", as the file names it.
  SampleReader(const Layer& layer, const SampleForm& form, std::optional<double> nodata = {});

  bool is_zero(const std::uint8_t* sample) const { return number(sample) == 0; }
  // NaN or the file's nodata.
  bool is_nodata(const std::uint8_t* sample) const;
  // Refused (invalid): a number that does not fit, which is told with its row and column.
  Result<void> put(TileMapBuilder& builder, int x, int file_row, const std::uint8_t* sample) const;

 private:
  // Holds each number of 64 bits, whole or real, as it is.
  using Number = long double;
  Number number(const std::uint8_t* sample) const;
  std::optional<std::uint32_t> bits_of(Number number) const;

  const ValueType type_;
  const SampleForm form_;
  const bool is_of_layer_;  // the same bits
  std::optional<Number> nodata_;
};

}  // namespace strata::query
