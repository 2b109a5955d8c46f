#include "room/edit.h"

#include <bit>
#include <set>

namespace strata::room {
namespace {

// Adds the distinct values of those of these texels that are valid.
void add_keys(const TileData& tile, const TileMask& texels, std::set<std::int64_t>& keys) {
  std::optional<std::uint32_t> last;  // neighbors mostly have the same key
  for (std::size_t word = 0; word < texels.words.size(); ++word)
    for (auto rest = texels.words[word] & tile.valid.words[word]; rest != 0; rest &= rest - 1) {
      const std::uint32_t bits = tile.bits(static_cast<int>(word * 64) + std::countr_zero(rest));
      if (last != bits) keys.insert(bits);
      last = bits;
    }
}

}  // namespace

std::vector<std::int64_t> keys_in(const query::TexelPatch& patch) {
  std::set<std::int64_t> keys;
  for (const auto& [address, tile] : patch.tiles) add_keys(*tile.after, tile.texels, keys);
  return {keys.begin(), keys.end()};
}

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
    std::set<std::int64_t> keys;
    for (const auto& [address, tile] : import->tiles) add_keys(*tile, tile->valid, keys);
    return {keys.begin(), keys.end()};
  }
  if (const auto* patch = std::get_if<PatchEdit>(&edit.edit)) return patch->keys;
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
