#include "store/journal/checkpoint_group.h"

#include <algorithm>
#include <iterator>
#include <map>

#include "domain/layers/checkpoint.h"
#include "domain/layers/revision.h"
#include "store/journal/journal_merger.h"
#include "store/pg/pg_row.h"

namespace strata::store {
namespace {

tl::unexpected<Error> damaged(const char* why) {
  return fail(ErrorCode::internal, "Damaged journal", why);
}

tl::unexpected<Error> too_large() {
  return fail(ErrorCode::too_large, "Too many edits",
              "The revisions of the edits are too large for one transaction.");
}

struct StoredRow {
  std::int64_t sequence = 0;
  std::vector<std::uint8_t> difference, key;  // the key may be empty
};
struct StoredSegment {
  std::int64_t first = 0, last = 0;
  TileSegment segment;
};
using TileEntries = std::vector<TileSegment::Entry>;

// Joins the revisions of a group of edits tile by tile.
class RevisionJoiner {
 public:
  RevisionJoiner(PgConnection& connection, LayerId layer, ValueType type,
                 const std::vector<GroupEdit>& edits, std::size_t bytes)
      : connection_(connection), layer_(layer), type_(type), at_(new_edits(edits)), bytes_(bytes) {
    for (const GroupEdit& edit : edits) effective_[edit.sequence] = edit.is_effective;
  }

  // `rows` are the rows of the group in the tile, ascending.
  Result<void> add(TileAddress tile, const std::vector<StoredRow>& rows) {
    tile_ = tile;
    auto segments = STRATA_TRY(read_segments());
    TileEntries earlier, later;
    std::vector<PastRevision> joined;
    TileData now(type_);  // after the last revision that was read
    if (!segments.empty()) now = segments.front().segment.before;
    for (StoredSegment& stored : segments) {
      if (stored.segment.before != now)
        return damaged("A segment does not begin with the tile at the end of the one before it.");
      for (auto& entry : stored.segment.entries) {
        apply(entry.revision, now);
        if (effective_.contains(entry.sequence))
          joined.push_back(past(entry.sequence, std::move(entry.revision)));
        else
          (entry.sequence < first() ? earlier : later).push_back(std::move(entry));
      }
    }
    if (!rows.empty() && !later.empty())
      return damaged("A tile has rows before the end of its segments.");
    std::optional<TileData> key;
    for (const StoredRow& row : rows) {
      auto revision = STRATA_TRY(decode_revision(tile, type_, row.difference));
      apply(revision, now);
      if (key) apply(revision, *key);
      if (!row.key.empty()) {
        auto stored = STRATA_TRY(decode_tile(type_, row.key));
        if (segments.empty() ? key && *key != stored : now != stored)
          return damaged("A key tile differs from the revisions before it.");
        key = std::move(stored);
      }
      joined.push_back(past(row.sequence, std::move(revision)));
    }
    if (joined.empty()) return {};
    auto entries = STRATA_TRY(join(joined));
    if (segments.empty()) return put_rows(std::move(entries), key);

    TileEntries all = std::move(earlier);
    std::ranges::move(entries, std::back_inserter(all));
    std::ranges::move(later, std::back_inserter(all));
    for (const StoredSegment& stored : segments)
      made_.old_segments.emplace_back(tile, stored.first);
    return put_segments(segments.front().segment.before, std::move(all), now);
  }
  NewRevisions finish() && { return std::move(made_); }

 private:
  std::int64_t first() const { return effective_.begin()->first; }
  std::int64_t last() const { return effective_.rbegin()->first; }
  PastRevision past(std::int64_t sequence, TileRevision revision) const {
    return {sequence, true, effective_.at(sequence), false, std::move(revision)};
  }

