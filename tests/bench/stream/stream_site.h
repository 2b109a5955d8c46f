#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "bench/stream/hands.h"
#include "bench/stream/server_process.h"

namespace strata::bench {

// A running server with the model of all viewers, made over HTTP as any client does.
class StreamSite {
 public:
  static constexpr int kResolution = 4096;  // of the layers

  struct Settings {
    std::filesystem::path server;  // empty: `strata` in this program's folder
    std::string model;             // a name as in BenchMesh; the mesh must be one file
    std::filesystem::path cache;
    int layers = 0, width = 0, height = 0;
    double radius_px = 0;
    bool has_plain = false;  // also make the same model without layers
  };
  explicit StreamSite(const Settings& settings);

  const ServerProcess& server() const { return server_; }
  const Stage& painted() const { return painted_; }  // with all layers
  // Without layers. The same as `painted` unless `has_plain` was set.
  const Stage& plain() const { return plain_; }
  const std::filesystem::path& mesh_file() const { return mesh_file_; }  // a PLY file
  std::int64_t triangles() const { return triangles_; }

 private:
  Stage import(const Settings& settings, const std::string& name, int layers);

  ServerProcess server_;
  std::filesystem::path mesh_file_;
  std::int64_t triangles_ = 0;
  Stage painted_, plain_;
};

}  // namespace strata::bench
