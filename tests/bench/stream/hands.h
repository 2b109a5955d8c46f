#pragma once

#include <boost/asio/awaitable.hpp>
#include <glm/glm.hpp>
#include <string>

#include "bench/stream/live_client.h"
#include "domain/scene/camera.h"

namespace strata::bench {

// The scene of a case's viewers.
struct Stage {
  std::string model, layer;  // slugs; `layer` is the topmost, painted one; empty without layers
  int layers = 0;
  glm::dvec3 low{0}, high{0};  // world
  int width = 1280, height = 720;
  double radius_px = 40;

  Camera from(double angle, double elevation = 0.4) const;
};

// Actions of a viewer, until `stop`. As the page does, sends a camera for each refresh of the
// screen (16 ms), without waiting for frames, and a batch of a stroke every 30 ms.
boost::asio::awaitable<void> turn(LiveClient& client, const Stage& stage, double angle,
                                  const bool& stop);
// Sends each camera after the picture of the previous one: measures a picture without its wait for
// a turn.
boost::asio::awaitable<void> turn_step_by_step(LiveClient& client, const Stage& stage, double angle,
                                               const bool& stop);
// Paints strokes of 20 batches with a camera at rest, each with another value. Waits while
// kMaxUnanswered batches are not applied: more would only make the queue, and with it every time,
// longer.
constexpr int kMaxUnanswered = 16;
boost::asio::awaitable<void> paint(LiveClient& client, const Stage& stage, double angle,
                                   unsigned seed, const bool& stop);

}  // namespace strata::bench
