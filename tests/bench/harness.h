#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <future>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "mesh/surface/geometry.h"
#include "render/renderer.h"
#include "room/edit.h"
#include "room/room.h"
#include "room/rooms.h"
#include "store/cluster/cluster.h"
#include "stream/jpeg_pool.h"

namespace strata::bench {

// The times of one kind of work, in milliseconds.
class Samples {
 public:
  void add(double ms) { values_.push_back(ms); }
  bool empty() const { return values_.empty(); }
  double quantile(double share) const;
  double median() const { return quantile(0.5); }
  nlohmann::json json() const;  // {ms_median, ms_min, ms_max, ms_p95, runs}

 private:
  std::vector<double> values_;
};

double now_ms();

// Returns {cpu, cores, gl_renderer, driver, commit}.
nlohmann::json machine(const render::GpuInfo* gpu);
// Writes a JSON file. `more` has members in addition to `machine` and `results`.
void write_result(const std::string& json_file, const nlohmann::json& machine,
                  const nlohmann::json& results,
                  const nlohmann::json& more = nlohmann::json::object());

std::unique_ptr<render::Renderer> start_renderer();
template <class T>
T must(Result<T> result) {
  if (!result) {
    std::fprintf(stderr, "strata-bench: %s: %s\n", result.error().title.c_str(),
                 result.error().detail.c_str());
    std::exit(1);
  }
  if constexpr (!std::is_void_v<T>) return std::move(*result);
}

// Waits for the result that `start` passes to its callback.
template <class T, class Start>
T await(Start start) {
  auto promise = std::make_shared<std::promise<Result<T>>>();
  auto future = promise->get_future();
  start([promise](Result<T> result) { promise->set_value(std::move(result)); });
  if constexpr (std::is_void_v<T>)
    must(future.get());
  else
    return must(future.get());
}

// Returns a camera that shows the model from a direction, as large as the window allows.
Camera look_at(const mesh::Geometry& geometry, glm::dvec3 from, int width, int height);
// Returns such a camera for a box in world coordinates.
Camera look_at(glm::dvec3 low, glm::dvec3 high, glm::dvec3 from, int width, int height);

// Lets other users enter the parent folders of a future data folder. PostgreSQL needs this access,
// because it does not run as root.
void let_others_through(const std::filesystem::path& folder);
// Makes a folder in the system's temporary folder that other users may enter.
std::filesystem::path make_temporary_folder();

// A complete server without sockets, on a separate database in a temporary folder.
class Site {
 public:
  Site();
  ~Site();
  void restart();  // restarts everything except the database
  std::filesystem::path folder;
  std::unique_ptr<store::Cluster> cluster;
  std::unique_ptr<store::Store> store;
  std::unique_ptr<render::Renderer> renderer;
  std::unique_ptr<stream::JpegPool> encoder;
  std::unique_ptr<room::Rooms> rooms;
};

// Sends an edit and waits until it is durable.
room::EditAnswer edit_and_wait(room::Room& room, room::EditRequest request);
room::EditRequest stroke_request(const Layer& layer, const Camera& camera,
                                 std::vector<glm::dvec2> path, double radius_px, double value);

}  // namespace strata::bench
