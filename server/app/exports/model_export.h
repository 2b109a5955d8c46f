#pragma once

#include <cstdint>
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
#include "room/room.h"

namespace strata::app {

// The settings of a 3D model for other programs. The caller has checked the user's request.
struct ModelExport {
  std::shared_ptr<room::Room> room;  // as visible to the caller
  Role role = Role::viewer;
  std::int64_t at = 0;              // the state of the layers
  std::vector<Layer> layers;        // in the texture, from bottom to top
  std::optional<Layer> features;    // its classes or records become features
  std::optional<int> texture_size;  // a power of two; nullopt: default_texture_size
  PictureFormat texture_format = PictureFormat::jpeg;  // or png
  bool unlit = false;
  std::string language;  // of the labels of terms
};

// Returns the size that shows all texels of the layers and all pixels of the surface images, but at
// least 1024 and at most 4096.
int default_texture_size(room::Room& room, const std::vector<Layer>& layers);

// Writes the model with its texture to a GLB file in `folder`. The texture shows what an unlit
// image of the model shows: the scan, its visible surface images, and above them the layers.
// Hatches and dots have the full color of their class, and an outline has no color. Returns 422 for
// a palette that uses a column invisible to the role and for features without values, 503 if there
// is too little memory, `storage_full`, and `cancelled`. Blocks.
Result<std::shared_ptr<const TemporaryFile>> export_model(const Services& services,
                                                          const ModelExport& request,
                                                          const std::filesystem::path& folder,
                                                          Progress& progress);

}  // namespace strata::app
