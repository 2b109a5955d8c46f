#pragma once

#include <optional>
#include <vector>

#include "app/photographs/pinhole.h"
#include "app/photographs/seeing.h"
#include "store/content/photographs.h"

namespace strata::app {

// Returns the size of the original in pixels, or of the calibration if there is no image. Returns
// nothing if both are unknown.
std::optional<glm::ivec2> size_of(const store::Photograph& photograph);

// Makes the cameras of photographs. Photographs of one sensor have the same calibration, so it
// keeps the last cameras. Not thread-safe.
class PhotographCameras {
 public:
  // Return null if the size of the photograph is unknown, or its calibration does not fit. The
  // result is valid until the next call.
  const photo::Camera* camera_of(const store::Photograph& photograph);
  const Pinhole* pinhole_of(const store::Photograph& photograph);

 private:
  struct Known {
    photo::Calibration calibration;
    glm::ivec2 size{0};
    std::optional<photo::Camera> camera;
    std::optional<Result<Pinhole>> pinhole;
  };
  Known* known(const store::Photograph& photograph);

  std::vector<Known> known_;
  std::size_t next_ = 0;  // is replaced next
};

struct SeeingPhotograph {
  store::Photograph photograph;
  PlaceInPhotograph place;
};
struct SeeingPhotographs {
  std::vector<SeeingPhotograph> best;  // best first
  std::size_t total = 0;
  std::size_t unknown_size = 0;  // photographs that may see the place, but have no size
};

// Returns the best `limit` photographs that see the place, sorted by PlaceInPhotograph::resolution
// and then by id. Checks the current question.
SeeingPhotographs photographs_seeing(const PlaceView& place,
                                     std::vector<store::Photograph> photographs, std::size_t limit);

}  // namespace strata::app
