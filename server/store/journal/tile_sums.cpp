#include "store/journal/tile_sums.h"

#include <array>
#include <ranges>
#include <set>

#include "store/content/layers.h"
#include "store/store_impl.h"

namespace strata::store {

void write_tile_sums(const TileKeysByPlace& tiles, std::deque<PgConnection::Statement>& out) {
  PgArray empty_layers(oid::kInt8), empty_ys(oid::kInt2), empty_xs(oid::kInt2);
  PgArray layers(oid::kInt8), ys(oid::kInt2), xs(oid::kInt2), keys(oid::kInt8), texels(oid::kInt8),
      areas(oid::kFloat8);
  std::array<PgArray, 9> places{
      PgArray(oid::kFloat8), PgArray(oid::kFloat8), PgArray(oid::kFloat8),
      PgArray(oid::kFloat8), PgArray(oid::kFloat8), PgArray(oid::kFloat8),
      PgArray(oid::kFloat8), PgArray(oid::kFloat8), PgArray(oid::kFloat8)};
  for (const auto& [place, sums] : tiles) {
    const auto y = static_cast<std::int16_t>(place.second.y),
               x = static_cast<std::int16_t>(place.second.x);
    if (sums.empty()) {
      empty_layers.add(place.first);
      empty_ys.add_int2(y);
      empty_xs.add_int2(x);
    }
    for (const KeySum& sum : sums) {
      layers.add(place.first);
      ys.add_int2(y);
      xs.add_int2(x);
      if (sum.key)
        keys.add(*sum.key);
      else
        keys.add_null();
      texels.add(static_cast<std::int64_t>(sum.texels));
      areas.add(sum.area);
      std::size_t column = 0;
      for (const glm::dvec3* vector : {&sum.moment, &sum.low, &sum.high})
        for (int axis = 0; axis < 3; ++axis) places[column++].add((*vector)[axis]);
    }
  }
  if (empty_layers.size() > 0) {
    Params params;
    params.array(empty_layers).array(empty_ys).array(empty_xs);
    out.push_back(
        {"DELETE FROM tile_sums s USING unnest($1::bigint[], $2::smallint[], $3::smallint[]) AS v (layer_id, y, x) "
         "WHERE s.layer_id = v.layer_id AND s.tile_y = v.y AND s.tile_x = v.x",
         std::move(params)});
  }
  if (layers.size() == 0) return;
  Params params;
  params.array(layers).array(ys).array(xs).array(keys).array(texels).array(areas);
  for (const PgArray& column : places) params.array(column);
  out.push_back(
      {"INSERT INTO tile_sums SELECT v.layer_id, v.y, v.x, array_agg(k), array_agg(t), array_agg(a), array_agg(mx), "
       "array_agg(my), array_agg(mz), array_agg(lx), array_agg(ly), array_agg(lz), array_agg(hx), array_agg(hy), "
       "array_agg(hz) FROM unnest($1::bigint[], $2::smallint[], $3::smallint[], $4::bigint[], $5::bigint[], "
       "$6::float8[], $7::float8[], $8::float8[], $9::float8[], $10::float8[], $11::float8[], $12::float8[], "
       "$13::float8[], $14::float8[], $15::float8[]) "
       "AS v (layer_id, y, x, k, t, a, mx, my, mz, lx, ly, lz, hx, hy, hz) GROUP BY v.layer_id, v.y, v.x "
       "ON CONFLICT (layer_id, tile_y, tile_x) DO UPDATE SET keys = excluded.keys, texels = excluded.texels, "
       "areas = excluded.areas, moments_x = excluded.moments_x, moments_y = excluded.moments_y, "
       "moments_z = excluded.moments_z, low_x = excluded.low_x, low_y = excluded.low_y, low_z = excluded.low_z, "
       "high_x = excluded.high_x, high_y = excluded.high_y, high_z = excluded.high_z",
       std::move(params)});
}

void write_tile_sums(std::span<const JournalEntry* const> entries,
                     std::deque<PgConnection::Statement>& out) {
  TileKeysByPlace tiles;
  std::set<LayerId> unknown;
  // Newest first, so each tile is summed only once. The edits of a stroke change the same tiles.
  for (const JournalEntry* entry : std::views::reverse(entries)) {
    if (entry->revisions.empty()) continue;
    if (!entry->sum_tile) {
      unknown.insert(entry->layer_id);
      continue;
    }
    for (const auto& revision : entry->revisions) {
      const auto [place, is_newest] = tiles.try_emplace({entry->layer_id, revision.tile});
      if (is_newest) place->second = entry->sum_tile(revision.tile);
    }
  }
  write_tile_sums(tiles, out);
  if (unknown.empty()) return;
  PgArray layers(oid::kInt8);
  for (const LayerId layer : unknown) layers.add(layer);
  Params params;
  params.array(layers);
  out.push_back(
      {"UPDATE layers SET summed = false WHERE id = any($1) AND summed", std::move(params)});
}

Result<std::vector<Layer>> Layers::to_sum() {
  auto ids =
      pool_.read([](PgConnection& connection) -> Result<std::vector<std::pair<ModelId, LayerId>>> {
        auto rows =
            connection.query("SELECT model_id, id FROM layers WHERE NOT summed ORDER BY id");
        if (!rows) return tl::unexpected(rows.error());
        std::vector<std::pair<ModelId, LayerId>> found;
        for (int i = 0; i < rows->rows(); ++i)
          found.emplace_back(rows->id<ModelId>(i, 0), rows->id<LayerId>(i, 1));
        return found;
      });
  if (!ids) return tl::unexpected(ids.error());
  std::vector<Layer> layers;
  for (const auto& [model, id] : *ids)
    if (auto found = find(model, to_string(id), Role::owner)) layers.push_back(std::move(*found));
  return layers;
}

Result<void> Layers::keep_sums(LayerId layer_id, std::vector<TileKeys> tiles) {
  TileKeysByPlace by_place;
  for (TileKeys& tile : tiles) by_place[{layer_id, tile.tile}] = std::move(tile.keys);
  return pool_.write_within(kBulkLimits, [&](PgConnection& connection) -> Result<void> {
    std::deque<PgConnection::Statement> statements;
    statements.push_back({"DELETE FROM tile_sums WHERE layer_id = $1", {}});
    statements.back().params.id(layer_id);
    write_tile_sums(by_place, statements);
    statements.push_back({"UPDATE layers SET summed = true WHERE id = $1", {}});
    statements.back().params.id(layer_id);
    STRATA_TRY(connection.pipeline(statements));
    return {};
  });
}

}  // namespace strata::store
