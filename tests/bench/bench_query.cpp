// Measures queries of a painted model over HTTP, from this process to itself: on an idle server,
// during painting, for many points, and for statistics.
#include <atomic>
#include <iostream>
#include <random>
#include <thread>

#include "bench/bench_commands.h"
#include "bench/bench_mesh.h"
#include "bench/harness.h"
#include "bench/http_client.h"
#include "bench/stream/frame_client.h"
#include "expression/expression_parser.h"
#include "jobs/import_job.h"
#include "jobs/job_queue.h"
#include "net/transport/server.h"
#include "room/edit.h"
#include "room/layers.h"
#include "room/participants.h"
#include "room/room.h"
#include "room/rooms.h"
#include "room/surface.h"
#include "room/view_settings.h"
#include "store/tables/records.h"
#include "store/tables/tables.h"
#include "strata_dirs.h"

namespace strata::bench {
namespace {

constexpr int kResolution = 4096;

struct Options {
  std::string model = "excavation", cache = "build/bench", json;
  int points = 100'000, requests = 2000;
};

class Queries {
 public:
  explicit Queries(const Options& options) : options_(options), random_(1) {
    jobs::ImportRequest request;
    request.files = must(mesh_files(options.model, options.cache));
    Progress progress;
    model_ = must(jobs::import_model(*site_.store, request, progress));
    room_ = must(site_.rooms->open(model_.slug, Role::owner));
    make_layer("moisture", ValueType::f32, 0.5);
    make_layer("units", ValueType::u16, 7);
    make_layer("salt", ValueType::f32, 0.1);
    paint_spots("units");
    paint_spots("moisture");
    net::ServerOptions server;
    server.port = 0;
    server.owner_token = std::string(40, 'b');
    server.requests_per_second = server.request_burst = 1e9;
    server.protocol_dir = std::filesystem::path(STRATA_SOURCE_DIR) / "protocol/generated";
    server.upload_dir = site_.folder / "uploads";
    server_ = must(net::Server::start(server, *site_.store, *site_.rooms, jobs_, *site_.renderer));
    client_ = std::make_unique<HttpClient>(server_->port(), server.owner_token);
  }
  ~Queries() { server_->stop(); }

  void run() {
    const std::string model = "/models/" + model_.slug;
    add("first point, with the search tree", 0, {get_ms(point_query())});
    add("a point, idle (p99)", 2, points(), 0.99);
    {
      std::atomic<bool> stop{false};
      std::thread painter([&] { paint_until(stop); });
      add("a point while somebody paints (p99)", 10, points(), 0.99);
      stop = true;
      painter.join();
    }
    const std::string many = many_points();
    add("points in one POST, CSV", 300,
        repeated(3, [&] { return post_ms(model + "/positions", many, "text/csv"); }));
    add("points in one POST, JSON", 1000,
        repeated(3, [&] { return post_ms(model + "/positions", many); }));

    for (const std::string layer : {"units", "moisture"}) {
      const std::string path = model + "/layers/" + layer + "/statistics";
      get_ms(path + "?where=valid(" + layer + ")");  // creates the surface map
      add("statistics of " + layer + ", counted anew", 50, repeated(3, [&] {
            refill(layer);
            return get_ms(path);
          }));
      add("statistics of " + layer + " after a stroke", 5, repeated(15, [&] {
            stroke(layer);
            return get_ms(path);
          }));
      add("the same with quantiles", 2000,
          repeated(3, [&] { return get_ms(path + "?include=quantiles"); }));
      add("first with pieces, with the texels' graph", 0, {get_ms(path + "?include=pieces")});
      add("with pieces", 2000, repeated(3, [&] { return get_ms(path + "?include=pieces"); }));
      add("with perimeter", 2000, repeated(3, [&] { return get_ms(path + "?include=perimeter"); }));
    }
    add("an expression over three layers", 100, repeated(5, [&] {
          return post_ms(model + "/select",
                         R"({"where": "moisture * 2 + salt > 0.5 and units <> 3"})");
        }));
    light_up();
    add("a cross-table", 0, repeated(3, [&] {
          return post_ms(model + "/cross-table", R"({"rows": "units", "columns": "units"})");
        }));
    const auto gpu = site_.renderer->info();
    write_result(options_.json, machine(&gpu), results_);
  }

