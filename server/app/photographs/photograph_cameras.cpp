#include "app/photographs/photograph_cameras.h"

#include <algorithm>
#include <utility>

#include "domain/people/question.h"

namespace strata::app {
namespace {

constexpr std::size_t kKnownCameras = 16;
constexpr std::size_t kChecksAtOnce = 64;

}  // namespace

std::optional<glm::ivec2> size_of(const store::Photograph& photograph) {
  if (photograph.original)
    return glm::ivec2(photograph.original->width, photograph.original->height);
  const photo::Calibration& calibration = photograph.posed.calibration;
  if (calibration.width == 0) return std::nullopt;
  return glm::ivec2(calibration.width, calibration.height);
}

PhotographCameras::Known* PhotographCameras::known(const store::Photograph& photograph) {
  const auto size = size_of(photograph);
  if (!size) return nullptr;
  const photo::Calibration& calibration = photograph.posed.calibration;
  for (Known& known : known_)
    if (known.size == *size && known.calibration == calibration) return &known;
  Known made{calibration, *size, {}, {}};
  if (auto camera = photo::camera_for(calibration, size->x, size->y)) made.camera = *camera;
  if (known_.size() < kKnownCameras) return &known_.emplace_back(std::move(made));
  Known& replaced = known_[next_];
  next_ = (next_ + 1) % kKnownCameras;
  replaced = std::move(made);
  return &replaced;
}

const photo::Camera* PhotographCameras::camera_of(const store::Photograph& photograph) {
  Known* found = known(photograph);
  return found && found->camera ? &*found->camera : nullptr;
}

const Pinhole* PhotographCameras::pinhole_of(const store::Photograph& photograph) {
  Known* found = known(photograph);
  if (!found || !found->camera) return nullptr;
  if (!found->pinhole) found->pinhole = app::pinhole_of(*found->camera);
  return *found->pinhole ? &**found->pinhole : nullptr;
}

SeeingPhotographs photographs_seeing(const PlaceView& place,
                                     std::vector<store::Photograph> photographs,
                                     std::size_t limit) {
  SeeingPhotographs found;
  std::vector<std::pair<PlaceInPhotograph, std::size_t>> seen;
  PhotographCameras cameras;
  const QuestionTurn turn;
  for (std::size_t i = 0; i < photographs.size(); ++i) {
    if (i % kChecksAtOnce == 0) turn.check(kChecksAtOnce);
    const store::Photograph& photograph = photographs[i];
    if (!place.may_be_seen_from(photograph.posed.pose)) continue;
    const photo::Camera* camera = cameras.camera_of(photograph);
    if (!camera) {
      ++found.unknown_size;
      continue;
    }
    if (auto in_it = place.in(*camera, photograph.posed.pose)) seen.emplace_back(*in_it, i);
  }
  found.total = seen.size();
  const auto best = std::min(limit, seen.size());
  std::partial_sort(seen.begin(), seen.begin() + static_cast<std::ptrdiff_t>(best), seen.end(),
                    [&](const auto& a, const auto& b) {
                      const double one = a.first.resolution(), other = b.first.resolution();
                      if (one != other) return one > other;
                      return photographs[a.second].id < photographs[b.second].id;
                    });
  for (std::size_t i = 0; i < best; ++i)
    found.best.push_back({std::move(photographs[seen[i].second]), seen[i].first});
  return found;
}

}  // namespace strata::app
