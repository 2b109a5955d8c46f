#include <algorithm>
#include <future>
#include <limits>
#include <thread>
#include <tuple>

#include "domain/layers/revision.h"
#include "store/journal/journal_reads.h"
#include "store/pg/sql.h"
#include "store/store_impl.h"

namespace strata::store {
namespace {

// One tile as it was read: its last key tile, if any, and the later differences, in order.
struct StoredTile {
  TileAddress address;
  std::vector<std::uint8_t> key;
  std::vector<std::vector<std::uint8_t>> differences;
};

using Decoded = std::vector<std::pair<TileAddress, std::shared_ptr<const TileData>>>;

Result<Decoded> decode(const std::vector<StoredTile>& tiles, ValueType type) {
  Decoded decoded;
  for (const StoredTile& stored : tiles) {
    TileData tile(type);
    if (!stored.key.empty()) {
      auto key = STRATA_TRY(decode_tile(type, stored.key));
      tile = std::move(key);
    }
    for (const auto& bytes : stored.differences) {
      auto revision = STRATA_TRY(decode_revision(stored.address, type, bytes));
      apply(revision, tile);
    }
    if (tile.valid.any())
      decoded.emplace_back(stored.address, std::make_shared<const TileData>(std::move(tile)));
  }
  return decoded;
}

// Collects rows into tiles and decodes batches of them on other threads, a limited number at a
// time.
class TileLoader {
 public:
  explicit TileLoader(ValueType type) : type_(type) {}

  // Adds a row. Rows must be sorted by y and x of the tile, and then by sequence. In another order,
  // texels would get wrong values, so another order is an error.
  Result<void> add(TileAddress address, std::int64_t sequence, bool key, Bytes bytes) {
    const auto place = std::tuple(address.y, address.x, sequence);
    if (place <= last_)
      return fail(ErrorCode::internal, "Revisions out of order",
                  "The database returned the revisions of a layer in the wrong order.");
    last_ = place;
    if (batch_.empty() || batch_.back().address != address) {
      if (batch_bytes_ >= kBatchBytes) STRATA_TRY(flush());
      batch_.push_back({address, {}, {}});
    }
    if (key)
      batch_.back().key.assign(bytes.begin(), bytes.end());
    else
      batch_.back().differences.emplace_back(bytes.begin(), bytes.end());
    batch_bytes_ += bytes.size() + kDecodedBytes;
    return {};
  }

  Result<TileMap> finish() {
    auto sent = flush();
    while (sent && !running_.empty()) sent = collect();
    if (!sent) return tl::unexpected(sent.error());
    return std::move(tiles_);
  }

 private:
  static constexpr std::size_t kBatchBytes = 4u << 20;
  // approximate cost to decode one row, in bytes
  static constexpr std::size_t kDecodedBytes = kTexelsPerTile;

  Result<void> flush() {
    if (batch_.empty()) return {};
    running_.push_back(std::async(std::launch::async, decode, std::exchange(batch_, {}), type_));
    batch_bytes_ = 0;
    const std::size_t most = std::clamp(std::thread::hardware_concurrency(), 2u, 8u);
    return running_.size() >= most ? collect() : Result<void>{};
  }
  Result<void> collect() {
    auto decoded = running_.front().get();
    running_.pop_front();
    if (!decoded) return tl::unexpected(decoded.error());
    tiles_.insert(std::make_move_iterator(decoded->begin()),
                  std::make_move_iterator(decoded->end()));
    return {};
  }

