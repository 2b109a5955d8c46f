#include "query/regions/neighborhood_limits.h"

#include <cmath>
#include <cstdio>

namespace strata::query {
namespace {

// Of the limits in messages. More than the rounding to three digits takes back.
constexpr double kBelow = 0.99, kAbove = 1.01;

std::string three_digits(double number) {
  char text[48];
  std::snprintf(text, sizeof text, "%.3g", number);
  return text;
}

std::string whole(double texels) { return std::to_string(static_cast<int>(texels)); }

}  // namespace

Result<void> check_focal_radius(double radius, double texel_size, const std::string& field) {
  const double most = kMaxDiscTexels * texel_size;
  if (radius <= most && most > 0) return {};
  return fail(ErrorCode::invalid, "Radius too large",
              "The radius of a neighborhood on this layer can be at most " +
                  three_digits(kBelow * most) + " model units, which is " + whole(kMaxDiscTexels) +
                  " texels. Choose a smaller radius, or a layer with larger texels "
                  "(`resolution`).",
              field);
}

Result<void> check_line_width(double width, double texel_size, const std::string& field) {
  const double least = kMinLineTexels * texel_size, most = kMaxLineTexels * texel_size;
  if (width >= least && width <= most) return {};
  return fail(ErrorCode::invalid, "Width out of range",
              "The width of lines on this layer can be " + three_digits(kAbove * least) + " to " +
                  three_digits(kBelow * most) + " model units, which is " + whole(kMinLineTexels) +
                  " to " + whole(kMaxLineTexels) +
                  " texels. Choose another width, or a layer with texels of another size "
                  "(`resolution`).",
              field);
}

Result<void> check_interpolation_range(double range, double texel_size, const std::string& field) {
  const double least = kMinRangeTexels * texel_size;
  if (range >= least && range > 0) return {};
  return fail(ErrorCode::invalid, "Range too small",
              "The range on this layer must be " + three_digits(kAbove * least) +
                  " model units or more, which is " + whole(kMinRangeTexels) +
                  " texels. Choose a larger range, or a layer with smaller texels "
                  "(`resolution`).",
              field);
}

Result<void> check_majority_radius(double radius, double texel_size, double metres_per_unit) {
  const double most = kMaxDiscTexels * texel_size;
  if (radius <= most) return {};
  return fail(ErrorCode::invalid, "Radius too large",
              "The radius for this layer can be at most " +
                  millimetres_for_message(kBelow * most * metres_per_unit) + ", which is " +
                  whole(kMaxDiscTexels) + " texels. Choose a smaller radius.",
              "radius_mm");
}

std::string millimetres_for_message(double metres) {
  const double mm = metres * 1000, step = std::pow(10, std::floor(std::log10(mm)) - 2);
  return three_digits(std::floor(mm / step) * step) + " mm";
}

}  // namespace strata::query
