#include "store/journal/journal_merger.h"

#include <algorithm>
#include <deque>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <utility>

#include "core/log.h"
#include "domain/layers/revision.h"
#include "domain/layers/tile_segment.h"
#include "store/cluster/schema_readers.h"
#include "store/journal/journal_reads.h"
#include "store/journal/journal_rewrite.h"
#include "store/nodes/deposed.h"
#include "store/pg/pg_row.h"
#include "store/pg/pool.h"

namespace strata::store {
namespace {

constexpr int kListsAtOnce = 200;
constexpr int kTilesAtOnce = 4;                    // packed in one transaction
constexpr std::size_t kRevisionsUntilCount = 512;  // of a layer, until its tiles are counted again

// The edits after $2, with their tiles as big-endian numbers. Only batches have traits.
constexpr const char* kWindow =
    "SELECT e.sequence, e.layer_id, e.stroke, e.user_name, e.time, b.is_batch, CASE WHEN b.is_batch THEN "
    "concat_ws('|', e.in_force, coalesce(e.undone_by, 0), coalesce(e.review, ''), coalesce(e.reviewed_by, 0), "
    "coalesce(e.answer ->> 'provisional', ''), hashtextextended((e.record - '{path,widths,n}'::text[])::text, 0)) ELSE '' END, "
    "coalesce(CASE WHEN e.tiles IS NOT NULL THEN (SELECT string_agg(int2send(t), ''::bytea ORDER BY t) FROM unnest(e.tiles) t) "
    "ELSE (SELECT string_agg(int2send((r.tile_y * 128 + r.tile_x)::smallint), ''::bytea ORDER BY r.tile_y, r.tile_x) "
    "FROM tile_revisions r WHERE r.layer_id = e.layer_id AND r.sequence = e.sequence) END, ''::bytea), "
    "CASE WHEN b.is_batch THEN jsonb_array_length(e.record -> 'path') ELSE 0 END "
    "FROM edits e CROSS JOIN LATERAL (SELECT coalesce(e.op = 'stroke' AND e.first_sequence IS NULL AND "
    "jsonb_typeof(e.record) = 'object' AND jsonb_typeof(e.record -> 'n') = 'number' AND jsonb_typeof(e.record -> 'path') = 'array', "
    "false) AS is_batch) b "
    "WHERE e.model_id = $1 AND e.sequence > $2 ORDER BY e.sequence LIMIT $3";

// --- the transaction

// Begins a transaction that blocks edits only for a short time. The rows of the model and the layer
// are locked in the order of the journal writer, so that the two cannot cause a deadlock.
void begin_fenced(ModelId model, std::int64_t epoch, LayerId layer, const LayerState& state,
                  Statements& out) {
  begin_rewrite(out);
  Params of_model, of_layer;
  of_model.id(model).integer(epoch);
  out.push_back(
      {"SELECT 1 FROM all_models WHERE id = $1 AND owner_epoch = $2 AND binned IS NULL FOR SHARE",
       std::move(of_model)});
  of_layer.id(layer).id(model).text(name(state.type));
  out.push_back(
      {"SELECT 1 FROM all_layers WHERE id = $1 AND model_id = $2 AND type = $3 AND NOT erasing "
       "FOR SHARE",
       std::move(of_layer)});
  find_state(layer, state, out);
}
// Places in the results.
constexpr std::size_t kModelRow = 2, kLayerRow = 3, kStateRow = 4, kFirstChange = 5;

// Returns `moved` if another server has the model, and otherwise `conflict`: the rows have changed
// since they were read, so the merge is tried again later.
Result<void> not_merged(PgConnection& connection, ModelId model, std::int64_t epoch) {
  auto deposed = STRATA_TRY(deposed_problem(connection, model, epoch));
  if (deposed) return tl::unexpected(std::move(*deposed));
  return fail(ErrorCode::conflict, "Journal has changed",
              "The edits changed while the server merged them. It tries again later.");
}

// Runs the statements, and commits if `is_complete(results)` is true. Otherwise the transaction has
// no effect.
template <class IsComplete>
Result<void> commit_if(PgConnection& connection, ModelId model, std::int64_t epoch,
                       const Statements& statements, IsComplete is_complete) {
  {
    Transaction transaction = Transaction::adopt(connection);
    const auto results = connection.pipeline(statements);
    if (!results) return tl::unexpected(failed_statement(connection, results.error()));
    if ((*results)[kModelRow].rows() == 1 && (*results)[kLayerRow].rows() == 1 &&
        (*results)[kStateRow].rows() == 1 && is_complete(*results))
      return transaction.commit();
  }
  return not_merged(connection, model, epoch);
}

// --- merging the edits of a stroke

struct Batch {
  std::int64_t sequence = 0;
  Uuid id;
  Time time;
  nlohmann::json record, answer;
};

struct MergedEdit {
  nlohmann::json record, answer;
};

bool has_same_brush(nlohmann::json a, nlohmann::json b) {
  for (nlohmann::json* record : {&a, &b})
    for (const char* member : {"path", "widths", "n"}) record->erase(member);
  return a == b;
}

// Returns the widths of the points of the batch, or nothing if they are not valid.
std::optional<nlohmann::json> widths_of(const nlohmann::json& record) {
  const std::size_t points = record.at("path").size();
  const auto widths = record.find("widths");
  if (widths == record.end()) return nlohmann::json(std::vector<double>(points, 1));
  if (!widths->is_array() || widths->size() != points) return std::nullopt;
  return *widths;
}

// Joins the paths. Each batch begins at the end of the one before it.
std::optional<nlohmann::json> join_records(const std::vector<Batch>& batches) {
  nlohmann::json joined = batches.front().record;
  nlohmann::json path = nlohmann::json::array(), widths = nlohmann::json::array();
  bool has_widths = false;
  for (const Batch& batch : batches) {
    if (!has_same_brush(batch.record, joined)) return std::nullopt;
    const auto own = widths_of(batch.record);
    if (!own) return std::nullopt;
    has_widths = has_widths || batch.record.contains("widths");
    const nlohmann::json& points = batch.record.at("path");
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (i == 0 && !path.empty() && path.back() == points[0] && widths.back() == (*own)[0])
        continue;
      path.push_back(points[i]);
      widths.push_back((*own)[i]);
    }
  }
  joined["path"] = std::move(path);
  joined.erase("widths");
  if (has_widths) joined["widths"] = std::move(widths);
  joined["n"] = batches.back().record.at("n");
  return joined;
}

std::optional<MergedEdit> join_batches(const std::vector<Batch>& batches) {
  auto record = join_records(batches);
  if (!record) return std::nullopt;
  MergedEdit merged{std::move(*record), batches.back().answer};
  std::uint64_t texels = 0;
  double area_m2 = 0;
  for (const Batch& batch : batches) {
    if (!batch.answer.is_object() ||
        batch.answer.value("sequence", std::int64_t{0}) != batch.sequence)
      return std::nullopt;
    texels += batch.answer.value("texels_changed", std::uint64_t{0});
    area_m2 += batch.answer.value("area_m2", 0.0);
  }
  merged.answer["texels_changed"] = texels;
  merged.answer["area_m2"] = area_m2;
  return merged;
}

Result<std::vector<Batch>> read_batches(PgConnection& connection, ModelId model,
                                        const PgArray& sequences) {
  auto rows = STRATA_TRY(connection.query(
      "SELECT sequence, id, time, record, answer FROM edits WHERE model_id = $1 AND sequence = any($2) "
      "ORDER BY sequence",
      Params().id(model).array(sequences)));
  std::vector<Batch> batches;
  for (int i = 0; i < rows.rows(); ++i) {
    PgRow row(rows, i);
    batches.push_back({row.integer(), row.uuid(), row.time(), row.json(), row.json()});
  }
  return batches;
}

// The revisions of a group, joined for each tile.
struct JoinedRevisions {
  std::vector<TileAddress> tiles;  // ascending by y, then x
  std::vector<std::vector<std::uint8_t>> differences;
  std::vector<std::vector<std::uint8_t>> keys;  // empty: no whole tile
  std::int64_t rows = 0;
  bool can_merge = true;
};

class Joiner {
 public:
  explicit Joiner(ValueType type) : type_(type) {}

