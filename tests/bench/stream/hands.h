#pragma once

#include <boost/asio/awaitable.hpp>
#include <glm/glm.hpp>
#include <string>

#include "bench/stream/live_client.h"
#include "domain/scene/camera.h"

namespace strata::bench {

// The scene that the viewers of a case show.
struct Stage {
  std::string model, layer;  // slugs; `layer`: the topmost, painted layer, or empty
  int layers = 0;
  glm::dvec3 low{0}, high{0};  // in world coordinates
  int width = 1280, height = 720;
  double radius_px = 40;

  Camera from(double angle, double elevation = 0.4) const;
};

// The actions of a viewer until `stop` is true. Like the page, a turning viewer sends a camera for
// each refresh of the screen (16 ms) without waiting for frames. The hand of a painting viewer
// moves every 30 ms, and sends the points as a batch by the rule of the page
// (web-client/src/net/stroke.ts). Unlike the page, it looks for replies only when it moves.
boost::asio::awaitable<void> turn(LiveClient& client, const Stage& stage, double angle,
                                  const bool& stop);
// Sends each camera after the frame of the previous one, so the times do not include the wait for
// earlier frames.
boost::asio::awaitable<void> turn_step_by_step(LiveClient& client, const Stage& stage, double angle,
                                               const bool& stop);
// Paints strokes of 20 moves with a camera at rest. Each stroke has a new value.
boost::asio::awaitable<void> paint(LiveClient& client, const Stage& stage, double angle,
                                   unsigned seed, const bool& stop);

}  // namespace strata::bench
