#include "app/maps/map_legend.h"
#include "room/layers.h"
#include "room/queries.h"

#include <algorithm>

namespace strata::app {
namespace {

constexpr std::size_t kMaxPoints = 4096, kMaxNameLength = 200;  // as in the schema `Palette`
constexpr std::size_t kMaxNamed = 5;

}  // namespace

Result<std::optional<query::KeyNames>> keys_of(room::Room& room, const Layer& layer,
                                               const std::set<double>& records) {
  if (!lists_values(layer.palette)) return std::nullopt;
  const auto statistics = STRATA_TRY(room.queries().statistics(layer.slug));
  std::set<double> taken = records;
  for (const auto& [key, of_key] : statistics.keys) taken.insert(key);
  return query::KeyNames(layer.palette, taken);
}

Result<void> extend_legend(Role role, room::Room& room, const Layer& layer,
                           const query::KeyNames& keys) {
  if (!keys.has_changed()) return {};
  const auto& names = keys.added_names();
  if (role < Role::curator) {
    if (names.empty()) return {};
    std::string listed;
    for (std::size_t i = 0; i < std::min(names.size(), kMaxNamed); ++i)
      listed += (i ? ", " : "") + names[i].substr(0, kMaxNameLength);
    return fail(ErrorCode::forbidden, "Names not in the legend",
                "The legend of the layer does not contain: " + listed +
                    (names.size() > kMaxNamed ? ", …" : "") + ". A curator can add them.",
                "attribute");
  }
  for (const std::string& name : names)
    if (name.size() > kMaxNameLength)
      return fail(ErrorCode::invalid, "Name too long",
                  "\"" + name.substr(0, 60) + "…\" is longer than " +
                      std::to_string(kMaxNameLength) + " bytes. Shorten the name.",
                  "attribute");
  Layer changed = layer;
  changed.palette = keys.extended();
  changed.palette_of_terms = false;
  if (changed.palette.points.size() > kMaxPoints)
    return fail(ErrorCode::invalid, "Too many names",
                "A legend can have at most " + std::to_string(kMaxPoints) +
                    " entries. Use a map with fewer names.",
                "attribute");
  STRATA_TRY(room.layers().update(std::move(changed)));
  return {};
}

}  // namespace strata::app
