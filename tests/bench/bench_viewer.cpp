// Measures one client at 720p, in this process and without a socket: the time from a stroke to its
// pixels, the frames of a moving camera, and the bytes stored during steady painting.
#include <cmath>
#include <future>
#include <iostream>
#include <map>
#include <random>
#include <thread>
#include <utility>

#include "bench/bench_commands.h"
#include "bench/bench_mesh.h"
#include "bench/harness.h"
#include "bench/stream/frame_client.h"
#include "bench/stream/wander.h"
#include "jobs/import_job.h"
#include "room/edit.h"
#include "room/edits.h"
#include "room/layers.h"
#include "room/participants.h"
#include "room/queries.h"
#include "room/room.h"
#include "room/rooms.h"
#include "store/content/models.h"
#include "store/content/projects.h"
#include "store/journal/journal_merger.h"
#include "store/journal/journal_reads.h"

namespace strata::bench {
namespace {

struct Options {
  std::string model = "pot:100000", cache = "build/bench", json;
  int layers = 3, strokes = 200, frames = 300, minutes = 1;
  double radius = 40;
};

class OneViewer {
 public:
  explicit OneViewer(const Options& options) : options_(options) {
    // Imports the generated pot from a PLY file that the bench writes, through the store as for any
    // model.
    store::NewModel made;
    made.model.name = made.model.slug = "bench";
    made.model.project_id = must(site_.store->projects().find("default")).id;
    made.model.origin = bench_.geometry->origin;
    made.model.triangles = bench_.geometry->triangle_count();
    made.model.vertices = bench_.geometry->positions.size();
    made.model.bounds_min = bench_.geometry->origin + glm::dvec3(bench_.geometry->box_min);
    made.model.bounds_max = bench_.geometry->origin + glm::dvec3(bench_.geometry->box_max);
    made.model.area = bench_.area;
    made.geometry = mesh::encode_geometry(*bench_.geometry);
    model_ = must(site_.store->models().create(made, [] { return false; }));
    room_ = must(site_.rooms->open(model_.slug, Role::owner));
    for (int i = 0; i < options.layers; ++i) add_filled_layer(i);
    member_ = room_->participants().join(
        {"bench", Role::owner}, {}, nullptr,
        [&](const stream::FrameMessages& frame) { client_.receive(frame); });
    member_->camera(0, ++camera_number_, still_, false);
    client_.wait_for(*member_, [&](const auto& a) {
      return a.header.still && a.header.camera_seq == camera_number_.load();
    });
  }

  // Measures the time until a stroke's pixels have changed, with a camera at rest.
  nlohmann::json strokes() {
    Samples to_pixels, to_durable;
    std::uint64_t changed_bytes = 0;
    for (int i = 0; i < options_.strokes + 20; ++i) {
      const glm::dvec2 from = on_the_model();
      const double start = now_ms();
      std::atomic<double> durable{0};
      auto request = stroke_request(layers_.back(), still_, {from, from + glm::dvec2(12, 5)},
                                    options_.radius, 1 + i % 200);
      std::promise<std::int64_t> sequence;
      auto sequence_known = sequence.get_future();
      std::promise<void> saved;
      room_->edits().submit(
          std::move(request),
          [&](const room::EditAnswer& answer) { sequence.set_value(answer.sequence); },
          [&](Result<room::EditAnswer> answer) {
            must(std::move(answer));
            durable = now_ms() - start;
            saved.set_value();
          });
      const std::int64_t target = sequence_known.get();
      const auto arrival = client_.wait_for(
          *member_, [&](const auto& a) { return std::int64_t(a.header.scene_sequence) >= target; });
      saved.get_future().get();
      if (i < 20) continue;  // warm-up
      to_pixels.add(arrival.at_ms - start);
      to_durable.add(durable);
      changed_bytes += arrival.bytes;
    }
    std::printf(
        "stroke → changed pixels leave: p50 %.1f ms, p95 %.1f ms; durable p50 %.1f ms; %.1f KB a stroke\n",
        to_pixels.median(), to_pixels.quantile(0.95), to_durable.median(),
        double(changed_bytes) / options_.strokes / 1e3);
    return {{"radius", options_.radius},
            {"stroke_to_pixels", to_pixels.json()},
            {"stroke_to_durable", to_durable.json()}};
  }

