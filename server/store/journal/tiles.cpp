#include <algorithm>
#include <future>
#include <limits>
#include <map>
#include <set>
#include <thread>
#include <tuple>

#include "domain/layers/revision.h"
#include "domain/layers/tile_segment.h"
#include "store/journal/journal_reads.h"
#include "store/journal/kept_states.h"
#include "store/journal/merge_plan.h"
#include "store/pg/sql.h"
#include "store/store_impl.h"

namespace strata::store {
namespace {

// The kind of data in a row.
enum class Part { difference = 0, key = 1, segment = 2 };

// One tile as it was read: its last key tile or the last segment, if any, and the later
// differences, in order.
struct StoredTile {
  TileAddress address;
  std::vector<std::uint8_t> key, segment;
  std::vector<std::vector<std::uint8_t>> differences;
};

using Decoded = std::vector<std::pair<TileAddress, std::shared_ptr<const TileData>>>;

Result<Decoded> decode(const std::vector<StoredTile>& tiles, ValueType type, std::int64_t at) {
  Decoded decoded;
  for (const StoredTile& stored : tiles) {
    TileData tile(type);
    if (!stored.key.empty())
      tile = STRATA_TRY(decode_tile(type, stored.key));
    else if (!stored.segment.empty())
      tile = STRATA_TRY(tile_in_segment(type, stored.segment, at));
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
  // Loads the tiles as they were after the edit `at`.
  TileLoader(ValueType type, std::int64_t at) : type_(type), at_(at) {}

  // Adds a row. Rows must be sorted by y and x of the tile, and then by sequence. In another order,
  // texels would get wrong values, so another order is an error.
  Result<void> add(TileAddress address, std::int64_t sequence, Part part, Bytes bytes) {
    const auto place = std::tuple(address.y, address.x, sequence);
    if (place <= last_)
      return fail(ErrorCode::internal, "Revisions out of order",
                  "The database returned the revisions of a layer in the wrong order.");
    last_ = place;
    if (batch_.empty() || batch_.back().address != address) {
      if (batch_bytes_ >= kBatchBytes) STRATA_TRY(flush());
      batch_.push_back({address, {}, {}, {}});
    }
    StoredTile& tile = batch_.back();
    if (part == Part::difference)
      tile.differences.emplace_back(bytes.begin(), bytes.end());
    else
      (part == Part::key ? tile.key : tile.segment).assign(bytes.begin(), bytes.end());
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
    running_.push_back(
        std::async(std::launch::async, decode, std::exchange(batch_, {}), type_, at_));
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
  const std::int64_t at_;
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

// Reads tile by tile, by the primary key, and for each tile the rows since its last key tile, or
// the last segment and the rows after it. Older rows are not read, so a layer opens as fast after a
// year of painting as after a day. Nested loops determine the order, because a sort would keep
// every row in memory. Tile addresses are compared as row values, which only the primary key
// supports. With other comparisons, for a new table without statistics, the planner would read the
// whole index by sequence for each tile. This SQL follows a WITH query `tiles`. It returns the rows
// of each tile up to $2, with their Part. A segment has the sequence of its first revision. All
// rows of a tile are later than its segments. Because of the LEFT JOIN, a tile without rows has one
// row of nulls.
constexpr auto kRowsOfTiles = sql(
    "SELECT t.tile_y, t.tile_x, r.sequence, r.part, r.bytes "
    "FROM tiles t LEFT JOIN LATERAL (SELECT sequence FROM tile_revisions WHERE layer_id = $1 AND tile_y = t.tile_y "
    "AND tile_x = t.tile_x AND sequence <= $2 AND key_tile IS NOT NULL ORDER BY sequence DESC LIMIT 1) k ON true "
    "LEFT JOIN LATERAL ((SELECT first_sequence AS sequence, 2 AS part, content AS bytes FROM tile_segments "
    "WHERE k.sequence IS NULL AND layer_id = $1 AND (tile_y, tile_x, first_sequence) >= (t.tile_y, t.tile_x, 0) "
    "AND (tile_y, tile_x, first_sequence) <= (t.tile_y, t.tile_x, $2) "
    "ORDER BY tile_y DESC, tile_x DESC, first_sequence DESC LIMIT 1) UNION ALL "
    "(SELECT sequence, (sequence = k.sequence IS TRUE)::integer, CASE WHEN sequence = k.sequence THEN key_tile ELSE difference END "
    "FROM tile_revisions WHERE layer_id = $1 AND (tile_y, tile_x, sequence) >= (t.tile_y, t.tile_x, coalesce(k.sequence, 0)) "
    "AND (tile_y, tile_x, sequence) <= (t.tile_y, t.tile_x, $2)) ORDER BY sequence) r ON true");

constexpr auto kLoadTiles = sql(
    "WITH RECURSIVE in_rows AS ("
    "(SELECT tile_y, tile_x FROM tile_revisions WHERE layer_id = $1 ORDER BY tile_y, tile_x LIMIT 1) UNION ALL "
    "SELECT n.tile_y, n.tile_x FROM in_rows t CROSS JOIN LATERAL (SELECT tile_y, tile_x FROM tile_revisions "
    "WHERE layer_id = $1 AND (tile_y, tile_x) > (t.tile_y, t.tile_x) ORDER BY tile_y, tile_x LIMIT 1) n), "
    "in_segments AS ("
    "(SELECT tile_y, tile_x FROM tile_segments WHERE layer_id = $1 ORDER BY tile_y, tile_x LIMIT 1) UNION ALL "
    "SELECT n.tile_y, n.tile_x FROM in_segments t CROSS JOIN LATERAL (SELECT tile_y, tile_x FROM tile_segments "
    "WHERE layer_id = $1 AND (tile_y, tile_x) > (t.tile_y, t.tile_x) ORDER BY tile_y, tile_x LIMIT 1) n), "
    "tiles AS MATERIALIZED (SELECT tile_y, tile_x FROM in_rows UNION SELECT tile_y, tile_x FROM in_segments "
    "ORDER BY tile_y, tile_x) ",
    kRowsOfTiles);

// Selects only the tiles that edits after $3 and up to $4 wrote. The state from which the caller
// starts, $5, may contain a part of a stroke that was merged since it was read. $6 is the largest
// span of a merged stroke. The stroke may also have become part of a checkpoint, which has no
// largest span. But it begins within $6, so it is one of the edits up to there or the next one.
constexpr auto kLoadTilesNear = sql(
    "WITH tiles AS MATERIALIZED (SELECT tile_y, tile_x FROM tile_revisions "
    "WHERE layer_id = $1 AND sequence > $3 AND sequence <= $4 UNION "
    "SELECT (t / 128)::smallint, (t % 128)::smallint FROM edits, unnest(tiles) t WHERE layer_id = $1 "
    "AND sequence > $3 AND sequence <= $4 UNION "
    "SELECT (t / 128)::smallint, (t % 128)::smallint FROM edits, unnest(tiles) t WHERE layer_id = $1 "
    "AND sequence > $5 AND sequence <= $5 + $6 AND (first_sequence <= $5 OR op = 'checkpoint') UNION "
    "SELECT (t / 128)::smallint, (t % 128)::smallint FROM (SELECT op, tiles FROM edits WHERE layer_id = $1 "
    "AND sequence > $5 + $6 ORDER BY sequence LIMIT 1) e, unnest(e.tiles) t WHERE e.op = 'checkpoint' "
    "ORDER BY tile_y, tile_x) ",
    kRowsOfTiles);

Result<void> add_row(TileLoader& loader, const PgResult& row) {
  if (row.null(0, 2)) return {};  // the tile was empty until then
  return loader.add(read_address(row, 0), row.integer(0, 2), static_cast<Part>(row.integer(0, 3)),
                    row.bytes(0, 4));
}

}  // namespace

Result<TileMirror::Snapshot> Journal::load_tiles(const Layer& layer,
                                                 std::optional<std::int64_t> at_sequence) {
  return pool_.read([&](PgConnection& connection) -> Result<TileMirror::Snapshot> {
    // Read the sequence and the tiles from one snapshot, because a stroke may be merged in between.
    auto transaction = STRATA_TRY(Transaction::begin_reading(connection));
    auto last = STRATA_TRY(connection.query(
        "SELECT (SELECT coalesce(max(sequence), 0) FROM edits WHERE layer_id = l.id AND sequence <= $2) "
        "FROM layers l WHERE id = $1",
        Params().id(layer.id).integer(
            at_sequence.value_or(std::numeric_limits<std::int64_t>::max()))));
    if (last.rows() == 0) return no_such("layer", to_string(layer.id));
    if (at_sequence) STRATA_TRY(check_kept(connection, layer.id, *at_sequence));
    const std::int64_t sequence = last.integer(0, 0);
    TileLoader loader(layer.type, sequence);
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
    auto transaction = STRATA_TRY(Transaction::begin_reading(connection));
    STRATA_TRY(check_kept(connection, layer.id, sequence));
    TileLoader loader(layer.type, sequence);
    STRATA_TRY(connection.each_row(kLoadTilesNear.c_str(),
                                   Params()
                                       .id(layer.id)
                                       .integer(sequence)
                                       .integer(std::min(sequence, near.sequence))
                                       .integer(std::max(sequence, near.sequence))
                                       .integer(near.sequence)
                                       .integer(MergeRules{}.max_span),
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
    auto transaction = STRATA_TRY(Transaction::begin_reading(connection));
    STRATA_TRY(check_kept(connection, model_id, sequence));
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

namespace {

constexpr int kPastAtOnce = 32;  // limits the part of a tile's history in memory

// The state of the edit of a revision.
struct EditState {
  bool writer = true, in_force = true, provisional = false;
};

// Reads the revisions of one tile backward, first the rows and then the segments.
class TilePast {
 public:
  TilePast(PgConnection& connection, const Layer& layer, TileAddress tile)
      : connection_(connection), layer_(layer), tile_(tile) {}

  // Returns the next revisions, newest first. Returns nothing after the oldest one.
  Result<std::vector<PastRevision>> next() {
    auto revisions = STRATA_TRY(in_rows());
    if (revisions.empty()) revisions = STRATA_TRY(in_segment());
    if (!revisions.empty()) before_ = revisions.back().sequence;
    return revisions;
  }

 private:
  Params of_tile() const {
    Params params;
    params.id(layer_.id).integer(tile_.y).integer(tile_.x).integer(before_);
    return params;
  }

  Result<std::vector<PastRevision>> in_rows() {
    std::vector<PastRevision> revisions;
    if (rows_ended_) return revisions;
    auto rows = STRATA_TRY(connection_.query(
        "SELECT r.sequence, e.writer, e.in_force, coalesce(e.review = 'pending', false), r.difference FROM tile_revisions r "
        "JOIN edits e ON e.model_id = $5 AND e.sequence = r.sequence "
        "WHERE r.layer_id = $1 AND r.tile_y = $2 AND r.tile_x = $3 AND r.sequence < $4 ORDER BY r.sequence DESC LIMIT $6",
        of_tile().id(layer_.model_id).integer(kPastAtOnce)));
    rows_ended_ = rows.rows() < kPastAtOnce;
    for (int i = 0; i < rows.rows(); ++i) {
      auto revision = STRATA_TRY(decode_revision(tile_, layer_.type, rows.bytes(i, 4)));
      revisions.push_back({rows.integer(i, 0), rows.boolean(i, 1), rows.boolean(i, 2),
                           rows.boolean(i, 3), std::move(revision)});
    }
    return revisions;
  }

  Result<std::vector<PastRevision>> in_segment() {
    std::vector<PastRevision> revisions;
    auto rows = STRATA_TRY(connection_.query(
        "SELECT content FROM tile_segments WHERE layer_id = $1 AND tile_y = $2 AND tile_x = $3 AND first_sequence < $4 "
        "ORDER BY first_sequence DESC LIMIT 1",
        of_tile()));
    if (rows.rows() == 0) return revisions;
    auto segment = STRATA_TRY(decode_segment(tile_, layer_.type, rows.bytes(0, 0)));
    const auto states = STRATA_TRY(states_of(segment));
    for (auto entry = segment.entries.rbegin(); entry != segment.entries.rend(); ++entry) {
      if (entry->sequence >= before_) continue;
      const auto state = states.find(entry->sequence);
      if (state == states.end())
        return fail(ErrorCode::internal, "Damaged journal",
                    "The edit " + std::to_string(entry->sequence) + " of a revision is missing.");
      revisions.push_back({entry->sequence, state->second.writer, state->second.in_force,
                           state->second.provisional, std::move(entry->revision)});
    }
    return revisions;
  }

  Result<std::map<std::int64_t, EditState>> states_of(const TileSegment& segment) {
    PgArray sequences(oid::kInt8);
    for (const auto& entry : segment.entries) sequences.add(entry.sequence);
    auto rows = STRATA_TRY(connection_.query(
        "SELECT sequence, writer, in_force, coalesce(review = 'pending', false) FROM edits "
        "WHERE model_id = $1 AND sequence = any($2)",
        Params().id(layer_.model_id).array(sequences)));
    std::map<std::int64_t, EditState> states;
    for (int i = 0; i < rows.rows(); ++i)
      states[rows.integer(i, 0)] = {rows.boolean(i, 1), rows.boolean(i, 2), rows.boolean(i, 3)};
    return states;
  }

  PgConnection& connection_;
  const Layer& layer_;
  const TileAddress tile_;
  std::int64_t before_ = std::numeric_limits<std::int64_t>::max();
  bool rows_ended_ = false;
};

void add_written(const TileMask& mask, TileMask& written) {
  for (int w = 0; w < kMaskWords; ++w) written.words[w] |= mask.words[w];
}

}  // namespace

Result<void> Journal::tile_past(const Layer& layer, TileAddress tile,
                                const std::function<void()>& begin,
                                const std::function<bool(PastRevision&)>& on_revision) {
  return pool_.read([&](PgConnection& connection) -> Result<void> {
    auto transaction = STRATA_TRY(Transaction::begin_reading(connection));
    begin();
    TilePast past(connection, layer, tile);
    for (;;) {
      auto revisions = STRATA_TRY(past.next());
      if (revisions.empty()) return {};
      for (PastRevision& revision : revisions)
        if (!on_revision(revision)) return {};
    }
  });
}

Result<std::vector<WrittenTiles>> Journal::written_by(const Layer& layer,
                                                      std::span<const std::int64_t> sequences) {
  PgArray list(oid::kInt8);
  for (const std::int64_t sequence : sequences) list.add(sequence);
  const std::set<std::int64_t> named(sequences.begin(), sequences.end());
  return pool_.read([&](PgConnection& connection) -> Result<std::vector<WrittenTiles>> {
    auto transaction = STRATA_TRY(Transaction::begin_reading(connection));
    std::map<std::pair<std::uint16_t, std::uint16_t>, TileMask> written;  // by y and x
    const auto mask_of = [&](TileAddress tile) -> TileMask& { return written[{tile.y, tile.x}]; };
    STRATA_TRY(connection.each_row(
        "SELECT tile_y, tile_x, difference FROM tile_revisions WHERE layer_id = $1 AND sequence = any($2)",
        Params().id(layer.id).array(list), [&](const PgResult& row) -> Result<void> {
          const TileAddress address = read_address(row, 0);
          const auto revision = STRATA_TRY(decode_revision(address, layer.type, row.bytes(0, 2)));
          add_written(revision.written, mask_of(address));
          return {};
        }));
    // A tile whose revision is still a row has no segment that contains the edit.
    STRATA_TRY(connection.each_row(
        "SELECT DISTINCT ON (g.tile_y, g.tile_x, g.first_sequence) g.tile_y, g.tile_x, g.content "
        "FROM edits e CROSS JOIN LATERAL unnest(e.tiles) t CROSS JOIN LATERAL (SELECT * FROM tile_segments "
        "WHERE layer_id = $1 AND tile_y = (t / 128)::smallint AND tile_x = (t % 128)::smallint "
        "AND first_sequence <= e.sequence ORDER BY first_sequence DESC LIMIT 1) g "
        "WHERE e.model_id = $3 AND e.sequence = any($2) AND g.last_sequence >= e.sequence "
        "ORDER BY g.tile_y, g.tile_x, g.first_sequence",
        Params().id(layer.id).array(list).id(layer.model_id),
        [&](const PgResult& row) -> Result<void> {
          const TileAddress address = read_address(row, 0);
          const auto segment = STRATA_TRY(decode_segment(address, layer.type, row.bytes(0, 2)));
          for (const auto& entry : segment.entries)
            if (named.contains(entry.sequence))
              add_written(entry.revision.written, mask_of(address));
          return {};
        }));
    std::vector<WrittenTiles> tiles;
    for (const auto& [place, mask] : written)
      tiles.push_back({TileAddress{place.second, place.first}, mask});
    return tiles;
  });
}

Result<std::uint64_t> Journal::revision_bytes(ModelId model_id) {
  auto row = STRATA_TRY(pool_.read_within(kBulkLimits, [&](PgConnection& connection) {
    return connection.query(
        "SELECT (SELECT coalesce(sum(octet_length(r.difference) + coalesce(octet_length(r.key_tile), 0)), 0) "
        "FROM layers l JOIN tile_revisions r ON r.layer_id = l.id WHERE l.model_id = $1)::bigint + "
        "(SELECT coalesce(sum(octet_length(s.content)), 0) FROM layers l JOIN tile_segments s ON s.layer_id = l.id "
        "WHERE l.model_id = $1)::bigint",
        Params().id(model_id));
  }));
  return static_cast<std::uint64_t>(row.integer(0, 0));
}

}  // namespace strata::store
