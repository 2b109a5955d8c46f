#include "room/edit.h"

#include <bit>
#include <set>

namespace strata::room {
namespace {

// Returns the distinct values of the valid texels.
std::set<std::int64_t> keys_in(const TileMap& tiles) {
  std::set<std::int64_t> keys;
  for (const auto& [address, tile] : tiles) {
    std::optional<std::uint32_t> last;  // neighbors mostly have the same key
    for (std::size_t word = 0; word < tile->valid.words.size(); ++word)
      for (auto rest = tile->valid.words[word]; rest != 0; rest &= rest - 1) {
        const std::uint32_t bits = tile->bits(static_cast<int>(word * 64) + std::countr_zero(rest));
        if (last != bits) keys.insert(bits);
        last = bits;
      }
  }
  return keys;
}

}  // namespace

std::vector<std::int64_t> painted_by(const Layer& layer, const EditRequest& edit) {
  if (layer.kind != LayerKind::database) return {};
  const auto one = [](bool erase, std::uint32_t bits) {
    return erase ? std::vector<std::int64_t>{} : std::vector<std::int64_t>{bits};
  };
  if (const auto* stroke = std::get_if<StrokeEdit>(&edit.edit))
    return one(stroke->batch.erase, stroke->batch.value_bits);
  if (const auto* fill = std::get_if<FillEdit>(&edit.edit))
    return one(fill->erase, fill->value_bits);
  if (const auto* polygon = std::get_if<PolygonEdit>(&edit.edit))
    return one(polygon->erase, polygon->value_bits);
  if (const auto* import = std::get_if<ImportEdit>(&edit.edit)) {
    const auto keys = keys_in(import->tiles);
    return {keys.begin(), keys.end()};
  }
  if (const auto* patch = std::get_if<PatchEdit>(&edit.edit)) {
    // A record may have been deleted since the patch was computed, also one that was painted then.
    std::set<std::int64_t> keys;
    for (const auto& [address, tile] : patch->patch.tiles)
      for (int texel = 0; texel < kTexelsPerTile; ++texel)
        if (tile.texels.test(texel) && tile.after->valid.test(texel))
          keys.insert(tile.after->bits(texel));
    return {keys.begin(), keys.end()};
  }
  return {};
}

bool paints(const EditRequest& edit) {
  return !std::holds_alternative<UndoEdit>(edit.edit) &&
         !std::holds_alternative<RedoEdit>(edit.edit) &&
         !std::holds_alternative<ReviewEdit>(edit.edit);
}

bool waits_for_review(const Layer& layer, const EditRequest& edit) {
  return layer.review && edit.author.role < Role::curator && paints(edit) &&
         !std::holds_alternative<ComputeEdit>(edit.edit);
}

bool computes(const EditRequest& edit) {
  const auto* import = std::get_if<ImportEdit>(&edit.edit);
  return std::holds_alternative<ComputeEdit>(edit.edit) || (import && import->computed);
}

Result<void> check_not_locked(const Layer& layer, Role role, bool computing) {
  if (is_as_computed(layer) && !computing)
    return fail(ErrorCode::forbidden, "Layer is locked",
                "The layer " + layer.name +
                    " is locked because its values were computed. Ask a curator to unlock it "
                    "before you edit it by hand.",
                "layer");
  if (!layer.locked || role >= Role::curator) return {};
  return fail(ErrorCode::forbidden, "Layer is locked",
              "The layer " + layer.name + " is locked. Ask a curator to unlock it.", "layer");
}

nlohmann::json to_json(const EditAnswer& answer) {
  nlohmann::json json{{"sequence", answer.sequence},
                      {"texels_changed", answer.texels_changed},
                      {"area_m2", answer.area_m2}};
  if (answer.provisional) json["provisional"] = true;
  return json;
}

EditAnswer idempotent_response(const store::JournalRow& row) {
  return {row.sequence, row.answer.value("texels_changed", std::uint64_t{0}),
          row.answer.value("area_m2", 0.0), true, row.answer.value("provisional", false)};
}

}  // namespace strata::room