  Result<void> add(TileAddress tile, Bytes difference, std::optional<Bytes> key) {
    auto revision = STRATA_TRY(decode_revision(tile, type_, difference));
    ++joined_.rows;
    joined_.can_merge = joined_.can_merge && differs_only_where_written(revision);
    if (current_ && current_->address == tile) {
      append(revision, *current_);
      if (key_) apply(revision, *key_);
    } else {
      end_tile();
      current_ = std::move(revision);
    }
    // Chains of revisions must not get longer, so the merged revision has a whole tile if one of
    // its parts has one.
    if (key) key_ = STRATA_TRY(decode_tile(type_, *key));
    return {};
  }
  JoinedRevisions finish() && {
    end_tile();
    return std::move(joined_);
  }

 private:
  void end_tile() {
    if (!current_) return;
    joined_.tiles.push_back(current_->address);
    joined_.differences.push_back(encode_revision(*current_));
    joined_.keys.push_back(key_ ? encode_tile(*key_) : std::vector<std::uint8_t>());
    current_.reset();
    key_.reset();
  }

  const ValueType type_;
  std::optional<TileRevision> current_;
  std::optional<TileData> key_;
  JoinedRevisions joined_;
};

Result<JoinedRevisions> join_revisions(PgConnection& connection, LayerId layer, ValueType type,
                                       const PgArray& sequences) {
  Joiner joiner(type);
  STRATA_TRY(connection.each_row(
      "SELECT tile_y, tile_x, difference, key_tile FROM tile_revisions WHERE layer_id = $1 "
      "AND sequence = any($2) ORDER BY tile_y, tile_x, sequence",
      Params().id(layer).array(sequences), [&](const PgResult& row) {
        return joiner.add(address_of(row, 0), row.bytes(0, 2),
                          row.null(0, 3) ? std::nullopt : std::optional(row.bytes(0, 3)));
      }));
  return std::move(joiner).finish();
}

void replace_edits(ModelId model, const std::vector<Batch>& batches, const MergedEdit& merged,
                   const JoinedRevisions& revisions, Statements& out) {
  PgArray earlier(oid::kInt8), tiles(oid::kInt2);
  for (std::size_t i = 0; i + 1 < batches.size(); ++i) earlier.add(batches[i].sequence);
  for (const TileAddress tile : revisions.tiles) tiles.add_int2(number_of_tile(tile));
  Params remove, change;
  remove.id(model).array(earlier);
  out.push_back(
      {"DELETE FROM edits WHERE model_id = $1 AND sequence = any($2) AND first_sequence IS NULL "
       "RETURNING concat_ws('|', in_force, coalesce(undone_by, 0), coalesce(review, ''), coalesce(reviewed_by, 0))",
       std::move(remove)});
  change.id(model)
      .integer(batches.back().sequence)
      .json(merged.record)
      .json(merged.answer)
      .integer(batches.front().sequence)
      .array(tiles)
      .time(batches.front().time);
  out.push_back(
      {"UPDATE edits SET record = $3, answer = $4, first_sequence = $5, tiles = $6, first_time = $7 "
       "WHERE model_id = $1 AND sequence = $2 AND first_sequence IS NULL "
       "RETURNING concat_ws('|', in_force, coalesce(undone_by, 0), coalesce(review, ''), coalesce(reviewed_by, 0))",
       std::move(change)});
}

void insert_batches(ModelId model, LayerId layer, const std::vector<Batch>& batches,
                    Statements& out) {
  PgArray ids(oid::kUuid), sequences(oid::kInt8), texels(oid::kInt8), areas(oid::kFloat8);
  for (const Batch& batch : batches) {
    ids.add(batch.id);
    sequences.add(batch.sequence);
    texels.add(batch.answer.value("texels_changed", std::int64_t{0}));
    areas.add(batch.answer.value("area_m2", 0.0));
  }
  Params params;
  params.id(model).id(layer).integer(batches.back().sequence);
  params.array(ids).array(sequences).array(areas).array(texels);
  out.push_back(
      {"INSERT INTO edit_batches (model_id, layer_id, edit, id, sequence, area_m2, texels_changed) "
       "SELECT $1, $2, $3, b.id, b.sequence, b.area, b.texels FROM unnest($4::uuid[], $5::bigint[], $6::float8[], $7::bigint[]) "
       "AS b (id, sequence, area, texels)",
       std::move(params)});
}

void replace_revisions(LayerId layer, const PgArray& sequences, std::int64_t last,
                       const JoinedRevisions& revisions, Statements& out) {
  Params remove, insert;
  remove.id(layer).array(sequences);
  out.push_back(
      {"DELETE FROM tile_revisions WHERE layer_id = $1 AND sequence = any($2)", std::move(remove)});
  PgArray ys(oid::kInt2), xs(oid::kInt2), differences(oid::kBytea), keys(oid::kBytea);
  for (std::size_t i = 0; i < revisions.tiles.size(); ++i) {
    ys.add_int2(static_cast<std::int16_t>(revisions.tiles[i].y));
    xs.add_int2(static_cast<std::int16_t>(revisions.tiles[i].x));
    differences.add(Bytes(revisions.differences[i]));
    if (revisions.keys[i].empty())
      keys.add_null();
    else
      keys.add(Bytes(revisions.keys[i]));
  }
  insert.id(layer).integer(last).array(ys).array(xs).array(differences).array(keys);
  out.push_back(
      {"INSERT INTO tile_revisions (layer_id, sequence, tile_y, tile_x, difference, key_tile) "
       "SELECT $1, $2, r.* FROM unnest($3::smallint[], $4::smallint[], $5::bytea[], $6::bytea[]) AS r",
       std::move(insert)});
}

// Returns a row if people have named a state in the middle of the batches since the window was
// read. A new snapshot locks the model, so none can follow while the transaction has its lock.
void find_named_state(ModelId model, const std::vector<std::int64_t>& sequences, Statements& out) {
  Params params;
  params.id(model).integer(sequences.front()).integer(sequences.back());
  out.push_back(
      {"SELECT 1 FROM snapshots WHERE model_id = $1 AND jsonb_typeof(content -> 'sequence') = 'number' "
       "AND (content ->> 'sequence')::bigint >= $2 AND (content ->> 'sequence')::bigint < $3 LIMIT 1",
       std::move(params)});
}

bool all_equal(const PgResult& removed, const PgResult& changed) {
  for (int i = 0; i < removed.rows(); ++i)
    if (removed.text(i, 0) != changed.text(0, 0)) return false;
  return true;
}

// --- packing the revisions of a tile

// Makes a segment of the oldest revisions of a tile.
// Returns nothing if the tile must not change.
Result<std::optional<PackedSegment>> pack_tile(PgConnection& connection, LayerId layer,
                                               ValueType type, TileAddress tile,
                                               std::int64_t through) {
  const auto of_tile = [&] {
    Params params;
    params.id(layer).integer(tile.y).integer(tile.x).integer(through);
    return params;
  };
  auto before = STRATA_TRY(connection.query(
      "SELECT last_sequence, content FROM tile_segments WHERE layer_id = $1 AND tile_y = $2 AND tile_x = $3 "
      "AND first_sequence <= $4 ORDER BY first_sequence DESC LIMIT 1",
      of_tile()));
  auto rows = STRATA_TRY(connection.query(
      "SELECT sequence, difference, key_tile FROM tile_revisions WHERE layer_id = $1 AND tile_y = $2 AND tile_x = $3 "
      "AND sequence <= $4 ORDER BY tile_y, tile_x, sequence LIMIT $5",
      of_tile().integer(JournalMerger::kRevisionsPerSegment)));
  if (rows.rows() < JournalMerger::kRevisionsPerSegment) return std::nullopt;
  TileSegment segment{TileData(type), {}};
  if (before.rows() > 0) {
    const std::int64_t last = before.integer(0, 0);
    if (last >= rows.integer(0, 0)) return std::nullopt;
    segment.before = STRATA_TRY(tile_in_segment(type, before.bytes(0, 1), last));
  }
  TileData now = segment.before;
  for (int i = 0; i < rows.rows(); ++i) {
    auto revision = STRATA_TRY(decode_revision(tile, type, rows.bytes(i, 1)));
    apply(revision, now);
    // A whole tile shows whether the differences before it are complete.
    if (!rows.null(i, 2) && STRATA_TRY(decode_tile(type, rows.bytes(i, 2))) != now)
      return std::nullopt;
    segment.entries.push_back({rows.integer(i, 0), std::move(revision)});
  }
  // The revisions are deleted only if the segment contains the same revisions.
  return pack(tile, type, segment);
}

// Returns a row if an edit has no list of its tiles. Without it, undo would not find the revisions
// of the edit in segments.
void find_unlisted(ModelId model, const std::vector<PackedSegment>& packed, Statements& out) {
  PgArray sequences(oid::kInt8);
  for (const PackedSegment& segment : packed)
    for (const std::int64_t sequence : segment.sequences) sequences.add(sequence);
  Params params;
  params.id(model).array(sequences);
  out.push_back(
      {"SELECT 1 FROM edits WHERE model_id = $1 AND sequence = any($2) AND tiles IS NULL LIMIT 1",
       std::move(params)});
}

void replace_by_segments(LayerId layer, const std::vector<PackedSegment>& packed, Statements& out) {
  PgArray ys(oid::kInt2), xs(oid::kInt2), firsts(oid::kInt8), lasts(oid::kInt8);
  for (const PackedSegment& segment : packed) {
    ys.add_int2(static_cast<std::int16_t>(segment.tile.y));
    xs.add_int2(static_cast<std::int16_t>(segment.tile.x));
    firsts.add(segment.sequences.front());
    lasts.add(segment.sequences.back());
  }
  Params remove;
  remove.id(layer).array(ys).array(xs).array(firsts).array(lasts);
  out.push_back(
      {"DELETE FROM tile_revisions r USING unnest($2::smallint[], $3::smallint[], $4::bigint[], $5::bigint[]) "
       "AS v (y, x, first, last) WHERE r.layer_id = $1 AND r.tile_y = v.y AND r.tile_x = v.x "
       "AND r.sequence >= v.first AND r.sequence <= v.last",
       std::move(remove)});
  insert_segments(layer, packed, out);
}

}  // namespace

