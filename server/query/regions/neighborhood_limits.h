#pragma once

#include <string>

#include "core/error.h"

namespace strata::query {

// The limits of neighborhoods, in texels of the mean size. They depend on the resolution of a layer
// and not on its content, so that requests can check them before a job runs.

// The largest radius. Bounds the time per texel.
inline constexpr double kMaxDiscTexels = 40;
// The least and the largest width of lines (query/regions/line_depth).
inline constexpr double kMinLineTexels = 2, kMaxLineTexels = 22;
// The least range of an interpolation (query/interpolation/interpolate).
inline constexpr double kMinRangeTexels = 20;

// Each function returns an `invalid` error if its first argument (model units) is outside of its
// limits or not a number. `texel_size` is the side of a texel of the mean area, in model units:
// mean_texel_size (query/regions/texel_discs) of a map, or reported_texel_size
// (domain/scene/model_measures). These two differ by less than 1 %. So the limits in the messages
// are 1 % inside of the true ones, and a user who follows a message is not refused again.

// For focal_values and hot_spot_chances. The error names `field`, like that of the next two.
Result<void> check_focal_radius(double radius, double texel_size, const std::string& field);
// For line_depth_values.
Result<void> check_line_width(double width, double texel_size, const std::string& field);
// For interpolated_values, which needs a larger range for some surfaces and readings.
Result<void> check_interpolation_range(double range, double texel_size, const std::string& field);
// For majority, whose limit is less for a layer with many borders. The error names `radius_mm`.
Result<void> check_majority_radius(double radius, double texel_size, double metres_per_unit);

// Returns a length for a message, rounded down to three digits.
std::string millimetres_for_message(double metres);

}  // namespace strata::query