  // Sends a new camera every 16 ms without waiting for frames, as the animation frames of a browser
  // do.
  nlohmann::json moving_camera() {
    Samples frame_ms, latency_ms;
    std::uint64_t bytes = 0;
    std::atomic<bool> moving{true};
    std::mutex sent_mutex;
    std::map<std::uint64_t, double> sent_ms;  // by camera number
    const std::uint64_t last_still = camera_number_;
    std::thread hand([&] {
      for (int i = 1; moving; ++i) {
        const std::uint64_t number = ++camera_number_;
        {
          std::lock_guard lock(sent_mutex);
          sent_ms[number] = now_ms();
        }
        member_->camera(0, number, camera_at(0.7 + i * 0.008), true);
        std::this_thread::sleep_for(std::chrono::milliseconds(16));
      }
    });
    const double start =
        client_.wait_for(*member_, [&](const auto& a) { return a.header.camera_seq > last_still; })
            .at_ms;
    double last = start;
    for (int i = 0; i < options_.frames; ++i) {
      const auto arrival = client_.wait_for(*member_, [&](const auto& a) { return a.header.last; });
      frame_ms.add(arrival.at_ms - std::exchange(last, arrival.at_ms));
      bytes += arrival.bytes;
      std::lock_guard lock(sent_mutex);
      latency_ms.add(arrival.at_ms - sent_ms.at(arrival.header.camera_seq));
    }
    const double fps = options_.frames / (last - start) * 1000;
    moving = false;
    hand.join();
    std::printf(
        "moving camera: %.1f frames/s, one each %.1f ms (p95 %.1f); camera → last byte p50 %.1f ms, p95 %.1f ms; %.0f KB "
        "a frame\n",
        fps, frame_ms.median(), frame_ms.quantile(0.95), latency_ms.median(),
        latency_ms.quantile(0.95), double(bytes) / options_.frames / 1e3);
    return {{"moving_fps", fps},
            {"moving_frame", frame_ms.json()},
            {"camera_to_last_byte", latency_ms.json()}};
  }

  // Sends each new camera after the frame of the previous one, so the times do not include the wait
  // for earlier frames.
  nlohmann::json cameras_in_turn() {
    Samples latency_ms, render_ms, encode_ms;
    for (int i = 0; i < options_.frames; ++i) {
      const std::uint64_t number = ++camera_number_;
      const double start = now_ms();
      member_->camera(0, number, camera_at(0.3 + i * 0.008), true);
      const auto arrival = client_.wait_for(*member_, [&](const auto& a) {
        return a.header.last && a.header.camera_seq == number && !a.header.still;
      });
      latency_ms.add(arrival.at_ms - start);
      render_ms.add(arrival.header.render_us / 1000.0);
      encode_ms.add(arrival.header.encode_us / 1000.0);
    }
    std::printf(
        "cameras in turn: camera → last byte p50 %.1f ms, p95 %.1f ms (drawn in %.1f ms, encoded in %.1f ms)\n",
        latency_ms.median(), latency_ms.quantile(0.95), render_ms.median(), encode_ms.median());
    return {{"in_turn", latency_ms.json()},
            {"in_turn_render", render_ms.json()},
            {"in_turn_encode", encode_ms.json()}};
  }

  // A batch every 30 ms. The page sends one for each frame of the screen, which is up to twice as
  // many, or fewer if the server has much work. The stored bytes do not depend on the speed of this
  // replay. Merges after each minute, as a server does. The first minutes keep more than later
  // ones, because up to 31 revisions of each tile wait for others before they are packed.
  nlohmann::json steady_painting() {
    constexpr int kBatchesPerMinute = 2000, kBatchesOfStroke = 50;
    const auto stored_mb = [&] {
      return double(must(site_.store->journal().revision_bytes(model_.id))) / 1e6;
    };
    store::JournalMerger merger(site_.store->journal());
    Wander hand(1280, 720, 7);
    Uuid stroke;
    const double mb_at_first = stored_mb();
    std::vector<double> mb_by_minute{mb_at_first};
    double written_mb = 0;
    for (int i = 0; i < options_.minutes * kBatchesPerMinute; ++i) {
      if (i % kBatchesOfStroke == 0) stroke = random_uuid();
      const glm::dvec2 from = hand.at();
      edit_and_wait(*room_, batch_request(stroke, i % kBatchesOfStroke, {from, hand.step()},
                                          1 + (i / kBatchesOfStroke) % 100));
      if ((i + 1) % kBatchesPerMinute != 0) continue;
      written_mb += stored_mb() - mb_by_minute.back();
      must(merger.merge(model_.id, must(site_.store->journal().state(model_.id, {})).epoch,
                        std::chrono::system_clock::now() + std::chrono::hours(1),
                        [] { return true; }));
      mb_by_minute.push_back(stored_mb());
    }
    const double minutes = options_.minutes;
    const int half = options_.minutes / 2;
    const double kept_mb = mb_by_minute.back() - mb_at_first;
    const double late_mb_per_hour =
        (mb_by_minute.back() - mb_by_minute[std::size_t(half)]) * 60 / (minutes - half);
    std::printf(
        "%d min of steady painting write %.0f MB per hour, and keep %.1f MB after merges; their second half keeps %.0f MB per hour\n",
        options_.minutes, written_mb * 60 / minutes, kept_mb, late_mb_per_hour);
    return {{"painted_minutes", options_.minutes},
            {"revision_mb_per_hour", written_mb * 60 / minutes},
            {"merged_mb_per_hour", kept_mb * 60 / minutes},
            {"merged_mb_per_hour_second_half", late_mb_per_hour},
            {"merged_mb_by_minute", mb_by_minute}};
  }