Result<bool> JournalMerger::may_merge(std::string_view version,
                                      std::chrono::milliseconds after_mark) {
  return journal_.pool_.write([&](PgConnection& connection) -> Result<bool> {
    const auto older =
        STRATA_TRY(exclude_older_programs(connection, "000047", version, after_mark));
    return older == OlderPrograms::absent;
  });
}

Result<JournalMerger::Done> JournalMerger::merge(ModelId model, std::int64_t epoch,
                                                 std::chrono::system_clock::time_point ended_before,
                                                 const Continue& go_on) {
  const Claim claim{model, epoch};
  const auto window = STRATA_TRY(read_window(model, ended_before));
  const MergePlan plan = plan_merges(window.edits, window.rules);
  Done done;
  if (plan.through == 0) return done;
  for (const auto& group : plan.groups) {
    if (!go_on()) return done;
    std::vector<std::int64_t> sequences;
    for (const std::size_t i : group) sequences.push_back(window.edits[i].sequence);
    const auto replaced =
        STRATA_TRY(merge_group(claim, window.edits[group.front()].layer, sequences));
    if (!replaced) continue;
    done.edits += static_cast<std::int64_t>(group.size()) - 1;
    done.revisions += *replaced;
  }
  const bool are_listed = STRATA_TRY(list_tiles(claim, window, plan.through, go_on));
  if (!are_listed || !go_on()) return done;
  STRATA_TRY(advance(claim, plan.through));
  std::map<LayerId, std::size_t> written;
  for (const PlannedEdit& edit : window.edits)
    if (edit.sequence <= plan.through) written[edit.layer] += edit.tiles.size();
  for (const auto& [layer, revisions] : written) {
    const auto [since, is_first] = since_packed_.try_emplace(layer, 0);
    since->second += revisions;
    if (!is_first && since->second < kRevisionsUntilCount) continue;
    since->second = kRevisionsUntilCount;  // if packing fails, the next merge tries again
    done.revisions += STRATA_TRY(pack_layer(claim, layer, plan.through, go_on));
    since->second = 0;
  }
  done.more = window.rules.is_cut;
  return done;
}

