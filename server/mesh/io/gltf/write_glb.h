#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/progress.h"
#include "mesh/io/gltf/property_table.h"
#include "mesh/io/scene_model.h"

namespace strata::mesh {

// The features of a surface (EXT_mesh_features) and their properties.
struct GlbFeatures {
  std::string name;  // of the layer
  // PNG. The id of the feature of each pixel is in the first `channels` channels, with the lowest 8
  // bits in the first channel.
  SceneImage ids;
  int channels = 1;                         // 1…3
  std::uint32_t count = 0;                  // at least 1; ids are below `count`
  std::uint32_t none = 0;                   // the id of pixels without a feature; not below `count`
  std::vector<FeatureProperty> properties;  // with `count` values each
};

// `unlit` is KHR_materials_unlit. Programs without this extension show a rough surface that is not
// metallic, like all programs without `unlit`.
struct GlbModel : SceneModel {
  std::optional<GlbFeatures> features;
};

// Returns `too_large` if a GLB file cannot contain the mesh and the usual textures, because it can
// have at most 4 GiB.
Result<void> check_glb_size(const Geometry& geometry);

// Writes the model as a GLB file (glTF 2.0) and returns its size. Positions are those of
// Geometry::vertices, in model space and in the unit of the model, as 32-bit floats. The matrix of
// the node, in double precision, scales them to meters, rotates the model's up direction to +y and
// its front to +z, and moves them to their place in the world. So large world coordinates lose no
// precision. Textures use the coordinates of the atlas. The file is written in small pieces.
//
// Returns `too_large` for a file of more than 4 GiB, which GLB does not allow, `storage_full` if
// the file could not be written, and `cancelled`.
Result<std::uint64_t> write_glb(const GlbModel& model, const std::filesystem::path& file,
                                Progress& progress);

}  // namespace strata::mesh
