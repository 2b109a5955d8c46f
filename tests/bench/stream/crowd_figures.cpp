#include "bench/stream/crowd_figures.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <string>

#include "bench/harness.h"

namespace strata::bench {
namespace {

std::uint64_t sum_of(const std::vector<LiveClient::Counts>& all,
                     std::uint64_t LiveClient::Counts::*member) {
  return std::accumulate(
      all.begin(), all.end(), std::uint64_t{0},
      [&](std::uint64_t sum, const auto& counts) { return sum + counts.*member; });
}

// For each camera, adds the time from sending the camera until the last byte of its first frame
// arrives. Later frames of the same camera show other changes.
void add_camera_times(const LiveClient& client, double begin_ms, double end_ms, Samples& times) {
  std::uint64_t shown = 0;
  for (const auto& frame : client.frames()) {
    if (std::exchange(shown, frame.camera_seq) == frame.camera_seq) continue;
    const double sent_ms = client.camera_sent_ms(frame.camera_seq);
    if (sent_ms >= begin_ms && sent_ms < end_ms) times.add(frame.at_ms - sent_ms);
  }
}

// Adds the time from the last camera before the viewer stops to the last byte of the full-quality
// frame.
void add_refined_times(const LiveClient& client, Samples& times) {
  const auto refined = std::ranges::find_if(client.frames(), [&](const auto& frame) {
    return frame.still && frame.camera_seq == client.newest_camera();
  });
  if (refined != client.frames().end())
    times.add(refined->at_ms - client.camera_sent_ms(client.newest_camera()));
}

// Adds the times from a batch to the last byte of the first frame of `viewer` that shows it. The
// sequence of the shown edits never decreases.
void add_batch_times(const LiveClient& painter, const LiveClient& viewer, double begin_ms,
                     double end_ms, Samples& times) {
  for (const auto& batch : painter.batches()) {
    if (!batch.has_changed || batch.since_ms < begin_ms || batch.since_ms >= end_ms) continue;
    const auto& frames = viewer.frames();
    const auto seen =
        std::ranges::lower_bound(frames, *batch.sequence, {}, &LiveClient::Frame::scene_sequence);
    if (seen != frames.end()) times.add(seen->at_ms - batch.since_ms);
  }
}

nlohmann::json of_times(const Samples& times) {
  return times.empty() ? nlohmann::json() : times.json();
}

nlohmann::json of_rates(std::vector<double> rates) {
  if (rates.empty()) return nullptr;
  std::ranges::sort(rates);
  return {{"viewers", rates.size()},
          {"min", rates.front()},
          {"median", rates[rates.size() / 2]},
          {"max", rates.back()}};
}

}  // namespace

std::uint64_t CrowdMoment::bytes() const {
  return sum_of(active, &LiveClient::Counts::bytes) + sum_of(idle, &LiveClient::Counts::bytes);
}

nlohmann::json crowd_figures(const CrowdCase& crowd, const Viewers& active, const Viewers& idle,
                             const CrowdMoment& begin, const CrowdMoment& end) {
  const double seconds = (end.at_ms - begin.at_ms) / 1e3;
  std::vector<double> turning_rates, painting_rates, active_bytes, idle_rates;
  Samples camera, refined, own, turning, still, at_rest;
  std::uint64_t batches = 0, unchanged = 0, refused = 0, unanswered = 0;
  for (std::size_t i = 0; i < active.size(); ++i) {
    const LiveClient& client = *active[i];
    const bool paints = crowd.paints(int(i));
    (paints ? painting_rates : turning_rates)
        .push_back(double(end.active[i].frames - begin.active[i].frames) / seconds);
    active_bytes.push_back(double(end.active[i].bytes - begin.active[i].bytes) / seconds);
    if (!paints) {
      add_camera_times(client, begin.at_ms, end.at_ms, camera);
      if (crowd.hands != Hands::rest) add_refined_times(client, refined);
      continue;
    }
    refused += std::uint64_t(client.refused());
    unanswered += std::uint64_t(client.unanswered());
    for (const auto& batch : client.batches()) {
      if (batch.since_ms < begin.at_ms || batch.since_ms >= end.at_ms) continue;
      ++batches;
      unchanged += batch.sequence && !batch.has_changed;
    }
    for (std::size_t other = 0; other < active.size(); ++other)
      add_batch_times(client, *active[other], begin.at_ms, end.at_ms,
                      other == i                 ? own
                      : crowd.paints(int(other)) ? still
                                                 : turning);
    for (const auto& viewer : idle)
      add_batch_times(client, *viewer, begin.at_ms, end.at_ms, at_rest);
  }
  for (std::size_t i = 0; i < idle.size(); ++i)
    idle_rates.push_back(double(end.idle[i].frames - begin.idle[i].frames) / seconds);

  const auto rate = [&](const auto& before, const auto& after,
                        std::uint64_t LiveClient::Counts::*member) {
    return double(sum_of(after, member) - sum_of(before, member)) / seconds;
  };
  using Counts = LiveClient::Counts;
  const double frames =
      rate(begin.active, end.active, &Counts::frames) + rate(begin.idle, end.idle, &Counts::frames);
  const double server_cores = (end.server.server - begin.server.server) / seconds;
  nlohmann::json json{{"seconds", seconds},
                      {"cores",
                       {{"server", server_cores},
                        {"postgresql", (end.server.postgresql - begin.server.postgresql) / seconds},
                        {"bench", (end.bench_s - begin.bench_s) / seconds}}},
                      {"frames_per_s",
                       {{"turning", of_rates(turning_rates)},
                        {"painting", of_rates(painting_rates)},
                        {"idle", of_rates(idle_rates)}}},
                      {"frames_per_cpu_s",
                       server_cores > 0 ? nlohmann::json(frames / server_cores) : nlohmann::json()},
                      {"bytes_per_s",
                       {{"an_active_viewer", of_rates(active_bytes)},
                        {"all_active", rate(begin.active, end.active, &Counts::bytes)},
                        {"all_idle", rate(begin.idle, end.idle, &Counts::bytes)},
                        {"all_idle_on_the_wire", rate(begin.idle, end.idle, &Counts::wire_bytes)}}},
                      {"camera_to_last_byte", of_times(camera)},
                      {"last_camera_to_full_quality", of_times(refined)}};
  if (batches > 0)
    json["strokes"] = {{"batches_per_s", double(batches) / seconds},
                       {"unchanged", unchanged},
                       {"refused", refused},
                       {"unanswered", unanswered},
                       {"to_own_pixels", of_times(own)},
                       {"to_others_pixels",
                        {{"still", of_times(still)},
                         {"turning", of_times(turning)},
                         {"idle", of_times(at_rest)}}}};
  return json;
}

}  // namespace strata::bench
