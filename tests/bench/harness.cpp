#include "bench/harness.h"

#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <future>
#include <glm/gtc/matrix_transform.hpp>
#include <iostream>
#include <thread>

#include "room/edit.h"
#include "room/edits.h"
#include "room/rooms.h"
#include "store/store.h"
#include "strata_dirs.h"
#include "stream/viewer.h"
#include "support/shader_dirs.h"

namespace strata::bench {
namespace {

std::string first_line_of(const char* command) {
  std::unique_ptr<FILE, int (*)(FILE*)> pipe(popen(command, "r"), &pclose);
  char line[256] = "";
  if (pipe && std::fgets(line, sizeof line, pipe.get())) {
    std::string text = line;
    while (!text.empty() && text.back() == '\n') text.pop_back();
    return text;
  }
  return "";
}

std::string cpu_name() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);)
    if (line.starts_with("model name")) return line.substr(line.find(':') + 2);
  return "unknown";
}

[[noreturn]] void stop(const std::string& why) {
  std::cerr << "strata-bench: " << why << std::endl;
  std::exit(1);
}

}  // namespace

double now_ms() {
  return std::chrono::duration<double, std::milli>(
             std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

double Samples::quantile(double share) const {
  auto sorted = values_;
  std::sort(sorted.begin(), sorted.end());
  return sorted.at(
      std::min(sorted.size() - 1, static_cast<std::size_t>(share * double(sorted.size()))));
}

nlohmann::json Samples::json() const {
  return {{"ms_median", median()},
          {"ms_min", quantile(0)},
          {"ms_max", quantile(1)},
          {"ms_p95", quantile(0.95)},
          {"runs", values_.size()}};
}

nlohmann::json machine(const render::GpuInfo* gpu) {
  nlohmann::json json{{"cpu", cpu_name()}, {"cores", std::thread::hardware_concurrency()}};
  const char* commit = std::getenv("STRATA_COMMIT");
  json["commit"] = commit ? commit : first_line_of("git rev-parse --short HEAD 2>/dev/null");
  if (gpu) {
    json["gl_renderer"] = gpu->renderer;
    json["driver"] = gpu->version;
  }
  return json;
}

void write_result(const std::string& json_file, const nlohmann::json& machine,
                  const nlohmann::json& results, const nlohmann::json& more) {
  if (json_file.empty()) return;
  std::ofstream out(json_file);
  nlohmann::json json = more;
  json["machine"] = machine;
  json["results"] = results;
  out << json.dump(2) << "\n";
  if (!out) stop("cannot write " + json_file);
}

std::unique_ptr<render::Renderer> start_renderer() {
  render::RendererOptions options;
  options.shader_dir = test::shader_dir().string();
  return must(render::Renderer::start(options));
}

Camera look_at(const mesh::Geometry& geometry, glm::dvec3 from, int width, int height) {
  return look_at(geometry.origin + glm::dvec3(geometry.box_min),
                 geometry.origin + glm::dvec3(geometry.box_max), from, width, height);
}

Camera look_at(glm::dvec3 low, glm::dvec3 high, glm::dvec3 from, int width, int height) {
  const glm::dvec3 center = (low + high) * 0.5;
  const double radius = glm::length(high - low) * 0.5;
  const glm::dvec3 direction = glm::normalize(from);
  const glm::dvec3 up = std::abs(direction.z) > 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(0, 0, 1);
  const double distance = radius * 2.4;
  return {glm::lookAt(center + direction * distance, center, up),
          glm::perspective(glm::radians(45.0), double(width) / height, distance - radius * 1.2,
                           distance + radius * 1.2),
          width, height};
}

void let_others_through(const std::filesystem::path& folder) {
  using std::filesystem::perms;
  std::filesystem::permissions(folder, perms::owner_all | perms::others_exec | perms::group_exec);
}

std::filesystem::path make_temporary_folder() {
  std::string folder = (std::filesystem::temp_directory_path() / "strata-bench-XXXXXX").string();
  if (!mkdtemp(folder.data())) stop("cannot make a temporary folder");
  let_others_through(folder);
  return folder;
}

Site::Site() : folder(make_temporary_folder()) {
  cluster = must(store::Cluster::start(folder / "data"));
  restart();
}

Site::~Site() {
  rooms.reset();
  encoder.reset();
  renderer.reset();
  store.reset();
  cluster.reset();
  std::error_code ignored;
  std::filesystem::remove_all(folder, ignored);
}

void Site::restart() {
  rooms.reset();
  encoder.reset();
  renderer.reset();
  store.reset();
  store = must(store::Store::open({cluster->dsn(), 8}, STRATA_MIGRATIONS_DIR));
  renderer = start_renderer();
  encoder =
      std::make_unique<stream::JpegPool>(std::max(1, int(std::thread::hardware_concurrency()) - 1));
  rooms = std::make_unique<room::Rooms>(
      *store, *renderer, stream::StreamContext{renderer.get(), encoder.get()}, room::RoomOptions{});
}

room::EditAnswer edit_and_wait(room::Room& room, room::EditRequest request) {
  auto promise = std::make_shared<std::promise<Result<room::EditAnswer>>>();
  auto future = promise->get_future();
  room.edits().submit(std::move(request), {}, [promise](Result<room::EditAnswer> answer) {
    promise->set_value(std::move(answer));
  });
  return must(future.get());
}

room::EditRequest stroke_request(const Layer& layer, const Camera& camera,
                                 std::vector<glm::dvec2> path, double radius_px, double value) {
  room::StrokeEdit stroke;
  stroke.batch.camera = camera;
  stroke.batch.path = std::move(path);
  stroke.batch.radius_px = radius_px;
  stroke.batch.value_bits = must(encode_value(layer.type, value));
  stroke.stroke = random_uuid();
  return {random_uuid(), {"bench", Role::owner}, layer.id, stroke, {{"op", "stroke"}}};
}

}  // namespace strata::bench