  std::size_t triangles() const { return bench_.geometry->triangle_count(); }
  auto gpu() const { return site_.renderer->info(); }

 private:
  room::EditRequest batch_request(const Uuid& stroke, int n, std::vector<glm::dvec2> path,
                                  double value) const {
    nlohmann::json points = nlohmann::json::array();
    for (const auto& point : path) points.push_back({point.x, point.y});
    auto request = stroke_request(layers_[0], still_, std::move(path), options_.radius, value);
    auto& edit = std::get<room::StrokeEdit>(request.edit);
    edit.stroke = stroke;
    edit.n = n;
    request.record = {{"op", "stroke"}, {"value", value}, {"n", n}, {"path", std::move(points)}};
    return request;
  }
  Camera camera_at(double angle) const {
    return look_at(*bench_.geometry, {std::cos(angle), std::sin(angle), 0.4}, 1280, 720);
  }
  void add_filled_layer(int number) {
    Layer layer;
    layer.name = layer.slug = "layer-" + std::to_string(number);
    layer.type = ValueType::u8;
    layer.resolution = 4096;
    layer.palette = default_palette(layer.type, false);
    layer.opacity = 0.6;
    layer.order = number;
    layers_.push_back(must(room_->layers().create(layer)));
    edit_and_wait(*room_, {random_uuid(),
                           {"bench", Role::owner},
                           layers_.back().id,
                           room::FillEdit{false, std::uint32_t(10 + 20 * number)},
                           {{"op", "fill"}}});
  }
  glm::dvec2 on_the_model() {
    std::uniform_real_distribution<double> x(440, 840), y(200, 520);
    while (true) {
      const glm::dvec2 point{x(random_), y(random_)};
      if (must(room_->queries().pick(still_, point.x, point.y, {})).hit) return point;
    }
  }

  const Options& options_;
  Site site_;
  const BenchMesh bench_ = must(load_bench_mesh(options_.model, {options_.cache}));
  const Camera still_ = camera_at(0.7);
  Model model_;
  std::shared_ptr<room::Room> room_;
  std::vector<Layer> layers_;
  FrameClient client_;
  std::shared_ptr<room::Participant> member_;
  std::atomic<std::uint64_t> camera_number_{0};
  std::mt19937 random_{7};
};

int run(const Options& options) {
  OneViewer viewer(options);
  const auto gpu = viewer.gpu();
  std::printf("%s, %zu triangles, %d layers of 4096², 1280 × 720, r = %.0f px\n",
              options.model.c_str(), viewer.triangles(), options.layers, options.radius);
  nlohmann::json result{{"method", "viewer"},
                        {"model", options.model},
                        {"triangles", viewer.triangles()},
                        {"layers", options.layers}};
  if (options.layers > 0) result.update(viewer.strokes());
  result.update(viewer.moving_camera());
  result.update(viewer.cameras_in_turn());
  if (options.layers > 0) result.update(viewer.steady_painting());
  write_result(options.json, machine(&gpu), nlohmann::json::array({result}));
  return 0;
}

}  // namespace

Command add_viewer(CLI::App& app) {
  auto* command = app.add_subcommand(
      "viewer", "One client in this process: stroke to pixels, moving camera, bytes kept per hour");
  auto options = std::make_shared<Options>();
  command
      ->add_option("--model", options->model,
                   "pot[:TRIANGLES], vessel, excavation, amazon, thai, or a file")
      ->capture_default_str();
  command
      ->add_option("--layers", options->layers,
                   "Filled layers shown; the strokes go to the topmost (0: none are made)")
      ->check(CLI::Range(0, 64))
      ->capture_default_str();
  command->add_option("--radius", options->radius, "Brush radius in pixels")->capture_default_str();
  command->add_option("--strokes", options->strokes)->capture_default_str();
  command->add_option("--frames", options->frames)->capture_default_str();
  command
      ->add_option("--minutes", options->minutes,
                   "Minutes of steady painting, replayed as fast as the machine can")
      ->check(CLI::Range(1, 600))
      ->capture_default_str();
  command->add_option("--cache", options->cache, "Where generated meshes are kept")
      ->capture_default_str();
  command->add_option("--json", options->json, "Write the results here");
  return [options] { return run(*options); };
}

}  // namespace strata::bench