Result<JournalMerger::Window> JournalMerger::read_window(
    ModelId model, std::chrono::system_clock::time_point ended_before) {
  return journal_.pool_.read([&](PgConnection& connection) -> Result<Window> {
    Window window;
    window.rules.ended_before = ended_before;
    auto transaction = STRATA_TRY(Transaction::begin_reading(connection));
    auto from = STRATA_TRY(connection.query(
        "SELECT sequence FROM merged_journals WHERE model_id = $1", Params().id(model)));
    const std::int64_t after = from.rows() > 0 ? from.integer(0, 0) : 0;
    auto named = STRATA_TRY(connection.query(
        "SELECT (content ->> 'sequence')::bigint FROM snapshots WHERE model_id = $1 "
        "AND jsonb_typeof(content -> 'sequence') = 'number' ORDER BY 1",
        Params().id(model)));
    for (int i = 0; i < named.rows(); ++i) window.rules.named_states.push_back(named.integer(i, 0));
    STRATA_TRY(connection.each_row(
        kWindow,
        Params().id(model).integer(after).integer(static_cast<std::int64_t>(edits_at_once_)),
        [&](const PgResult& row) -> Result<void> {
          window.edits.push_back({row.integer(0, 0), row.id<LayerId>(0, 1), row.uuid(0, 2),
                                  row.text(0, 3), row.time(0, 4), row.boolean(0, 5), row.text(0, 6),
                                  read_tile_numbers(row.bytes(0, 7)),
                                  static_cast<std::size_t>(row.integer(0, 8))});
          return {};
        }));
    window.rules.is_cut = window.edits.size() >= edits_at_once_;
    return window;
  });
}

