#include "bench/stream/crowd.h"

#include <unistd.h>

#include <algorithm>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numbers>

#include "bench/harness.h"

namespace strata::bench {
namespace {

namespace asio = boost::asio;

constexpr std::size_t kOpenAtOnce = 16;  // the server refuses (503) a 257th concurrent request
constexpr double kMaxOpening_s = 600;
constexpr double kQuiet_s = 0.5, kQuietAtRest_s = 2, kMaxSettling_s = 180;
constexpr double kWarming_s = 1;
constexpr double kMaxFinishing_s = 60;

// All directions are within 60°, so the middle of one frame is also in the other frames.
constexpr double kMiddle_rad = 0.7;
double direction(int number, int of) {
  return kMiddle_rad + (of < 2 ? 0 : (double(number) / (of - 1) - 0.5) * std::numbers::pi / 3);
}

}  // namespace

Crowd::Crowd(const CrowdCase& crowd, const Stage& stage, const ServerProcess& server)
    : case_(crowd), stage_(stage), server_(server) {
  if (!crowd.link.is_loopback())
    link_.emplace(context_, crowd.link,
                  asio::ip::tcp::endpoint(asio::ip::address_v4::loopback(), server.port()));
  std::vector<std::pair<LiveClient*, Camera>> all;
  for (int i = 0; i < crowd.active; ++i)
    all.emplace_back(&add(active_), stage.from(direction(i, crowd.active)));
  for (int i = 0; i < crowd.idle; ++i) {
    const double elevation = 0.3 + 0.2 * std::fmod(i * std::numbers::phi, 1.0);
    all.emplace_back(&add(idle_), crowd.is_same_view
                                      ? stage.from(kMiddle_rad)
                                      : stage.from(direction(i, crowd.idle), elevation));
  }
  if (crowd.has_stalled) all.emplace_back(&add(stalled_), stage.from(kMiddle_rad));
  open(std::move(all));
  settle(crowd.hands == Hands::rest ? kQuietAtRest_s : kQuiet_s);
  for (const auto& client : stalled_) client->stop_reading();
}

Crowd::~Crowd() {
  stop_ = true;
  for (const auto* clients : {&active_, &idle_, &stalled_})
    for (const auto& client : *clients) client->leave();
  link_.reset();
  context_.restart();
  context_.run();  // until the last coroutine, which holds a client, has ended
}

LiveClient& Crowd::add(Viewers& to) {
  const asio::ip::tcp::endpoint server(asio::ip::address_v4::loopback(), server_.port());
  return *to.emplace_back(
      std::make_unique<LiveClient>(context_, link_ ? link_->endpoint() : server, server_.port()));
}

void Crowd::open(std::vector<std::pair<LiveClient*, Camera>> clients) {
  std::size_t begun = 0, done = 0;
  const auto one_after_the_other = [&]() -> asio::awaitable<void> {
    while (begun < clients.size()) {
      auto& [client, camera] = clients[begun++];
      co_await client->open(stage_.model, server_.token(), camera);
      ++done;
    }
  };
  for (std::size_t i = 0; i < kOpenAtOnce; ++i)
    asio::co_spawn(context_, one_after_the_other, asio::detached);
  run_until([&] { return done == clients.size(); }, kMaxOpening_s);
  check_nobody_is_lost();
  if (done == clients.size()) return;
  std::fprintf(stderr, "strata-bench: %zu of %zu viewers had no picture after %.0f s\n",
               clients.size() - done, clients.size(), kMaxOpening_s);
  std::exit(1);
}

// Runs until no message has arrived for `quiet_s`. Ignores the bytes of pings, because hundreds of
// connections always exchange some.
void Crowd::settle(double quiet_s) {
  const double limit_ms = now_ms() + 1e3 * kMaxSettling_s;
  std::uint64_t before;
  do {
    before = now().bytes();
    run_for(quiet_s);
  } while (now().bytes() != before && now_ms() < limit_ms);
}

void Crowd::run_for(double seconds) {
  const double end_ms = now_ms() + 1e3 * seconds;
  run_until([&] { return now_ms() >= end_ms; }, seconds + 1);
}

void Crowd::run_until(const std::function<bool()>& condition, double limit_s) {
  const double limit_ms = now_ms() + 1e3 * limit_s;
  while (!condition() && now_ms() < limit_ms) {
    context_.restart();
    context_.run_for(std::chrono::milliseconds(5));
  }
}

void Crowd::start_hands() {
  if (case_.hands == Hands::rest) return;
  for (int i = 0; i < case_.active; ++i) {
    LiveClient& client = *active_[std::size_t(i)];
    const double angle = direction(i, case_.active);
    if (case_.paints(i))
      asio::co_spawn(context_, paint(client, stage_, angle, unsigned(i) * 37, stop_),
                     asio::detached);
    else if (case_.hands == Hands::turn_step_by_step)
      asio::co_spawn(context_, turn_step_by_step(client, stage_, angle, stop_), asio::detached);
    else
      asio::co_spawn(context_, turn(client, stage_, angle, stop_), asio::detached);
  }
  for (const auto& client : stalled_)
    asio::co_spawn(context_, turn(*client, stage_, kMiddle_rad, stop_), asio::detached);
}

nlohmann::json Crowd::measure(double seconds) {
  start_hands();
  run_until([&] { return all_see_what_they_do(); }, kMaxFinishing_s);
  run_for(case_.hands == Hands::rest ? 0 : kWarming_s);
  forget_peak(server_.pid());
  const CrowdMoment begin = now();
  run_for(seconds);
  run_until([&] { return has_painted_since(begin.at_ms); }, kMaxFinishing_s);
  const CrowdMoment end = now();
  const double peak_mib = peak_resident_mib(server_.pid());
  stop_ = true;
  finish_strokes();
  check_nobody_is_lost();
  nlohmann::json json = crowd_figures(case_, active_, idle_, begin, end);
  json["server_mib"] = {{"resident", resident_mib(server_.pid())}, {"peak", peak_mib}};
  return json;
}

// The first stroke of a newly opened model waits for data that later strokes reuse.
bool Crowd::all_see_what_they_do() const {
  for (std::size_t i = 0; i < active_.size(); ++i) {
    const LiveClient& client = *active_[i];
    const auto& newest = client.frames().back();
    const auto is_seen = [&](const auto& batch) {
      return batch.has_changed && newest.scene_sequence >= *batch.sequence;
    };
    if (case_.paints(int(i)) ? std::ranges::none_of(client.batches(), is_seen)
                             : newest.camera_seq < 2)
      return false;
  }
  return true;
}

// Returns whether each painting viewer has sent a batch. On a very busy machine, the first batches
// may wait longer than a short run takes.
bool Crowd::has_painted_since(double begin_ms) const {
  for (std::size_t i = 0; i < active_.size(); ++i) {
    const auto& batches = active_[i]->batches();
    if (case_.paints(int(i)) && (batches.empty() || batches.back().since_ms < begin_ms))
      return false;
  }
  return true;
}

// Waits for the pixels of the last strokes, which may not have arrived yet.
void Crowd::finish_strokes() {
  run_until(
      [&] {
        return std::ranges::all_of(active_, [](const auto& c) { return c->unanswered() == 0; });
      },
      kMaxFinishing_s);
  settle(kQuiet_s);
}

void Crowd::check_nobody_is_lost() const {
  for (const auto* clients : {&active_, &idle_})
    for (const auto& client : *clients) {
      if (!client->is_lost()) continue;
      std::fprintf(stderr, "strata-bench: a viewer was lost: %s\n", client->why_lost().c_str());
      std::exit(1);
    }
}

CrowdMoment Crowd::now() const {
  CrowdMoment moment;
  moment.at_ms = now_ms();
  moment.server = server_.used();
  moment.bench_s = processor_seconds(getpid());
  for (const auto& client : active_) moment.active.push_back(client->counts());
  for (const auto& client : idle_) moment.idle.push_back(client->counts());
  return moment;
}

}  // namespace strata::bench
