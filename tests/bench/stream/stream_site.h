#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "bench/stream/hands.h"
#include "bench/stream/server_process.h"

namespace strata::bench {

// A running server with the model that all look at, made over HTTP as anybody makes one.
class StreamSite {
 public:
  static constexpr int kResolution = 4096;  // of its layers

  struct Wish {
    std::filesystem::path server;  // empty: `strata` beside this program
    std::string model;             // as BenchMesh takes it, of one file
    std::filesystem::path cache;
    int layers = 0, width = 0, height = 0;
    double radius_px = 0;
    bool has_plain = false;  // the same model without layers, too
  };
  explicit StreamSite(const Wish& wish);

  const ServerProcess& server() const { return server_; }
  const Stage& painted() const { return painted_; }  // with all layers
  // with none; where that is not wished for, as `painted`
  const Stage& plain() const { return plain_; }
  const std::filesystem::path& mesh_file() const { return mesh_file_; }  // PLY
  std::int64_t triangles() const { return triangles_; }

 private:
  Stage import(const Wish& wish, const std::string& name, int layers);

  ServerProcess server_;
  std::filesystem::path mesh_file_;
  std::int64_t triangles_ = 0;
  Stage painted_, plain_;
};

}  // namespace strata::bench
