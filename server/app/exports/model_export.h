#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/services.h"
#include "core/progress.h"
#include "core/temporary_file.h"
#include "domain/layers/layer.h"
#include "domain/people/role.h"
#include "media/picture.h"
#include "room/at.h"
#include "room/room.h"
#include "room/selection.h"
#include "room/view_settings.h"

namespace strata::app {

// OBJ files are in a zip with their material and texture.
enum class ModelFileFormat { glb, obj };

// The settings of a 3D model for other programs. The caller has checked the user's request.
struct ModelExport {
  std::shared_ptr<room::Room> room;  // as visible to the caller
  Role role = Role::viewer;
  room::At at;                // the state of the layers and records; empty: current state
  room::ViewSettings shown;   // layers and surface images; the light has no effect
  std::vector<Layer> layers;  // in the texture, from bottom to top
  ModelFileFormat format = ModelFileFormat::glb;
  std::optional<Layer> features;    // its classes or records become features; only for GLB
  std::optional<int> texture_size;  // a power of two; nullopt: default_texture_size
  PictureFormat texture_format = PictureFormat::jpeg;  // or png
  // The triangles with a texel in the selection, which has a part. nullopt: the whole surface.
  std::optional<room::Selection> within;
  std::optional<std::size_t> max_triangles;  // nullopt: all triangles of the surface
  bool unlit = false;
  std::string language;  // of the labels of terms
};

// Returns the size that shows all texels of the layers and all pixels of the visible surface
// images, but at least 1024 and at most 4096.
int default_texture_size(const ModelExport& request);

// Writes the model with its texture to a file in `folder`. The texture shows what an unlit
// image of the model shows: the scan, its visible surface images, and above them the layers.
// Hatches and dots have the full color of their class, and an outline has no color. Returns 422 for
// a palette that uses a column invisible to the role, for features without values, for a part
// without surface, and for fewer triangles than possible (mesh::simplify), 413 for a mesh that is
// too large for the format, 503 if there is too little memory, `storage_full`, and `cancelled`.
// Blocks.
Result<std::shared_ptr<const TemporaryFile>> export_model(const Services& services,
                                                          const ModelExport& request,
                                                          const std::filesystem::path& folder,
                                                          Progress& progress);

}  // namespace strata::app
