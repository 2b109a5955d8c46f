#pragma once

#include <boost/asio/awaitable.hpp>
#include <glm/glm.hpp>
#include <string>

#include "bench/stream/live_client.h"
#include "domain/scene/camera.h"

namespace strata::bench {

// What viewers of a case look at.
struct Stage {
  std::string model, layer;  // slugs; `layer` is painted, the topmost; empty: there is none
  int layers = 0;
  glm::dvec3 low{0}, high{0};  // world
  int width = 1280, height = 720;
  double radius_px = 40;

  Camera from(double angle, double elevation = 0.4) const;
};

// What a person's hand does, until `stop`. As the page sends it: a camera with each picture of the
// screen (16 ms), whatever has arrived; a batch of a stroke each 30 ms.
boost::asio::awaitable<void> turn(LiveClient& client, const Stage& stage, double angle,
                                  const bool& stop);
// Each camera when the picture of the one before is there: what one takes without waiting for its
// turn.
boost::asio::awaitable<void> turn_step_by_step(LiveClient& client, const Stage& stage, double angle,
                                               const bool& stop);
// With a still camera, strokes of 20 batches, each of another value. Whoever has kMaxUnanswered
// batches that are not applied waits: more would only make the queue longer, and every time with
// it.
constexpr int kMaxUnanswered = 16;
boost::asio::awaitable<void> paint(LiveClient& client, const Stage& stage, double angle,
                                   unsigned seed, const bool& stop);

}  // namespace strata::bench