 private:
  double get_ms(const std::string& path) { return client_->get(path).elapsed_ms; }
  double post_ms(const std::string& path, const std::string& body,
                 const char* accept = "application/json") {
    return client_->post(path, body, accept).elapsed_ms;
  }
  // Measures the time from the request for a filter in a view until the socket has the frame that
  // highlights the matching records, at 720p.
  void light_up() {
    make_parts();
    FrameClient viewer;
    auto member = room_->participants().join(
        {"bench", Role::owner}, {}, nullptr,
        [&](const stream::FrameMessages& frame) { viewer.receive(frame); });
    const auto show = [&](const char* filter) {
      room::LayerView parts{layers_.at("parts").id, true, {}, {}, {}};
      if (filter)
        parts.highlight = room::Highlight{
            must(query::parse_condition(filter, "filter", query::Names::columns)), false};
      if (const auto shown = member->show(0, {{parts}, {}, {}}); !shown)
        must(Result<int>(tl::unexpected(shown.error())));
    };
    show(nullptr);
    member->camera(0, 1, camera(), false);
    std::size_t content =
        viewer.wait_for(*member, [](const auto& a) { return a.header.still && a.header.last; })
            .content;
    Samples samples;
    for (int i = 0; i < 20; ++i) {
      const std::string filter =
          "thickness > " + std::to_string(1 + 0.1 * i) + " and state = 'loose'";
      const double start = now_ms();
      show(filter.c_str());
      const auto lit = viewer.wait_for(
          *member, [&](const auto& a) { return a.header.last && a.content != content; });
      content = lit.content;
      samples.add(lit.at_ms - start);
    }
    add("a filter over 10 000 records, to lit pixels", 50, samples);
  }
  // Makes as many records as a large excavation has, each with one patch of the surface.
  void make_parts() {
    constexpr int kParts = 10'000, kSide = 100;  // patches along one side of the atlas
    Layer layer;
    layer.name = layer.slug = "parts";
    layer.kind = LayerKind::database;
    layer.type = ValueType::u16;
    layer.resolution = kResolution;
    layer.palette = default_palette(layer.type, true);
    Column thickness, state;
    thickness.name = thickness.slug = "thickness", thickness.kind = ColumnKind::numeric;
    state.name = state.slug = "state", state.kind = ColumnKind::enumeration,
    state.choices = {"loose", "firm"};
    const Layer made = layers_["parts"] =
        must(room_->layers().create(layer, {}, {thickness, state}));
    const Table table = must(site_.store->tables().find(to_string(*made.table), Role::owner));
    store::WriteRecords records;
    for (int i = 0; i < kParts; ++i)
      records.records.push_back({{},
                                 {{table.columns[0].id, (i * 7 % 1000) / 100.0},
                                  {table.columns[1].id, i % 3 ? "firm" : "loose"}}});
    must(site_.store->records().write(table.id, records, "bench"));
    TileMap tiles;
    for (int ty = 0; ty < kResolution / kTileSize; ++ty) {
      for (int tx = 0; tx < kResolution / kTileSize; ++tx) {
        auto tile = std::make_shared<TileData>(layer.type);
        for (int texel = 0; texel < kTexelsPerTile; ++texel) {
          const int x = tx * kTileSize + texel % kTileSize, y = ty * kTileSize + texel / kTileSize;
          tile->write(texel, static_cast<std::uint32_t>(1 + y * kSide / kResolution * kSide +
                                                        x * kSide / kResolution));
        }
        tiles[{static_cast<std::uint16_t>(tx), static_cast<std::uint16_t>(ty)}] = std::move(tile);
      }
    }
    edit_and_wait(*room_, {random_uuid(),
                           {"bench", Role::owner},
                           made.id,
                           room::ImportEdit{std::move(tiles), false},
                           {{"op", "import"}}});
  }
  void make_layer(const std::string& name, ValueType type, double value) {
    Layer layer;
    layer.name = layer.slug = name;
    layer.type = type;
    layer.resolution = kResolution;
    layer.palette = default_palette(type, false);
    layers_[name] = must(room_->layers().create(layer));
    refill(name, value);
  }
  void refill(const std::string& name, std::optional<double> value = {}) {
    const Layer& layer = layers_.at(name);
    const double filled =
        value.value_or(is_float(layer.type) ? 0.001 * ++fills_ : double(100 + ++fills_ % 100));
    edit_and_wait(*room_, {random_uuid(),
                           {"bench", Role::owner},
                           layer.id,
                           room::FillEdit{false, must(encode_value(layer.type, filled)), {}},
                           {{"op", "fill"}}});
  }
  Camera camera() const { return look_at(*room_->surface().geometry(), {0.5, -1, 0.6}, 1280, 720); }
  void stroke(const std::string& name) {
    const double x = 400 + static_cast<double>(random_() % 480),
                 y = 200 + static_cast<double>(random_() % 320);
    edit_and_wait(*room_, stroke_request(layers_.at(name), camera(), {{x, y}, {x + 30, y + 10}}, 20,
                                         static_cast<double>(random_() % 20)));
  }
  void paint_spots(const std::string& name) {
    for (int i = 0; i < 30; ++i) stroke(name);
  }
  void paint_until(const std::atomic<bool>& stop) {
    std::mt19937 random(5);
    const Camera view = camera();
    while (!stop) {
      const double x = 400 + static_cast<double>(random() % 480),
                   y = 200 + static_cast<double>(random() % 320);
      edit_and_wait(*room_,
                    stroke_request(layers_.at("units"), view, {{x, y}, {x + 8, y + 3}}, 20, 3));
      std::this_thread::sleep_for(std::chrono::milliseconds(30));
    }
  }