Result<std::optional<std::int64_t>> JournalMerger::merge_group(
    const Claim& claim, LayerId layer, const std::vector<std::int64_t>& sequences) {
  auto lease = STRATA_TRY(journal_.pool_.acquire(kRewriteLimits));
  PgConnection& connection = *lease;
  const PgArray all = array_of(sequences);
  const auto state = STRATA_TRY(state_of(connection, layer));
  if (!state) return std::nullopt;
  const auto batches = STRATA_TRY(read_batches(connection, claim.model, all));
  // Somebody has deleted the layer.
  if (batches.size() != sequences.size()) return std::nullopt;
  const auto merged = join_batches(batches);
  if (!merged) return std::nullopt;
  const auto revisions = join_revisions(connection, layer, state->type, all);
  if (!revisions) {
    STRATA_TRY(skip_if_damaged(
        revisions.error(),
        "the edits up to " + std::to_string(sequences.back()) + " of layer " + to_string(layer)));
    return std::nullopt;
  }
  if (!revisions->can_merge) return std::nullopt;

  Statements statements;
  begin_fenced(claim.model, claim.epoch, layer, *state, statements);
  replace_edits(claim.model, batches, *merged, *revisions, statements);
  insert_batches(claim.model, layer, batches, statements);
  replace_revisions(layer, all, sequences.back(), *revisions, statements);
  find_named_state(claim.model, sequences, statements);
  STRATA_TRY(commit_if(connection, claim.model, claim.epoch, statements, [&](const auto& results) {
    const PgResult& removed = results[kFirstChange];
    const PgResult& changed = results[kFirstChange + 1];
    return removed.rows() == static_cast<int>(batches.size()) - 1 && changed.rows() == 1 &&
           all_equal(removed, changed) && results[kFirstChange + 3].affected() == revisions->rows &&
           results[kFirstChange + 5].rows() == 0;
  }));
  return std::optional(revisions->rows);
}