  // Returns the segments that contain revisions of the group. Also returns the segment before them
  // if both have few revisions, because each segment contains a whole tile.
  Result<std::vector<StoredSegment>> read_segments() {
    auto rows = STRATA_TRY(connection_.query(
        "SELECT * FROM ((SELECT first_sequence, last_sequence, content FROM tile_segments WHERE layer_id = $1 AND tile_y = $2 "
        "AND tile_x = $3 AND first_sequence < $4 ORDER BY first_sequence DESC LIMIT 1) UNION ALL "
        "(SELECT first_sequence, last_sequence, content FROM tile_segments WHERE layer_id = $1 AND tile_y = $2 "
        "AND tile_x = $3 AND first_sequence >= $4 AND first_sequence <= $5)) s ORDER BY first_sequence",
        Params().id(layer_).integer(tile_.y).integer(tile_.x).integer(first()).integer(last())));
    std::vector<StoredSegment> segments;
    std::size_t others =
        0;  // revisions that are not in the group, except those of an earlier segment
    for (int i = 0; i < rows.rows(); ++i) {
      bytes_ += rows.bytes(i, 2).size();
      if (bytes_ > kMaxGroupBytes) return too_large();
      StoredSegment stored{rows.integer(i, 0), rows.integer(i, 1), {}};
      stored.segment = STRATA_TRY(decode_segment(tile_, type_, rows.bytes(i, 2)));
      if (stored.last >= first())
        for (const auto& entry : stored.segment.entries)
          others += effective_.contains(entry.sequence) ? 0 : 1;
      segments.push_back(std::move(stored));
    }
    const bool has_earlier = !segments.empty() && segments.front().last < first();
    if (has_earlier &&
        (segments.size() == 1 || segments.front().segment.entries.size() + others + 2 >
                                     JournalMerger::kRevisionsPerSegment))
      segments.erase(segments.begin());
    return segments;
  }

  Result<TileEntries> join(const std::vector<PastRevision>& joined) const {
    Checkpoint checkpoint = join_revisions(joined);
    if (checkpoint.rest && !at_.rest_at)
      return damaged("A revision changes texels that its edit did not write.");
    if (!is_equivalent(joined, checkpoint))
      return damaged("The joined revisions differ from the original ones.");
    TileEntries entries;
    if (checkpoint.written) entries.push_back({*at_.written_at, std::move(*checkpoint.written)});
    if (checkpoint.rest) entries.push_back({*at_.rest_at, std::move(*checkpoint.rest)});
    return entries;
  }

  // Chains of revisions must not get longer, so the last row has a whole tile if one of the old
  // rows has one.
  Result<void> put_rows(TileEntries entries, const std::optional<TileData>& key) {
    if (entries.empty() && key) entries.push_back({last(), {tile_, {}, TileData(type_)}});
    for (const auto& entry : entries) {
      NewRevisions::Row row{tile_, entry.sequence, encode_revision(entry.revision), {}};
      const auto again = decode_revision(tile_, type_, row.difference);
      if (!again || !(*again == entry.revision))
        return damaged("An encoded revision differs from the original one.");
      if (key && &entry == &entries.back()) {
        row.key = encode_tile(*key);
        const auto same = decode_tile(type_, row.key);
        if (!same || *same != *key)
          return damaged("An encoded key tile differs from the original one.");
      }
      made_.rows.push_back(std::move(row));
    }
    return {};
  }

  Result<void> put_segments(TileData before, TileEntries entries, const TileData& last) {
    for (std::size_t i = 0; i < entries.size();) {
      TileSegment segment{before, {}};
      for (; i < entries.size() && segment.entries.size() < JournalMerger::kRevisionsPerSegment;
           ++i) {
        apply(entries[i].revision, before);
        segment.entries.push_back(std::move(entries[i]));
      }
      auto packed = pack(tile_, type_, segment);
      if (!packed) return damaged("A segment cannot be encoded.");
      made_.segments.push_back(std::move(*packed));
    }
    if (before != last) return damaged("The joined revisions result in another tile.");
    return {};
  }

