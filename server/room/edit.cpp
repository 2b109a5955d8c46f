#include "room/edit.h"

namespace strata::room {

nlohmann::json to_json(const EditAnswer& answer) {
  return {{"sequence", answer.sequence}, {"texels_changed", answer.texels_changed}, {"area_m2", answer.area_m2}};
}

}  // namespace strata::room