  const ValueType type_;
  std::tuple<std::uint16_t, std::uint16_t, std::int64_t> last_{0, 0, 0};
  std::vector<StoredTile> batch_;
  std::size_t batch_bytes_ = 0;
  std::deque<std::future<Result<Decoded>>> running_;
  TileMap tiles_;
};

TileAddress read_address(const PgResult& rows, int i) {
  return {static_cast<std::uint16_t>(rows.integer(i, 1)),
          static_cast<std::uint16_t>(rows.integer(i, 0))};
}

// Reads tile by tile, by the primary key, and for each tile the rows since its last key tile. Older
// rows are not read, so a layer opens as fast after a year of painting as after a day. Nested loops
// determine the order, because a sort would keep every row in memory. Tile addresses are compared
// as row values, which only the primary key supports. With other comparisons, for a new table
// without statistics, the planner would read the whole index by sequence for each tile. This SQL
// follows a WITH query `tiles`. It returns the rows of each tile, from its last key tile up to $2.
// Because of the LEFT JOIN, a tile without rows has one row of nulls.
constexpr auto kRowsOfTiles = sql(
    "SELECT t.tile_y, t.tile_x, r.sequence, r.sequence = k.sequence, CASE WHEN r.sequence = k.sequence THEN r.key_tile ELSE r.difference END "
    "FROM tiles t LEFT JOIN LATERAL (SELECT sequence FROM tile_revisions WHERE layer_id = $1 AND tile_y = t.tile_y "
    "AND tile_x = t.tile_x AND sequence <= $2 AND key_tile IS NOT NULL ORDER BY sequence DESC LIMIT 1) k ON true "
    "LEFT JOIN LATERAL (SELECT sequence, difference, key_tile FROM tile_revisions WHERE layer_id = $1 "
    "AND (tile_y, tile_x, sequence) >= (t.tile_y, t.tile_x, coalesce(k.sequence, 0)) AND (tile_y, tile_x, sequence) <= (t.tile_y, t.tile_x, $2) "
    "ORDER BY tile_y, tile_x, sequence) r ON true");

constexpr auto kLoadTiles = sql(
    "WITH RECURSIVE tiles AS ("
    "(SELECT tile_y, tile_x FROM tile_revisions WHERE layer_id = $1 ORDER BY tile_y, tile_x LIMIT 1) UNION ALL "
    "SELECT n.tile_y, n.tile_x FROM tiles t CROSS JOIN LATERAL (SELECT tile_y, tile_x FROM tile_revisions "
    "WHERE layer_id = $1 AND (tile_y, tile_x) > (t.tile_y, t.tile_x) ORDER BY tile_y, tile_x LIMIT 1) n) ",
    kRowsOfTiles);

// Selects only the tiles that edits after $3 and up to $4 wrote.
constexpr auto kLoadTilesNear =
    sql("WITH tiles AS MATERIALIZED (SELECT DISTINCT tile_y, tile_x FROM tile_revisions "
        "WHERE layer_id = $1 AND sequence > $3 AND sequence <= $4 ORDER BY tile_y, tile_x) ",
        kRowsOfTiles);

Result<void> add_row(TileLoader& loader, const PgResult& row) {
  if (row.null(0, 2)) return {};  // the tile was empty until then
  return loader.add(read_address(row, 0), row.integer(0, 2), !row.null(0, 3) && row.boolean(0, 3),
                    row.bytes(0, 4));
}

}  // namespace

Result<TileMirror::Snapshot> Journal::load_tiles(const Layer& layer,
                                                 std::optional<std::int64_t> at_sequence) {
  return pool_.read([&](PgConnection& connection) -> Result<TileMirror::Snapshot> {
    auto last = STRATA_TRY(connection.query(
        "SELECT (SELECT coalesce(max(sequence), 0) FROM edits WHERE layer_id = l.id AND sequence <= $2) "
        "FROM layers l WHERE id = $1",
        Params().id(layer.id).integer(
            at_sequence.value_or(std::numeric_limits<std::int64_t>::max()))));
    if (last.rows() == 0) return no_such("layer", to_string(layer.id));
    // The journal only grows, so everything up to this sequence is one consistent state.
    const std::int64_t sequence = last.integer(0, 0);
    TileLoader loader(layer.type);
    STRATA_TRY(connection.each_row(kLoadTiles.c_str(), Params().id(layer.id).integer(sequence),
                                   [&](const PgResult& row) { return add_row(loader, row); }));
    auto tiles = STRATA_TRY(loader.finish());
    return TileMirror::Snapshot{std::move(tiles), sequence};
  });
}

Result<TileMirror::Snapshot> Journal::load_tiles_near(const Layer& layer, std::int64_t sequence,
                                                      const TileMirror::Snapshot& near) {
  TileMirror::Snapshot snapshot{near.tiles, sequence};
  if (near.sequence == sequence) return snapshot;
  return pool_.read([&](PgConnection& connection) -> Result<TileMirror::Snapshot> {
    TileLoader loader(layer.type);
    STRATA_TRY(connection.each_row(kLoadTilesNear.c_str(),
                                   Params()
                                       .id(layer.id)
                                       .integer(sequence)
                                       .integer(std::min(sequence, near.sequence))
                                       .integer(std::max(sequence, near.sequence)),
                                   [&](const PgResult& row) {
                                     snapshot.tiles.erase(read_address(row, 0));
                                     return add_row(loader, row);
                                   }));
    auto tiles = STRATA_TRY(loader.finish());
    snapshot.tiles.merge(tiles);
    return snapshot;
  });
}

Result<std::map<LayerId, std::int64_t>> Journal::layer_sequences(ModelId model_id,
                                                                 std::int64_t sequence) {
  return pool_.read([&](PgConnection& connection) -> Result<std::map<LayerId, std::int64_t>> {
    auto rows = STRATA_TRY(connection.query(
        "SELECT l.id, e.sequence FROM layers l CROSS JOIN LATERAL (SELECT sequence FROM edits "
        "WHERE layer_id = l.id AND sequence <= $2 ORDER BY sequence DESC LIMIT 1) e "
        "WHERE l.model_id = $1",
        Params().id(model_id).integer(sequence)));
    std::map<LayerId, std::int64_t> last;
    for (int i = 0; i < rows.rows(); ++i)
      last.emplace(LayerId(rows.integer(i, 0)), rows.integer(i, 1));
    return last;
  });
}

Result<std::vector<PastRevision>> Journal::tile_history(const Layer& layer, TileAddress tile,
                                                        std::int64_t before, int limit) {
  return pool_.read([&](PgConnection& connection) -> Result<std::vector<PastRevision>> {
    auto rows = STRATA_TRY(connection.query(
        "SELECT r.sequence, e.writer, e.in_force, coalesce(e.review = 'pending', false), r.difference FROM tile_revisions r "
        "JOIN edits e ON e.model_id = $2 AND e.sequence = r.sequence "
        "WHERE r.layer_id = $1 AND r.tile_y = $3 AND r.tile_x = $4 AND r.sequence < $5 ORDER BY r.sequence DESC LIMIT $6",
        Params()
            .id(layer.id)
            .id(layer.model_id)
            .integer(tile.y)
            .integer(tile.x)
            .integer(before)
            .integer(limit)));
    std::vector<PastRevision> revisions;
    for (int i = 0; i < rows.rows(); ++i) {
      auto revision = STRATA_TRY(decode_revision(tile, layer.type, rows.bytes(i, 4)));
      revisions.push_back({rows.integer(i, 0), rows.boolean(i, 1), rows.boolean(i, 2),
                           rows.boolean(i, 3), std::move(revision)});
    }
    return revisions;
  });
}

Result<std::vector<WrittenTiles>> Journal::written_by(const Layer& layer,
                                                      std::span<const std::int64_t> sequences) {
  PgArray list(oid::kInt8);
  for (const std::int64_t sequence : sequences) list.add(sequence);
  return pool_.read([&](PgConnection& connection) -> Result<std::vector<WrittenTiles>> {
    std::vector<WrittenTiles> written;
    STRATA_TRY(connection.each_row(
        "SELECT tile_y, tile_x, difference FROM tile_revisions WHERE layer_id = $1 AND sequence = any($2) "
        "ORDER BY tile_y, tile_x",
        Params().id(layer.id).array(list), [&](const PgResult& row) -> Result<void> {
          const TileAddress address = read_address(row, 0);
          auto revision = decode_revision(address, layer.type, row.bytes(0, 2));
          if (!revision) return tl::unexpected(revision.error());
          if (written.empty() || written.back().tile != address) written.push_back({address, {}});
          for (int w = 0; w < kMaskWords; ++w)
            written.back().written.words[w] |= revision->written.words[w];
          return {};
        }));
    return written;
  });
}

Result<std::uint64_t> Journal::revision_bytes(ModelId model_id) {
  return pool_.read([&](PgConnection& connection) -> Result<std::uint64_t> {
    auto row = STRATA_TRY(connection.query(
        "SELECT coalesce(sum(octet_length(r.difference) + coalesce(octet_length(r.key_tile), 0)), 0)::bigint "
        "FROM layers l JOIN tile_revisions r ON r.layer_id = l.id WHERE l.model_id = $1",
        Params().id(model_id)));
    return static_cast<std::uint64_t>(row.integer(0, 0));
  });
}

}  // namespace strata::store
