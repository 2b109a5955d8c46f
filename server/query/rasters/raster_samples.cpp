#include "query/rasters/raster_samples.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <limits>

namespace strata::query {
namespace {

using Kind = SampleForm::Kind;

static_assert(std::numeric_limits<long double>::digits >= 64);

Kind kind_of(ValueType type) {
  if (is_float(type)) return Kind::real;
  return lowest_value(type) < 0 ? Kind::signed_whole : Kind::unsigned_whole;
}

double half_of(std::uint64_t bits) {
  return decode_value(ValueType::f16, static_cast<std::uint32_t>(bits));
}

// Rounds the number to the precision of the samples in the file.
long double rounded(double nodata, const SampleForm& form) {
  if (form.kind == Kind::real && form.bytes == 4) return static_cast<float>(nodata);
  if (form.kind == Kind::real && form.bytes == 2)
    if (const auto half = encode_value(ValueType::f16, nodata)) return half_of(*half);
  return nodata;
}

std::string number_text(long double number) {
  char text[64];
  const bool is_whole = number == std::floor(number) && std::abs(number) < 2e19L;
  std::snprintf(text, sizeof text, is_whole ? "%.0Lf" : "%.9Lg", number);
  return text;
}

}  // namespace

std::string describe(const SampleForm& form) {
  if (form.kind == Kind::truth) return "truth values";
  const char* kind = form.kind == Kind::real           ? "floating-point numbers"
                     : form.kind == Kind::signed_whole ? "signed whole numbers"
                                                       : "unsigned whole numbers";
  return std::to_string(8 * form.bytes) + "-bit " + kind;
}

SampleReader::SampleReader(const Layer& layer, const SampleForm& form, std::optional<double> nodata)
    : type_(layer.type),
      form_(form),
      is_of_layer_(form.kind == kind_of(layer.type) && form.bytes == bytes_per_texel(layer.type) &&
                   (form.bytes == 1 || !form.is_big_endian)) {
  if (nodata) nodata_ = rounded(*nodata, form);
}

SampleReader::Number SampleReader::number(const std::uint8_t* sample) const {
  std::array<std::uint8_t, 8> bytes{};
  std::copy_n(sample, form_.bytes, bytes.begin());
  if (form_.is_big_endian) std::reverse(bytes.begin(), bytes.begin() + form_.bytes);
  std::uint64_t bits = 0;
  std::memcpy(&bits, bytes.data(), bytes.size());
  switch (form_.kind) {
    case Kind::truth: return bits != 0 ? 1 : 0;
    case Kind::unsigned_whole: return static_cast<Number>(bits);
    case Kind::signed_whole: {
      const int unused = 64 - 8 * form_.bytes;
      return static_cast<Number>(static_cast<std::int64_t>(bits << unused) >> unused);
    }
    case Kind::real: break;
  }
  if (form_.bytes == 2) return half_of(bits);
  if (form_.bytes == 4) return std::bit_cast<float>(static_cast<std::uint32_t>(bits));
  return std::bit_cast<double>(bits);
}

bool SampleReader::is_nodata(const std::uint8_t* sample) const {
  if (form_.kind != Kind::real && !nodata_) return false;
  const Number value = number(sample);
  return std::isnan(value) || (nodata_ && value == *nodata_);
}

std::optional<std::uint32_t> SampleReader::bits_of(Number number) const {
  if (!(number >= lowest_value(type_) && number <= highest_value(type_))) return std::nullopt;
  const auto bits = encode_value(type_, static_cast<double>(number));
  if (!bits) return std::nullopt;
  const bool may_round = is_float(type_) && form_.kind == Kind::real;
  if (!may_round && decode_value(type_, *bits) != number) return std::nullopt;
  return *bits;
}

Result<void> SampleReader::put(TileMapBuilder& builder, int x, int file_row,
                               const std::uint8_t* sample) const {
  if (is_of_layer_) return builder.put(x, file_row, sample);
  const Number value = number(sample);
  const auto bits = bits_of(value);
  if (!bits) {
    const bool is_inexact = is_float(type_) && form_.kind != Kind::real;
    return refuse_raster("The value " + number_text(value) + " in column " + std::to_string(x) +
                         " of row " + std::to_string(file_row) +
                         " cannot be stored in a layer of " + std::string(name(type_)) +
                         (is_inexact ? " without rounding."
                                     : std::string(", which stores ") +
                                           (is_float(type_) ? "numbers" : "whole numbers") +
                                           " from " + number_text(lowest_value(type_)) + " to " +
                                           number_text(highest_value(type_)) + "."));
  }
  std::array<std::uint8_t, sizeof *bits> stored{};
  std::memcpy(stored.data(), &*bits, sizeof *bits);
  return builder.put(x, file_row, stored.data());
}

}  // namespace strata::query
