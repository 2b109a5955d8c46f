#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "query/rasters/raster_rows.h"

namespace strata::query {

// The storage format of one number in a file.
struct SampleForm {
  enum class Kind { unsigned_whole, signed_whole, real, truth };
  Kind kind = Kind::unsigned_whole;
  int bytes = 1;  // 1, 2, 4 or 8; at least 2 for real numbers, 1 for truth values
  bool is_big_endian = false;
};
// Returns a description such as "16-bit signed whole numbers".
std::string describe(const SampleForm& form);

// Converts numbers of a file to the values of a layer of any type. Integers must fit the type of
// the layer. Real numbers must be finite, and are rounded to the nearest value of a float layer.
class SampleReader {
 public:
  // `nodata` is the number that means "not painted" in the file.
  SampleReader(const Layer& layer, const SampleForm& form, std::optional<double> nodata = {});

  bool is_zero(const std::uint8_t* sample) const { return number(sample) == 0; }
  // Returns true if the sample is NaN or the nodata of the file.
  bool is_nodata(const std::uint8_t* sample) const;
  // Sets a texel to the number of a sample. Returns an `invalid` error for a number that does not
  // fit, with its row and column in the message.
  Result<void> put(TileMapBuilder& builder, int x, int file_row, const std::uint8_t* sample) const;

 private:
  // Represents each 64-bit number, integer or real, exactly.
  using Number = long double;
  Number number(const std::uint8_t* sample) const;
  std::optional<std::uint32_t> bits_of(Number number) const;

  const ValueType type_;
  const SampleForm form_;
  const bool is_of_layer_;  // the file and the layer store the same bits
  std::optional<Number> nodata_;
};

}  // namespace strata::query
