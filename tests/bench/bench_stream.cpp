// One client at 720p, up to the socket: from a stroke to its pixels, frames of a moving camera, bytes kept of steady painting.
#include <cmath>
#include <condition_variable>
#include <deque>
#include <future>
#include <iostream>
#include <random>
#include <thread>

#include "bench/bench_commands.h"
#include "bench/bench_mesh.h"
#include "bench/harness.h"
#include "jobs/import_job.h"
#include "protocol/frame_header.h"

namespace strata::bench {
namespace {

struct Options {
  std::string model = "pot:100000", cache = "build/bench", json;
  int layers = 3, strokes = 200, frames = 300;
  double radius = 40;
};

// Stands where the socket is: notes when a frame leaves, and acknowledges it as a client that draws at once.
class Client {
 public:
  struct Arrival {
    double at_ms;
    protocol::FrameHeader header;
    std::size_t bytes;
  };
  void receive(stream::FrameBytes frame) {
    const double at = now_ms();
    auto header = must(protocol::decode_frame_header(*frame));
    std::lock_guard lock(mutex_);
    arrivals_.push_back({at, header, frame->size()});
    changed_.notify_all();
  }
  template <class Wanted>
  Arrival wait_for(room::Member& member, Wanted wanted) {
    std::unique_lock lock(mutex_);
    while (true) {
      if (!changed_.wait_for(lock, std::chrono::seconds(30), [&] { return !arrivals_.empty(); })) {
        std::cerr << "strata-bench: no frame came in 30 s" << std::endl;
        std::exit(1);
      }
      const Arrival arrival = arrivals_.front();
      arrivals_.pop_front();
      lock.unlock();
      if (arrival.header.last) member.ack(arrival.header.view_id, arrival.header.frame);
      if (wanted(arrival)) return arrival;
      lock.lock();
    }
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Arrival> arrivals_;
};

int run(const Options& options) {
  Site site;
  Progress progress;
  // Imported through the store like any model, from a PLY the bench writes when it is the generated pot.
  const BenchMesh bench = must(load_bench_mesh(options.model, {options.cache}));
  store::Store::NewModel made;
  made.model.name = made.model.slug = "bench";
  made.model.project_id = must(site.store->project("default")).id;
  made.model.origin = bench.geometry->origin;
  made.model.triangles = bench.geometry->triangle_count();
  made.model.vertices = bench.geometry->positions.size();
  made.model.bounds_min = bench.geometry->origin + glm::dvec3(bench.geometry->box_min);
  made.model.bounds_max = bench.geometry->origin + glm::dvec3(bench.geometry->box_max);
  made.model.area = bench.area;
  made.geometry = mesh::encode_geometry(*bench.geometry);
  const Model model = must(site.store->create_model(made, [] { return false; }));
  auto room = must(site.rooms->open(model.slug));
  std::vector<Layer> layers;
  for (int i = 0; i < options.layers; ++i) {
    Layer layer;
    layer.name = layer.slug = "layer-" + std::to_string(i);
    layer.type = ValueType::u8;
    layer.resolution = 4096;
    layer.palette = default_palette(layer.type, false);
    layer.opacity = 0.6;
    layer.order = i;
    layers.push_back(must(room->create_layer(layer)));
    edit_and_wait(*room, {random_uuid(),
                          "bench",
                          layers.back().id,
                          room::FillEdit{false, std::uint32_t(10 + 20 * i)},
                          {{"op", "fill"}}});
  }

  Client client;
  auto member = room->join("bench", nullptr, [&](stream::FrameBytes frame) { client.receive(std::move(frame)); });
  std::atomic<std::uint64_t> seq{0};
  auto camera_at = [&](double angle) {
    return look_at(*bench.geometry, {std::cos(angle), std::sin(angle), 0.4}, 1280, 720);
  };
  const Camera still = camera_at(0.7);
  member->camera(0, ++seq, still, false);
  client.wait_for(*member, [&](const auto& a) { return a.header.still && a.header.camera_seq == seq.load(); });

  // Stroke to changed pixels, still camera.
  std::mt19937 random(7);
  std::uniform_real_distribution<double> x(440, 840), y(200, 520);
  Samples to_pixels, to_durable;
  std::uint64_t changed_bytes = 0;
  const auto on_the_model = [&] {
    while (true) {
      const glm::dvec2 point{x(random), y(random)};
      if (must(room->pick(still, point.x, point.y, {})).hit) return point;
    }
  };
  for (int i = 0; i < options.strokes + 20; ++i) {
    const glm::dvec2 from = on_the_model();
    const double start = now_ms();
    std::atomic<double> durable{0};
    auto request = stroke_request(layers.back(), still, {from, from + glm::dvec2(12, 5)}, options.radius, 1 + i % 200);
    std::promise<std::int64_t> sequence;
    auto sequence_known = sequence.get_future();
    std::promise<void> saved;
    room->edit(
        std::move(request), [&](const room::EditAnswer& answer) { sequence.set_value(answer.sequence); },
        [&](Result<room::EditAnswer> answer) {
          must(std::move(answer));
          durable = now_ms() - start;
          saved.set_value();
        });
    const std::int64_t wanted = sequence_known.get();
    const auto arrival =
        client.wait_for(*member, [&](const auto& a) { return std::int64_t(a.header.scene_sequence) >= wanted; });
    saved.get_future().get();
    if (i < 20) continue;  // warm
    to_pixels.add(arrival.at_ms - start);
    to_durable.add(durable);
    changed_bytes += arrival.bytes;
  }

  // Moving camera: a new one every 16 ms, as a browser's animation frames send them, whatever has arrived.
  Samples frame_ms;
  std::uint64_t moving_bytes = 0;
  std::atomic<bool> moving{true};
  std::thread hand([&] {
    for (int i = 1; moving; ++i) {
      member->camera(0, ++seq, camera_at(0.7 + i * 0.008), true);
      std::this_thread::sleep_for(std::chrono::milliseconds(16));
    }
  });
  double last = client.wait_for(*member, [&](const auto&) { return true; }).at_ms;
  const double moving_start = last;
  for (int i = 0; i < options.frames; ++i) {
    const auto arrival = client.wait_for(*member, [&](const auto& a) { return a.header.last; });
    frame_ms.add(arrival.at_ms - last);
    last = arrival.at_ms;
    moving_bytes += arrival.bytes;
  }
  const double fps = options.frames / (last - moving_start) * 1000;
  moving = false;
  hand.join();

  // Steady painting: a batch each 30 ms is what a client sends; the bytes do not depend on how fast we replay it.
  const auto bytes_before = must(site.store->revision_bytes(model.id));
  constexpr int kBatches = 400;
  glm::dvec2 at{640, 360};
  double heading = 0;
  for (int i = 0; i < kBatches; ++i) {
    heading += std::uniform_real_distribution<double>(-0.6, 0.6)(random);
    glm::dvec2 next = at + 12.0 * glm::dvec2(std::cos(heading), std::sin(heading));  // 400 px/s
    if (next.x < 440 || next.x > 840 || next.y < 200 || next.y > 520) {
      heading += 2.5;
      next = glm::clamp(next, glm::dvec2(440, 200), glm::dvec2(840, 520));
    }
    edit_and_wait(*room, stroke_request(layers[0], still, {at, next}, options.radius, 1 + (i / 50) % 100));
    at = next;
  }
  const double mb_per_hour =
      double(must(site.store->revision_bytes(model.id)) - bytes_before) / kBatches * (3600 / 0.03) / 1e6;

  const auto gpu = site.renderer->info();
  std::printf("%s, %zu triangles, %d layers of 4096², 1280 × 720, r = %.0f px\n", options.model.c_str(),
              bench.geometry->triangle_count(), options.layers, options.radius);
  std::printf("stroke → changed pixels leave: p50 %.1f ms, p95 %.1f ms; durable p50 %.1f ms; %.1f KB a stroke\n",
              to_pixels.median(), to_pixels.quantile(0.95), to_durable.median(),
              double(changed_bytes) / options.strokes / 1e3);
  std::printf("moving camera: %.1f frames/s, frame p50 %.1f ms, p95 %.1f ms, %.0f KB a frame\n", fps, frame_ms.median(),
              frame_ms.quantile(0.95), double(moving_bytes) / options.frames / 1e3);
  std::printf("steady painting keeps %.0f MB per hour\n", mb_per_hour);
  write_result(options.json, machine(&gpu),
               nlohmann::json::array({{{"method", "stream"},
                                       {"model", options.model},
                                       {"triangles", bench.geometry->triangle_count()},
                                       {"layers", options.layers},
                                       {"radius", options.radius},
                                       {"stroke_to_pixels", to_pixels.json()},
                                       {"stroke_to_durable", to_durable.json()},
                                       {"moving_fps", fps},
                                       {"moving_frame", frame_ms.json()},
                                       {"revision_mb_per_hour", mb_per_hour}}}));
  return 0;
}

}  // namespace

Command add_stream(CLI::App& app) {
  auto* command = app.add_subcommand("stream", "One client: stroke to pixels, moving camera, bytes kept per hour");
  auto options = std::make_shared<Options>();
  command->add_option("--model", options->model, "pot[:TRIANGLES], vessel, excavation, amazon, thai, or a file")
      ->capture_default_str();
  command->add_option("--layers", options->layers, "Filled layers shown; the strokes go to the topmost")
      ->check(CLI::Range(1, 64))
      ->capture_default_str();
  command->add_option("--radius", options->radius, "Brush radius in pixels")->capture_default_str();
  command->add_option("--strokes", options->strokes)->capture_default_str();
  command->add_option("--frames", options->frames)->capture_default_str();
  command->add_option("--cache", options->cache, "Where generated meshes are kept")->capture_default_str();
  command->add_option("--json", options->json, "Write the results here");
  return [options] { return run(*options); };
}

}  // namespace strata::bench
