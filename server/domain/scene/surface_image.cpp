#include "domain/scene/surface_image.h"

#include <nlohmann/json.hpp>

namespace strata {

nlohmann::json to_json(const SurfaceImage& image) {
  return {{"id", image.id},           {"name", image.name},
          {"slug", image.slug},       {"description", image.description},
          {"width", image.width},     {"height", image.height},
          {"bytes", image.bytes},     {"media_type", image.media_type},
          {"sha256", image.sha256},   {"opacity", image.opacity},
          {"visible", image.visible}, {"order", image.order}};
}

}  // namespace strata