  glm::dvec3 place() {
    const auto geometry = room_->surface().geometry();
    std::uniform_real_distribution<double> jitter(-1, 1);
    const double reach = 0.002 * glm::length(model_.bounds_max - model_.bounds_min);
    return geometry->positions[random_() % geometry->positions.size()] +
           reach * glm::dvec3(jitter(random_), jitter(random_), jitter(random_));
  }
  std::string point_query() {
    const auto p = place();
    char text[200];
    std::snprintf(text, sizeof text, "/models/%s/position?coords=POINT%%20Z(%.6f%%20%.6f%%20%.6f)",
                  model_.slug.c_str(), p.x, p.y, p.z);
    return text;
  }
  Samples points() {
    Samples samples;
    for (int i = 0; i < options_.requests; ++i) samples.add(get_ms(point_query()));
    return samples;
  }
  std::string many_points() {
    nlohmann::json list = nlohmann::json::array();
    for (int i = 0; i < options_.points; ++i) {
      const auto p = place();
      list.push_back({p.x, p.y, p.z});
    }
    return nlohmann::json{{"points", std::move(list)}, {"layers", {"moisture"}}}.dump();
  }
  template <class Work>
  static Samples repeated(int times, Work work) {
    Samples samples;
    for (int i = 0; i < times; ++i) samples.add(work());
    return samples;
  }
  void add(const std::string& what, double goal_ms, const Samples& samples, double quantile = 0.5) {
    std::printf("  %-45s %10.2f ms", what.c_str(), samples.quantile(quantile));
    if (goal_ms > 0) std::printf("   goal %g", goal_ms);
    std::printf("\n");
    std::fflush(stdout);
    auto json = samples.json();
    json.update({{"method", "query"},
                 {"model", options_.model},
                 {"triangles", model_.triangles},
                 {"resolution", kResolution},
                 {"points", options_.points},
                 {"question", what},
                 {"ms", samples.quantile(quantile)}});
    if (goal_ms > 0) json["goal_ms"] = goal_ms;
    results_.push_back(std::move(json));
  }
  void add(const std::string& what, double goal_ms, std::initializer_list<double> times) {
    Samples samples;
    for (const double ms : times) samples.add(ms);
    add(what, goal_ms, samples);
  }

  const Options& options_;
  Site site_;
  jobs::JobQueue jobs_;
  Model model_;
  std::shared_ptr<room::Room> room_;
  std::map<std::string, Layer> layers_;
  std::unique_ptr<net::Server> server_;
  std::unique_ptr<HttpClient> client_;
  std::mt19937 random_;
  int fills_ = 0;
  nlohmann::json results_ = nlohmann::json::array();
};

int run(const Options& options) {
  Queries(options).run();
  return 0;
}

}  // namespace

Command add_query(CLI::App& app) {
  auto* command = app.add_subcommand(
      "query", "Values, statistics and selections over HTTP, of layers of 4096²");
  auto options = std::make_shared<Options>();
  command->add_option("--model", options->model, "vessel, excavation, amazon, thai, or a file")
      ->capture_default_str();
  command->add_option("--points", options->points, "Points of the bulk query")
      ->capture_default_str();
  command->add_option("--requests", options->requests, "Single points")->capture_default_str();
  command->add_option("--cache", options->cache, "Where generated meshes are kept")
      ->capture_default_str();
  command->add_option("--json", options->json, "Write the results here");
  return [options] { return run(*options); };
}

}  // namespace strata::bench