// Stores the list of tiles of the edits that were not merged. Undo needs the list when their
// revisions are in segments. Locks the model before the edits, as the journal writer does. Returns
// false if it was interrupted and some edits may have no list.
Result<bool> JournalMerger::list_tiles(const Claim& claim, const Window& window,
                                       std::int64_t through, const Continue& go_on) {
  for (std::size_t i = 0; i < window.edits.size() && window.edits[i].sequence <= through;) {
    PgArray sequences(oid::kInt8);
    for (; i < window.edits.size() && window.edits[i].sequence <= through &&
           sequences.size() < kListsAtOnce;
         ++i)
      sequences.add(window.edits[i].sequence);
    if (!go_on()) return false;
    STRATA_TRY(
        journal_.pool_.write_within(kRewriteLimits, [&](PgConnection& connection) -> Result<void> {
          STRATA_TRY(connection.query("SELECT set_config('synchronous_commit', 'off', true)"));
          auto model = connection.query(
              "SELECT 1 FROM all_models WHERE id = $1 AND owner_epoch = $2 FOR SHARE",
              Params().id(claim.model).integer(claim.epoch));
          if (!model) return tl::unexpected(failed_statement(connection, model.error()));
          if (model->rows() == 0) return not_merged(connection, claim.model, claim.epoch);
          auto listed = connection.query(
              "UPDATE edits e SET tiles = ARRAY(SELECT (r.tile_y * 128 + r.tile_x)::smallint FROM tile_revisions r "
              "WHERE r.layer_id = e.layer_id AND r.sequence = e.sequence ORDER BY r.tile_y, r.tile_x) "
              "WHERE e.model_id = $1 AND e.sequence = any($2) AND e.tiles IS NULL",
              Params().id(claim.model).array(sequences));
          if (!listed) return tl::unexpected(failed_statement(connection, listed.error()));
          return {};
        }));
  }
  return true;
}

