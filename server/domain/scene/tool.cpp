#include "domain/scene/tool.h"

#include <nlohmann/json.hpp>

namespace strata {

nlohmann::json to_json(const Tool& tool) {
  return {{"id", tool.id}, {"name", tool.name}, {"slug", tool.slug}, {"deleted", tool.deleted}};
}

}  // namespace strata
