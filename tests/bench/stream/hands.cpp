#include "bench/stream/hands.h"

#include <algorithm>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/this_coro.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <cmath>

#include "bench/harness.h"
#include "bench/stream/wander.h"

namespace strata::bench {
namespace {

namespace asio = boost::asio;
using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

constexpr double kTurnStep_rad = 0.008;
constexpr auto kCameraEvery = 16ms;
constexpr auto kBatchEvery = 30ms;
constexpr int kBatchesOfStroke = 20;

// A timer with regular ticks. It does not repeat missed ticks.
class Beat {
 public:
  Beat(asio::any_io_executor executor, Clock::duration every)
      : every_(every), next_(Clock::now()), timer_(std::move(executor)) {}
  asio::awaitable<void> next() {
    next_ = std::max(next_ + every_, Clock::now());
    timer_.expires_at(next_);
    co_await timer_.async_wait(asio::use_awaitable);
  }

 private:
  const Clock::duration every_;
  Clock::time_point next_;
  asio::steady_timer timer_;
};

}  // namespace

Camera Stage::from(double angle, double elevation) const {
  return look_at(low, high, {std::cos(angle), std::sin(angle), elevation}, width, height);
}

asio::awaitable<void> turn(LiveClient& client, const Stage& stage, double angle, const bool& stop) {
  Beat beat(co_await asio::this_coro::executor, kCameraEvery);
  while (!stop && !client.is_lost()) {
    client.image(stage.from(angle += kTurnStep_rad), true);
    co_await beat.next();
  }
}

asio::awaitable<void> turn_step_by_step(LiveClient& client, const Stage& stage, double angle,
                                        const bool& stop) {
  while (!stop && !client.is_lost()) {
    client.image(stage.from(angle += kTurnStep_rad), true);
    co_await client.newest_camera_shown();
  }
}

asio::awaitable<void> paint(LiveClient& client, const Stage& stage, double angle, unsigned seed,
                            const bool& stop) {
  Beat beat(co_await asio::this_coro::executor, kBatchEvery);
  const Camera camera = stage.from(angle);
  Wander hand(stage.width, stage.height, seed);
  unsigned stroke = seed;
  while (!stop && !client.is_lost()) {
    client.begin_stroke(stage.layer, camera, 1 + ++stroke % 200, stage.radius_px);
    for (int i = 0; i < kBatchesOfStroke && !stop; ++i) {
      const glm::dvec2 from = hand.at();
      client.extend_stroke({from, hand.step()});
      do co_await beat.next();
      while (client.unanswered() >= kMaxUnanswered && !stop && !client.is_lost());
    }
    client.end_stroke();
  }
}

}  // namespace strata::bench