  PgConnection& connection_;
  const LayerId layer_;
  const ValueType type_;
  const NewEdits at_;
  std::size_t bytes_;                       // of the old rows and segments
  std::map<std::int64_t, bool> effective_;  // by sequence, of the edits of the group
  TileAddress tile_;
  NewRevisions made_;
};

}  // namespace

Result<std::optional<std::vector<GroupEdit>>> read_edits(PgConnection& connection, ModelId model,
                                                         std::int64_t through,
                                                         const PgArray& sequences) {
  constexpr auto kEdits = sql(
      "SELECT e.sequence, e.id, e.stroke, e.user_name, e.op, e.time, coalesce(e.first_time, e.time), coalesce(e.first_sequence, 0), "
      "e.writer AND e.in_force, CASE WHEN e.op = 'checkpoint' THEN e.record ELSE '{}' END, "
      "CASE WHEN jsonb_typeof(e.answer) = 'object' THEN e.answer ELSE '{}' END, "
      "coalesce((SELECT string_agg(int2send(t), ''::bytea ORDER BY t) FROM unnest(e.tiles) t), ''::bytea), ",
      kState, ", ", kStays,
      " FROM edits e WHERE e.model_id = $1 AND e.sequence = any($2) ORDER BY e.sequence");
  auto rows =
      STRATA_TRY(connection.query(kEdits, Params().id(model).array(sequences).integer(through)));
  if (rows.rows() != sequences.size()) return std::nullopt;
  std::vector<GroupEdit> edits;
  for (int i = 0; i < rows.rows(); ++i) {
    PgRow row(rows, i);
    GroupEdit edit;
    edit.sequence = row.integer();
    edit.id = row.uuid();
    edit.stroke = row.uuid();
    edit.user = row.text();
    edit.op = row.text();
    edit.time = row.time();
    edit.first_time = row.time();
    edit.first_sequence = row.integer();
    edit.is_effective = row.boolean();
    edit.record = row.json();
    edit.answer = row.json();
    edit.tiles = read_tile_numbers(rows.bytes(i, 11));
    edit.state = rows.text(i, 12);
    if (rows.boolean(i, 13)) return std::nullopt;
    edits.push_back(std::move(edit));
  }
  return edits;
}

NewEdits new_edits(const std::vector<GroupEdit>& edits) {
  const auto effective = std::ranges::count(edits, true, &GroupEdit::is_effective);
  const std::int64_t last = edits.back().sequence;
  if (effective == 0) return {std::nullopt, last};
  if (effective == std::ssize(edits)) return {last, std::nullopt};
  return {edits[edits.size() - 2].sequence, last};
}

Result<JoinedGroup> join_group(PgConnection& connection, LayerId layer, ValueType type,
                               const std::vector<GroupEdit>& edits, const PgArray& sequences) {
  const auto size = STRATA_TRY(connection.query(
      "SELECT coalesce(sum(octet_length(difference) + coalesce(octet_length(key_tile), 0)), 0)::bigint "
      "FROM tile_revisions WHERE layer_id = $1 AND sequence = any($2)",
      Params().id(layer).array(sequences)));
  const auto bytes = static_cast<std::size_t>(size.integer(0, 0));
  if (bytes > kMaxGroupBytes) return too_large();
  JoinedGroup group;
  std::map<std::int16_t, std::vector<StoredRow>> rows;  // by tile
  STRATA_TRY(connection.each_row(
      "SELECT tile_y, tile_x, sequence, difference, key_tile FROM tile_revisions WHERE layer_id = $1 "
      "AND sequence = any($2) ORDER BY tile_y, tile_x, sequence",
      Params().id(layer).array(sequences), [&](const PgResult& row) -> Result<void> {
        const Bytes difference = row.bytes(0, 3);
        StoredRow stored{row.integer(0, 2), {difference.begin(), difference.end()}, {}};
        if (!row.null(0, 4)) {
          const Bytes key = row.bytes(0, 4);
          stored.key.assign(key.begin(), key.end());
        }
        rows[number_of_tile(address_of(row, 0))].push_back(std::move(stored));
        ++group.old_rows;
        return {};
      }));
  for (const GroupEdit& edit : edits) group.tiles.insert(edit.tiles.begin(), edit.tiles.end());
  for (const auto& [tile, stored] : rows) group.tiles.insert(tile);
  RevisionJoiner joiner(connection, layer, type, edits, bytes);
  for (const std::int16_t tile : group.tiles) {
    const auto found = rows.find(tile);
    STRATA_TRY(joiner.add(tile_of_number(tile),
                          found == rows.end() ? std::vector<StoredRow>() : found->second));
  }
  group.revisions = std::move(joiner).finish();
  return group;
}

}  // namespace strata::store
