#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <utility>
#include <vector>

#include "core/progress.h"
#include "media/picture.h"
#include "mesh/atlas/atlas.h"
#include "mesh/io/scene_model.h"

namespace strata::test {

// Becomes cancelled when it has been asked `question` times.
class CancelledAt : public Progress {
 public:
  explicit CancelledAt(int question) : left_(question) {}
  bool cancelled() const override { return --left_ < 0; }

 private:
  mutable int left_;
};

inline mesh::SceneImage dot() {
  const std::vector<std::uint8_t> rgba{200, 100, 50, 255};
  return {"image/png", encode_png(rgba, 1, 1)};
}

inline std::shared_ptr<const mesh::Geometry> geometry_of(const mesh::TriangleMesh& mesh) {
  Progress progress;
  auto atlas = mesh::make_atlas(mesh, 512, progress);
  EXPECT_TRUE(atlas);
  return std::make_shared<const mesh::Geometry>(mesh::build_geometry(mesh, *atlas));
}

// The same with the texture coordinates of the mesh.
inline std::shared_ptr<const mesh::Geometry> with_own_uvs(const mesh::TriangleMesh& mesh) {
  mesh::Atlas atlas;
  atlas.corner_uvs = mesh.corner_uvs;
  return std::make_shared<const mesh::Geometry>(mesh::build_geometry(mesh, atlas));
}

// A triangle of a millimeter at UTM coordinates, which 32-bit floats would round to half a meter.
inline mesh::TriangleMesh far_triangle() {
  mesh::TriangleMesh mesh;
  const glm::dvec3 far(562'000.125, 5'117'000.375, 2500.5);
  mesh.positions = {far, far + glm::dvec3(0.001, 0, 0), far + glm::dvec3(0, 0.001, 0.0005)};
  mesh.triangles = {0, 1, 2};
  return mesh;
}

template <class SceneModel>
SceneModel scene_of(std::shared_ptr<const mesh::Geometry> geometry) {
  SceneModel model;
  model.name = "Pot „1“";
  model.geometry = std::move(geometry);
  model.color = dot();
  return model;
}

inline std::vector<std::uint8_t> content_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace strata::test