// Marks the edits up to `through`. They are not read again, and their revisions can be packed.
Result<void> JournalMerger::advance(const Claim& claim, std::int64_t through) {
  return journal_.pool_.write_within(kRewriteLimits, [&](PgConnection& connection) -> Result<void> {
    auto done = connection.query(
        "WITH claim AS (SELECT id FROM all_models WHERE id = $1 AND owner_epoch = $2 FOR SHARE) "
        "INSERT INTO merged_journals (model_id, sequence) SELECT id, $3 FROM claim ON CONFLICT (model_id) "
        "DO UPDATE SET sequence = greatest(merged_journals.sequence, excluded.sequence)",
        Params().id(claim.model).integer(claim.epoch).integer(through));
    if (!done) return tl::unexpected(failed_statement(connection, done.error()));
    return done->affected() == 1 ? Result<void>{}
                                 : not_merged(connection, claim.model, claim.epoch);
  });
}

Result<std::int64_t> JournalMerger::pack_layer(const Claim& claim, LayerId layer,
                                               std::int64_t through, const Continue& go_on) {
  std::int64_t packed = 0;
  for (bool more = true; more;) {
    auto counted = STRATA_TRY(journal_.pool_.read([&](PgConnection& connection) {
      return connection.query(
          "SELECT tile_y, tile_x, count(*) FROM tile_revisions WHERE layer_id = $1 AND sequence <= $2 "
          "GROUP BY tile_y, tile_x HAVING count(*) >= $3 ORDER BY tile_y, tile_x",
          Params().id(layer).integer(through).integer(kRevisionsPerSegment));
    }));
    more = false;
    for (int i = 0; i < counted.rows(); i += kTilesAtOnce) {
      std::vector<TileAddress> tiles;
      bool has_several = false;  // a tile has the revisions of several segments
      for (int n = i; n < std::min(counted.rows(), i + kTilesAtOnce); ++n) {
        if (unpackable_[layer].contains(address_of(counted, n))) continue;
        tiles.push_back(address_of(counted, n));
        has_several = has_several || counted.integer(n, 2) >= 2 * kRevisionsPerSegment;
      }
      if (tiles.empty()) continue;
      if (!go_on()) return packed;
      const auto some = STRATA_TRY(pack_tiles(claim, layer, through, tiles));
      packed += some;
      more = more || (some > 0 && has_several);
    }
  }
  return packed;
}

Result<std::int64_t> JournalMerger::pack_tiles(const Claim& claim, LayerId layer,
                                               std::int64_t through,
                                               const std::vector<TileAddress>& tiles) {
  auto lease = STRATA_TRY(journal_.pool_.acquire(kRewriteLimits));
  PgConnection& connection = *lease;
  const auto state = STRATA_TRY(state_of(connection, layer));
  if (!state) return 0;
  std::vector<PackedSegment> packed;
  for (const TileAddress tile : tiles) {
    auto segment = pack_tile(connection, layer, state->type, tile, through);
    if (segment && *segment) {
      packed.push_back(std::move(**segment));
      continue;
    }
    const std::string what = "the revisions of tile " + std::to_string(tile.x) + ", " +
                             std::to_string(tile.y) + " of layer " + to_string(layer);
    if (segment)
      log::warning("journal: " + what + " were not packed, because they do not follow one another");
    else
      STRATA_TRY(skip_if_damaged(segment.error(), what));
    unpackable_[layer].insert(tile);
  }
  if (packed.empty()) return 0;
  Statements statements;
  begin_fenced(claim.model, claim.epoch, layer, *state, statements);
  replace_by_segments(layer, packed, statements);
  find_unlisted(claim.model, packed, statements);
  const auto revisions = static_cast<std::int64_t>(packed.size()) * kRevisionsPerSegment;
  STRATA_TRY(commit_if(connection, claim.model, claim.epoch, statements, [&](const auto& results) {
    return results[kFirstChange].affected() == revisions && results[kFirstChange + 2].rows() == 0;
  }));
  return revisions;
}

}  // namespace strata::store
