#include "domain/scene/look.h"

#include <nlohmann/json.hpp>

namespace strata {

nlohmann::json to_json(const Look& look) {
  return {{"id", look.id},           {"name", look.name},
          {"slug", look.slug},       {"description", look.description},
          {"width", look.width},     {"height", look.height},
          {"bytes", look.bytes},     {"media_type", look.media_type},
          {"sha256", look.sha256},   {"opacity", look.opacity},
          {"visible", look.visible}, {"order", look.order}};
}

}  // namespace strata
