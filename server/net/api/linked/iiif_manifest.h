#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "domain/scene/camera.h"
#include "net/api/linked/linked_addresses.h"

namespace strata::net {

// A saved view in a manifest.
struct ManifestView {
  std::string slug, name, text;
  Camera camera;
};

// Returns the IIIF manifest of a model (Presentation API 4.0). Its scene contains the surface as
// GLB, in meters, with a camera for each saved view. The first camera is the initial one. Its
// canvases are pictures of the views. `with_surface` is false if the caller must not get the
// surface: the scene then has only cameras. `layers` are those with annotations.
nlohmann::json iiif_manifest(const LinkedAddresses& addresses, const Model& model,
                             const std::vector<ManifestView>& views,
                             const std::vector<Layer>& layers, bool with_surface);

}  // namespace strata::net
