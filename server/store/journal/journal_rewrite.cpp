#include "store/journal/journal_rewrite.h"

#include "core/log.h"

namespace strata::store {

PgArray array_of(std::span<const std::int64_t> numbers) {
  PgArray array(oid::kInt8);
  for (const std::int64_t number : numbers) array.add(number);
  return array;
}

std::int16_t number_of_tile(TileAddress tile) {
  return static_cast<std::int16_t>(tile.y * 128 + tile.x);
}

TileAddress tile_of_number(std::int16_t number) {
  return {static_cast<std::uint16_t>(number % 128), static_cast<std::uint16_t>(number / 128)};
}

std::vector<std::int16_t> read_tile_numbers(Bytes bytes) {
  std::vector<std::int16_t> numbers;
  for (std::size_t i = 0; i + 1 < bytes.size(); i += 2)
    numbers.push_back(static_cast<std::int16_t>(bytes[i] << 8 | bytes[i + 1]));
  return numbers;
}

TileAddress address_of(const PgResult& rows, int i) {
  return {static_cast<std::uint16_t>(rows.integer(i, 1)),
          static_cast<std::uint16_t>(rows.integer(i, 0))};
}

Result<std::optional<LayerState>> state_of(PgConnection& connection, LayerId layer) {
  auto rows = STRATA_TRY(connection.query(
      "SELECT l.type, coalesce(t.count, 0) FROM all_layers l LEFT JOIN thinned_layers t ON t.layer_id = l.id "
      "WHERE l.id = $1 AND NOT l.erasing",
      Params().id(layer)));
  if (rows.rows() == 0) return std::nullopt;
  const auto type = parse_value_type(rows.text(0, 0));
  if (!type) return std::nullopt;
  return LayerState{*type, rows.integer(0, 1)};
}

void begin_rewrite(Statements& out) {
  out.push_back({"BEGIN", {}});
  out.push_back(
      {"SELECT set_config('synchronous_commit', 'off', true), "
       "set_config('idle_in_transaction_session_timeout', '3s', true)",
       {}});
}

void find_state(LayerId layer, const LayerState& state, Statements& out) {
  Params params;
  params.id(layer).integer(state.thinnings);
  out.push_back(
      {"SELECT 1 WHERE coalesce((SELECT count FROM thinned_layers WHERE layer_id = $1), 0) = $2",
       std::move(params)});
}

Error failed_statement(PgConnection& connection, Error problem) {
  if (connection.sqlstate() != "55P03") return problem;
  return {ErrorCode::conflict, "Journal is locked",
          "Another change has locked the journal. The server tries again later.", ""};
}

Result<void> skip_if_damaged(const Error& problem, const std::string& what) {
  if (problem.code != ErrorCode::internal) return tl::unexpected(problem);
  log::warning("journal: " + what + " stay as they are: " + problem.detail);
  return {};
}

std::optional<PackedSegment> pack(TileAddress tile, ValueType type, const TileSegment& segment) {
  auto content = encode_segment(segment);
  if (!content) return std::nullopt;
  const auto again = decode_segment(tile, type, *content);
  if (!again || !(*again == segment)) return std::nullopt;
  PackedSegment packed{tile, {}, std::move(*content)};
  for (const auto& entry : segment.entries) packed.sequences.push_back(entry.sequence);
  return packed;
}

void insert_segments(LayerId layer, std::span<const PackedSegment> segments, Statements& out) {
  PgArray ys(oid::kInt2), xs(oid::kInt2), firsts(oid::kInt8), lasts(oid::kInt8),
      contents(oid::kBytea);
  for (const PackedSegment& segment : segments) {
    ys.add_int2(static_cast<std::int16_t>(segment.tile.y));
    xs.add_int2(static_cast<std::int16_t>(segment.tile.x));
    firsts.add(segment.sequences.front());
    lasts.add(segment.sequences.back());
    contents.add(Bytes(segment.content));
  }
  Params params;
  params.id(layer).array(ys).array(xs).array(firsts).array(lasts).array(contents);
  out.push_back(
      {"INSERT INTO tile_segments (layer_id, tile_y, tile_x, first_sequence, last_sequence, content) "
       "SELECT $1, s.* FROM unnest($2::smallint[], $3::smallint[], $4::bigint[], $5::bigint[], $6::bytea[]) AS s",
       std::move(params)});
}

}  // namespace strata::store
