#pragma once

#include <glm/glm.hpp>
#include <optional>

#include "core/error.h"
#include "media/photographs/lens.h"

namespace strata::photo {

// Cameras of photographs. (domain/scene/camera.h has the cameras of views.)
//
// Pixels: the origin is the upper left corner of the photograph as it is stored, without the turn
// that its Exif data requests. y points down, and pixel centers are at +0.5, as in COLMAP and
// Metashape.

constexpr int kMaxPhotographSide = 100'000;  // pixels

// The unit of the lengths of a calibration.
enum class CalibrationUnit {
  pixel,
  longest_side,  // of the photograph, as in RealityCapture
};

// The intrinsics of a camera as a file states them: a distorted direction (x', y') has its pixel at
//   focal.x x' + skew y' + offset.x + half the width,   focal.y y' + offset.y + half the height
struct Calibration {
  int width = 0, height = 0;  // pixels; 0 if the file does not state the size of the photograph
  CalibrationUnit unit = CalibrationUnit::pixel;
  glm::dvec2 focal{0};   // B1 of Metashape is focal.x - focal.y
  glm::dvec2 offset{0};  // of the principal point from the center of the photograph, y down
  double skew = 0;       // B2 of Metashape
  Lens lens;
  bool operator==(const Calibration&) const = default;
};

// Returns an `invalid` error for focal lengths that are not positive, for numbers that are not
// finite or too large, and for sides above kMaxPhotographSide. The detail is a sentence without a
// place.
Result<void> check(const Calibration& calibration);

// The camera of a photograph with a size. `camera_for` makes it.
struct Camera {
  int width = 0, height = 0;  // pixels
  glm::dvec2 focal{0};        // pixels
  glm::dvec2 principal_point{0};
  double skew = 0;
  Lens lens;
  double valid_radius = 0;  // of the lens
};

// Returns the camera of a photograph of `width` × `height` pixels. If the calibration states
// another size, the photograph must be a smaller or larger copy, with the same ratio of its sides
// up to one pixel. Otherwise it was cropped or turned after the alignment, and the result is an
// `invalid` error. Fails also as `check` does.
Result<Camera> camera_for(const Calibration& calibration, int width, int height);

// Where a camera is, in world coordinates of double precision.
struct Pose {
  glm::dmat3 camera_from_world{1.0};  // a rotation; camera axes: x right, y down, z into the scene
  glm::dvec3 center{0};
};

struct Ray {
  glm::dvec3 origin;     // the center of the camera
  glm::dvec3 direction;  // unit length, into the scene
};

// Returns the pixel of a point in world coordinates, also outside of the photograph (`is_inside`).
// Returns nothing for a point in the plane of the camera or behind it, for a point outside of the
// valid radius of the lens, and where tangential distortion folds the picture.
std::optional<glm::dvec2> project(const Camera& camera, const Pose& pose, const glm::dvec3& world);

constexpr double kMaxRayError = 1e-6;  // pixels

// Returns the ray of a pixel, which may be outside of the photograph. The projection of the points
// of the ray differs from `pixel` by at most kMaxRayError, apart from the rounding of the world
// coordinates of the point. Returns nothing where no direction within the valid radius of the lens
// has this pixel, or none can be found with this precision.
std::optional<Ray> ray_through(const Camera& camera, const Pose& pose, const glm::dvec2& pixel);

inline bool is_inside(const Camera& camera, const glm::dvec2& pixel) {
  return pixel.x >= 0 && pixel.y >= 0 && pixel.x < camera.width && pixel.y < camera.height;
}

}  // namespace strata::photo
