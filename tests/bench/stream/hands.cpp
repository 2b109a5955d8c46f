#include "bench/stream/hands.h"

#include <algorithm>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/this_coro.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <cmath>
#include <utility>
#include <vector>

#include "bench/harness.h"
#include "bench/stream/wander.h"

namespace strata::bench {
namespace {

namespace asio = boost::asio;
using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

constexpr double kTurnStep_rad = 0.008;
constexpr auto kCameraEvery = 16ms;
constexpr auto kMoveEvery = 30ms;
constexpr int kMovesOfStroke = 20;
constexpr double kLongestWait_ms = 250;  // as in web-client/src/net/stroke.ts

// A timer with regular ticks. It does not repeat missed ticks.
class Beat {
 public:
  Beat(const asio::any_io_executor& executor, Clock::duration every)
      : every_(every), next_(Clock::now()), timer_(executor) {}
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
  Beat beat(co_await asio::this_coro::executor, kMoveEvery);
  const Camera camera = stage.from(angle);
  Wander hand(stage.width, stage.height, seed);
  unsigned stroke = seed;
  while (!stop && !client.is_lost()) {
    client.begin_stroke(stage.layer, camera, 1 + ++stroke % 200, stage.radius_px);
    std::vector<glm::dvec2> path;
    double since_ms = 0;
    const auto send = [&] {
      if (!path.empty()) client.extend_stroke(std::exchange(path, {}), since_ms);
    };
    for (int i = 0; i < kMovesOfStroke && !stop && !client.is_lost(); ++i) {
      if (path.empty()) {
        path.push_back(hand.at());
        since_ms = now_ms();
      }
      path.push_back(hand.step());
      if (!client.is_behind() || now_ms() - since_ms >= kLongestWait_ms) send();
      co_await beat.next();
    }
    send();
    client.end_stroke();
  }
}

}  // namespace strata::bench
