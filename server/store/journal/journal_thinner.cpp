#include "store/journal/journal_thinner.h"

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <utility>

#include "core/log.h"
#include "core/no_such.h"
#include "core/text/timestamp.h"
#include "store/cluster/schema_readers.h"
#include "store/journal/checkpoint_group.h"
#include "store/journal/journal_reads.h"
#include "store/pg/pg_row.h"
#include "store/pg/pool.h"

namespace strata::store {
namespace {

// A stroke that continues after the old part of the journal has an edit among this many sequences.
constexpr int kSequencesOfStroke = 20'000;
constexpr int kCheckpointsAtOnce = 100;  // whose responses are deleted together

constexpr auto kWindow = sql(
    "SELECT e.sequence, e.layer_id, e.stroke, e.time, ", kStays,
    " OR e.stroke IN (SELECT stroke FROM edits WHERE model_id = $1 AND sequence > $3 AND sequence <= $3 + $5), "
    "e.writer AND e.in_force, coalesce(cardinality(e.tiles), (SELECT count(*) FROM tile_revisions r "
    "WHERE r.layer_id = e.layer_id AND r.sequence = e.sequence)), "
    "CASE WHEN e.first_sequence IS NULL THEN 0 ELSE (SELECT count(*) FROM edit_batches b "
    "WHERE b.layer_id = e.layer_id AND b.edit = e.sequence) END "
    "FROM edits e JOIN layers l ON l.id = e.layer_id "
    "WHERE e.model_id = $1 AND e.sequence > $2 AND e.sequence <= $3 ORDER BY e.sequence LIMIT $4");

// --- the transaction

struct Group {
  ModelId model = 0;
  LayerId layer = 0;
  LayerState state;
  std::vector<GroupEdit> edits;
  JoinedGroup joined;
};

// Locks the rows in the order of the journal writer.
void lock_layer(const Group& group, Statements& out) {
  Params of_model, of_layer;
  of_model.id(group.model);
  out.push_back(
      {"SELECT 1 FROM all_models WHERE id = $1 AND binned IS NULL FOR SHARE", std::move(of_model)});
  of_layer.id(group.layer).id(group.model).text(name(group.state.type));
  out.push_back(
      {"SELECT 1 FROM all_layers WHERE id = $1 AND model_id = $2 AND type = $3 AND binned IS NULL AND NOT erasing "
       "FOR NO KEY UPDATE",
       std::move(of_layer)});
  find_state(group.layer, group.state, out);
}

// The edits, if they have not changed since they were read.
void lock_edits(const Group& group, Statements& out) {
  static constexpr auto kLock = sql(
      "SELECT 1 FROM edits e JOIN unnest($2::bigint[], $3::text[]) AS v (sequence, state) ON v.sequence = e.sequence "
      "WHERE e.model_id = $1 AND ",
      kState, " = v.state FOR UPDATE OF e");
  PgArray sequences(oid::kInt8), states(oid::kText);
  for (const GroupEdit& edit : group.edits) {
    sequences.add(edit.sequence);
    states.add(std::string_view(edit.state));
  }
  Params params;
  params.id(group.model).array(sequences).array(states);
  out.push_back({kLock.c_str(), std::move(params)});
}

// Returns a row if people have named a state that the checkpoint would remove. A new snapshot locks
// the model, so none can follow while the transaction has its lock.
void find_named_state(const Group& group, Statements& out) {
  Params params;
  params.id(group.model).integer(group.edits.front().sequence).integer(group.edits.back().sequence);
  out.push_back(
      {"SELECT 1 FROM snapshots WHERE model_id = $1 AND jsonb_typeof(content -> 'sequence') = 'number' "
       "AND (content ->> 'sequence')::bigint >= $2 AND (content ->> 'sequence')::bigint < $3 LIMIT 1",
       std::move(params)});
}

void count_thinning(const Group& group, Statements& out) {
  Params params;
  params.id(group.layer);
  out.push_back(
      {"INSERT INTO thinned_layers (layer_id, count) VALUES ($1, 1) "
       "ON CONFLICT (layer_id) DO UPDATE SET count = thinned_layers.count + 1",
       std::move(params)});
}

// Returns a number of a stored response, or 0 if it has another type.
template <class Number>
Number number_in(const nlohmann::json& answer, const char* member) {
  const auto found = answer.find(member);
  return found != answer.end() && found->is_number() ? found->get<Number>() : Number{};
}

// Returns how many strokes and other edits each author made, with the sums of the responses.
nlohmann::json record_of(const std::vector<GroupEdit>& edits) {
  struct Share {
    std::set<Uuid> strokes;
    std::int64_t earlier = 0, texels = 0;
    double area_m2 = 0;
  };
  std::map<std::string, Share> shares;
  for (const GroupEdit& edit : edits) {
    if (edit.op != "checkpoint") {
      Share& share = shares[edit.user];
      share.strokes.insert(edit.stroke);
      share.texels += number_in<std::int64_t>(edit.answer, "texels_changed");
      share.area_m2 += number_in<double>(edit.answer, "area_m2");
      continue;
    }
    for (const nlohmann::json& person : edit.record.value("people", nlohmann::json::array())) {
      Share& share = shares[person.value("user", std::string())];
      share.earlier += person.value("edits", std::int64_t{0});
      share.texels += person.value("texels_changed", std::int64_t{0});
      share.area_m2 += person.value("area_m2", 0.0);
    }
  }
  nlohmann::json people = nlohmann::json::array();
  for (const auto& [user, share] : shares)
    people.push_back({{"user", user},
                      {"edits", share.earlier + std::ssize(share.strokes)},
                      {"texels_changed", share.texels},
                      {"area_m2", share.area_m2}});
  return {{"op", "checkpoint"}, {"people", std::move(people)}};
}

void replace_edits(const Group& group, Statements& out) {
  const NewEdits at = new_edits(group.edits);
  PgArray removed(oid::kInt8), tiles(oid::kInt2);
  for (const GroupEdit& edit : group.edits)
    if (edit.sequence != at.written_at && edit.sequence != at.rest_at) removed.add(edit.sequence);
  for (const std::int16_t tile : group.joined.tiles) tiles.add_int2(tile);
  Params remove;
  remove.id(group.model).array(removed);
  out.push_back(
      {"DELETE FROM edits WHERE model_id = $1 AND sequence = any($2)", std::move(remove)});

  const GroupEdit& first = group.edits.front();
  std::int64_t begins = first.op == "checkpoint" ? first.first_sequence : first.sequence;
  nlohmann::json record = record_of(group.edits);
  std::int64_t texels = 0;
  double area_m2 = 0;
  for (const nlohmann::json& person : record.at("people")) {
    texels += person.at("texels_changed").get<std::int64_t>();
    area_m2 += person.at("area_m2").get<double>();
  }
  nlohmann::json answer{{"texels_changed", texels}, {"area_m2", area_m2}};
  for (const auto& sequence : {at.written_at, at.rest_at}) {
    if (!sequence) continue;
    answer["sequence"] = *sequence;
    Params change;
    change.id(group.model)
        .integer(*sequence)
        .uuid(random_uuid())
        .json(record)
        .json(answer)
        .boolean(sequence == at.written_at)
        .integer(begins)
        .time(first.first_time)
        .array(tiles);
    out.push_back(
        {"UPDATE edits SET id = $3, stroke = $3, user_name = '', op = 'checkpoint', record = $4, answer = $5, in_force = $6, "
         "undone_by = CASE WHEN $6 THEN NULL ELSE sequence END, review = NULL, reviewed_by = NULL, first_sequence = $7, "
         "first_time = $8, tiles = $9 WHERE model_id = $1 AND sequence = $2",
         std::move(change)});
    // The second edit of a checkpoint only has the changes that are no longer in force.
    begins = *sequence;
    record["people"] = nlohmann::json::array();
    answer = {{"texels_changed", 0}, {"area_m2", 0.0}};
  }
}

// Keeps the ids and the responses of the edits as long as clients may send them again.
void keep_answers(const Group& group, Statements& out) {
  PgArray all(oid::kInt8), users(oid::kText), provisional(oid::kInt8), ids(oid::kUuid),
      areas(oid::kFloat8), texels(oid::kInt8);
  for (const GroupEdit& edit : group.edits) {
    all.add(edit.sequence);
    users.add(std::string_view(edit.user));
    const auto waited = edit.answer.find("provisional");
    provisional.add(
        std::int64_t{waited != edit.answer.end() && waited->is_boolean() && waited->get<bool>()});
    ids.add(edit.id);
    areas.add(number_in<double>(edit.answer, "area_m2"));
    texels.add(number_in<std::int64_t>(edit.answer, "texels_changed"));
  }
  const std::int64_t last = group.edits.back().sequence;
  if (group.edits.back().time < std::chrono::system_clock::now() - JournalThinner::kAnswersFor) {
    Params remove;
    remove.id(group.layer).array(all);
    out.push_back(
        {"DELETE FROM edit_batches WHERE layer_id = $1 AND edit = any($2)", std::move(remove)});
    return;
  }
  Params change, insert;
  change.id(group.layer).integer(last).array(all).array(users).array(provisional);
  out.push_back(
      {"UPDATE edit_batches b SET edit = $2, user_name = coalesce(b.user_name, v.user_name), "
       "provisional = coalesce(b.provisional, v.provisional = 1) "
       "FROM unnest($3::bigint[], $4::text[], $5::bigint[]) AS v (sequence, user_name, provisional) "
       "WHERE b.layer_id = $1 AND b.edit = v.sequence",
       std::move(change)});
  // The ids of merged edits and checkpoints are in the table already.
  PgArray is_new(oid::kInt8);
  for (const GroupEdit& edit : group.edits) is_new.add(std::int64_t{edit.first_sequence == 0});
  insert.id(group.model).id(group.layer).integer(last).array(all).array(users).array(provisional);
  insert.array(ids).array(areas).array(texels).array(is_new);
  out.push_back(
      {"INSERT INTO edit_batches (model_id, layer_id, edit, id, sequence, area_m2, texels_changed, user_name, provisional) "
       "SELECT $1, $2, $3, v.id, v.sequence, v.area, v.texels, v.user_name, v.provisional = 1 FROM unnest($4::bigint[], "
       "$5::text[], $6::bigint[], $7::uuid[], $8::float8[], $9::bigint[], $10::bigint[]) "
       "AS v (sequence, user_name, provisional, id, area, texels, is_new) WHERE v.is_new = 1",
       std::move(insert)});
}

struct Places {
  std::size_t rows = 0, segments = 0;  // of the results of the deletions
};

Places replace_revisions(const Group& group, const PgArray& sequences, Statements& out) {
  const NewRevisions& revisions = group.joined.revisions;
  Places places;
  Params remove, insert, remove_segments;
  remove.id(group.layer).array(sequences);
  places.rows = out.size();
  out.push_back(
      {"DELETE FROM tile_revisions WHERE layer_id = $1 AND sequence = any($2)", std::move(remove)});
  PgArray ys(oid::kInt2), xs(oid::kInt2), at(oid::kInt8), differences(oid::kBytea),
      keys(oid::kBytea);
  for (const NewRevisions::Row& row : revisions.rows) {
    ys.add_int2(static_cast<std::int16_t>(row.tile.y));
    xs.add_int2(static_cast<std::int16_t>(row.tile.x));
    at.add(row.sequence);
    differences.add(Bytes(row.difference));
    if (row.key.empty())
      keys.add_null();
    else
      keys.add(Bytes(row.key));
  }
  insert.id(group.layer).array(ys).array(xs).array(at).array(differences).array(keys);
  out.push_back(
      {"INSERT INTO tile_revisions (layer_id, tile_y, tile_x, sequence, difference, key_tile) "
       "SELECT $1, r.* FROM unnest($2::smallint[], $3::smallint[], $4::bigint[], $5::bytea[], $6::bytea[]) AS r",
       std::move(insert)});
  PgArray old_ys(oid::kInt2), old_xs(oid::kInt2), firsts(oid::kInt8);
  for (const auto& [tile, first] : revisions.old_segments) {
    old_ys.add_int2(static_cast<std::int16_t>(tile.y));
    old_xs.add_int2(static_cast<std::int16_t>(tile.x));
    firsts.add(first);
  }
  remove_segments.id(group.layer).array(old_ys).array(old_xs).array(firsts);
  places.segments = out.size();
  out.push_back(
      {"DELETE FROM tile_segments s USING unnest($2::smallint[], $3::smallint[], $4::bigint[]) AS v (y, x, first) "
       "WHERE s.layer_id = $1 AND s.tile_y = v.y AND s.tile_x = v.x AND s.first_sequence = v.first",
       std::move(remove_segments)});
  insert_segments(group.layer, revisions.segments, out);
  return places;
}

tl::unexpected<Error> was_changed() {
  return fail(ErrorCode::conflict, "Journal has changed",
              "The edits changed while they were thinned. Try again later.");
}

Result<void> replace(PgConnection& connection, const Group& group, const PgArray& sequences) {
  Statements statements;
  begin_rewrite(statements);
  // The large statements come first, because people cannot paint while the model is locked. The
  // writer never locks these rows. If another rewrite does, the limit of the wait ends one of the
  // two.
  const Places places = replace_revisions(group, sequences, statements);
  keep_answers(group, statements);
  const std::size_t locks = statements.size();
  lock_layer(group, statements);
  const std::size_t edits = statements.size();
  lock_edits(group, statements);
  find_named_state(group, statements);
  count_thinning(group, statements);
  replace_edits(group, statements);

  Transaction transaction = Transaction::adopt(connection);
  const auto results = connection.pipeline(statements);
  if (!results) return tl::unexpected(failed_statement(connection, results.error()));
  bool are_locked = true;
  for (std::size_t i = locks; i < edits; ++i) are_locked = are_locked && (*results)[i].rows() == 1;
  if (are_locked && (*results)[edits].rows() == std::ssize(group.edits) &&
      (*results)[edits + 1].rows() == 0 &&
      (*results)[places.rows].affected() == group.joined.old_rows &&
      (*results)[places.segments].affected() == std::ssize(group.joined.revisions.old_segments))
    return transaction.commit();
  return was_changed();
}

// Returns whether the error only concerns one group, so the others can be thinned.
bool is_of_group(const Error& problem) {
  switch (problem.code) {
    case ErrorCode::conflict:
    case ErrorCode::malformed:
    case ErrorCode::internal:
    case ErrorCode::busy: return true;
    default: return false;
  }
}

struct ModelRow {
  ModelId id = 0;
  std::string name;
};
Result<std::vector<ModelRow>> find_models(Pool& pool, const std::string& ref) {
  STRATA_TRY(check_text(ref, "model"));
  auto rows = STRATA_TRY(pool.read([&](PgConnection& connection) {
    return connection.query(
        "SELECT id, name FROM models WHERE $1 = '' OR slug = $1 OR id::text = $1 ORDER BY id",
        Params().text(ref));
  }));
  if (!ref.empty() && rows.rows() == 0) return no_such("model", ref);
  std::vector<ModelRow> models;
  for (int i = 0; i < rows.rows(); ++i) models.push_back({rows.id<ModelId>(i, 0), rows.text(i, 1)});
  return models;
}

}  // namespace

Result<bool> JournalThinner::may_thin(std::string_view version,
                                      std::chrono::milliseconds after_mark) {
  const auto older =
      STRATA_TRY(journal_.pool_.write([&](PgConnection& connection) -> Result<OlderPrograms> {
        return exclude_older_programs(connection, "000050", version, after_mark);
      }));
  if (older == OlderPrograms::running)
    return fail(ErrorCode::conflict, "Other version in use",
                "A node of this site has another version, or had one in the last hour, and cannot "
                "read thinned journals. Update all nodes first.");
  return older == OlderPrograms::absent;
}

// If one of the two clocks is ahead, the other one still protects young edits.
Result<void> JournalThinner::check_limit(const Options& options) {
  auto clock = STRATA_TRY(journal_.pool_.read(
      [](PgConnection& connection) { return connection.query("SELECT clock_timestamp()"); }));
  const Time now = std::min(std::chrono::system_clock::now(), clock.time(0, 0));
  if (options.before <= now - kMinAge) return {};
  return fail(ErrorCode::invalid, "Edits are too young",
              "Edits of the last " + std::to_string(kMinAge.count()) +
                  " days cannot be thinned. Also check the clocks of this machine and of the "
                  "database.");
}

// Returns the last sequence up to which all edits are older than the time.
Result<std::int64_t> JournalThinner::last_before(ModelId model, Time before) {
  return journal_.pool_.read_within(
      kBulkLimits, [&](PgConnection& connection) -> Result<std::int64_t> {
        // OFFSET 0 makes the planner use the index by time. By sequence, it would read all older
        // edits.
        auto row = STRATA_TRY(connection.query(
            "SELECT coalesce((SELECT min(sequence) - 1 FROM (SELECT sequence FROM edits WHERE model_id = $1 AND time >= $2 "
            "OFFSET 0) e), (SELECT max(sequence) FROM edits WHERE model_id = $1), 0)",
            Params().id(model).time(before)));
        return row.integer(0, 0);
      });
}

Result<JournalThinner::Window> JournalThinner::read_window(ModelId model, std::int64_t after,
                                                           std::int64_t through,
                                                           const Options& options) {
  return journal_.pool_.read_within(kBulkLimits, [&](PgConnection& connection) -> Result<Window> {
    Window window;
    window.rules.keep = options.keep;
    auto transaction = STRATA_TRY(Transaction::begin_reading(connection));
    auto named = STRATA_TRY(connection.query(
        "SELECT (content ->> 'sequence')::bigint FROM snapshots WHERE model_id = $1 "
        "AND jsonb_typeof(content -> 'sequence') = 'number' ORDER BY 1",
        Params().id(model)));
    for (int i = 0; i < named.rows(); ++i) window.rules.named_states.push_back(named.integer(i, 0));
    STRATA_TRY(connection.each_row(kWindow.c_str(),
                                   Params()
                                       .id(model)
                                       .integer(after)
                                       .integer(through)
                                       .integer(static_cast<std::int64_t>(edits_at_once_))
                                       .integer(kSequencesOfStroke),
                                   [&](const PgResult& result) -> Result<void> {
                                     PgRow row(result, 0);
                                     OldEdit edit;
                                     edit.sequence = row.integer();
                                     edit.layer = row.id<LayerId>();
                                     edit.stroke = row.uuid();
                                     edit.time = row.time();
                                     edit.stays = row.boolean();
                                     edit.is_effective = row.boolean();
                                     edit.revisions = static_cast<std::size_t>(row.integer());
                                     edit.answers = static_cast<std::size_t>(row.integer());
                                     window.edits.push_back(edit);
                                     return {};
                                   }));
    window.is_cut = window.edits.size() >= edits_at_once_;
    if (window.is_cut) window.edits.resize(place_between_strokes(window.edits));
    return window;
  });
}

Result<std::vector<JournalThinner::ModelPlan>> JournalThinner::plan(const Options& options,
                                                                    const std::string& ref) {
  STRATA_TRY(check_limit(options));
  std::vector<ModelPlan> plans;
  for (ModelRow& model : STRATA_TRY(find_models(journal_.pool_, ref))) {
    ModelPlan plan{model.id, std::move(model.name)};
    const auto through = STRATA_TRY(last_before(plan.model, options.before));
    std::int64_t removed_revisions = 0;
    for (std::int64_t after = 0;;) {
      const auto window = STRATA_TRY(read_window(plan.model, after, through, options));
      const auto part = plan_thinning(window.edits, window.rules);
      plan.edits += std::ssize(window.edits);
      plan.removed += part.removed;
      removed_revisions += part.removed_revisions;
      if (!window.is_cut) break;
      after = window.edits.back().sequence;
    }
    if (plan.removed == 0) continue;
    plan.bytes = STRATA_TRY(journal_.revision_bytes(plan.model));
    const auto revisions = STRATA_TRY(journal_.pool_.read_within(kBulkLimits, [&](PgConnection&
                                                                                      connection) {
      return connection.query(
          "SELECT coalesce(sum(greatest(coalesce(cardinality(tiles), 1), 1)), 0)::bigint FROM edits WHERE model_id = $1",
          Params().id(plan.model));
    }));
    const double share = std::min(
        1.0, static_cast<double>(removed_revisions) / static_cast<double>(revisions.integer(0, 0)));
    plan.removed_bytes = static_cast<std::uint64_t>(share * static_cast<double>(plan.bytes));
    plans.push_back(std::move(plan));
  }
  return plans;
}

Result<void> JournalThinner::note(const Options& options, const ModelPlan& plan) {
  const nlohmann::json details{
      {"before", utc_text(options.before)}, {"keep", name(options.keep)}, {"edits", plan.removed}};
  return journal_.pool_.write([&](PgConnection& connection) -> Result<void> {
    STRATA_TRY(connection.query(
        "SELECT audit('erased', 'history', $1, $2, (SELECT project_id FROM models WHERE id = $1), $3)",
        Params().id(plan.model).text(plan.name).json(details)));
    return {};
  });
}

Result<JournalThinner::Done> JournalThinner::thin(ModelId model, const Options& options,
                                                  const Continue& go_on) {
  STRATA_TRY(check_limit(options));
  Done done;
  const auto through = STRATA_TRY(last_before(model, options.before));
  std::size_t max_revisions = ThinRules{}.max_revisions;
  for (bool again = true; again;) {
    bool is_cut = false, is_too_large = false;
    const std::int64_t removed_before = done.removed;
    done.skipped = 0;
    for (std::int64_t after = 0;;) {
      auto window = STRATA_TRY(read_window(model, after, through, options));
      window.rules.max_revisions = max_revisions;
      const auto plan = plan_thinning(window.edits, window.rules);
      for (const auto& group : plan.groups) {
        if (!go_on()) return done;
        std::vector<std::int64_t> sequences;
        for (const std::size_t i : group) sequences.push_back(window.edits[i].sequence);
        const LayerId layer = window.edits[group.front()].layer;
        const auto thinned = thin_group(model, layer, through, sequences);
        if (thinned) {
          done.removed += *thinned;
        } else if (thinned.error().code == ErrorCode::too_large) {
          is_too_large = true;
        } else if (is_of_group(thinned.error())) {
          ++done.skipped;
          log::warning("journal: the edits from " + std::to_string(sequences.front()) + " to " +
                       std::to_string(sequences.back()) + " of layer " + to_string(layer) +
                       " stay as they are: " + thinned.error().detail);
        } else {
          return tl::unexpected(thinned.error());
        }
      }
      is_cut = is_cut || window.is_cut || plan.is_cut;
      if (!window.is_cut) break;
      after = window.edits.back().sequence;
    }
    again = is_cut && done.removed > removed_before;
    // The next pass makes smaller groups. Edits that are too large in pairs stay.
    if (is_too_large && max_revisions > 1) {
      max_revisions /= 2;
      again = true;
    }
  }
  return done;
}

Result<std::int64_t> JournalThinner::thin_group(ModelId model, LayerId layer, std::int64_t through,
                                                const std::vector<std::int64_t>& sequences) {
  auto lease = STRATA_TRY(journal_.pool_.acquire(kRewriteLimits));
  PgConnection& connection = *lease;
  const PgArray all = array_of(sequences);
  Group group{model, layer, {}, {}, {}};
  {
    auto transaction = STRATA_TRY(Transaction::begin_reading(connection));
    const auto state = STRATA_TRY(state_of(connection, layer));
    if (!state) return was_changed();
    group.state = *state;
    auto edits = STRATA_TRY(read_edits(connection, model, through, all));
    if (!edits) return was_changed();
    group.edits = std::move(*edits);
    group.joined = STRATA_TRY(join_group(connection, layer, state->type, group.edits, all));
  }
  STRATA_TRY(replace(connection, group, all));
  const NewEdits made = new_edits(group.edits);
  return std::ssize(sequences) - (made.written_at && made.rest_at ? 2 : 1);
}

Result<void> JournalThinner::forget_answers(const std::string& ref, const Continue& go_on) {
  for (const ModelRow& model : STRATA_TRY(find_models(journal_.pool_, ref))) {
    for (std::int64_t after = 0;;) {
      const auto old = STRATA_TRY(journal_.pool_.read_within(kBulkLimits, [&](PgConnection&
                                                                                  connection) {
        return connection.query(
            "SELECT e.layer_id, e.sequence FROM edits e WHERE e.model_id = $1 AND e.sequence > $2 AND e.op = 'checkpoint' "
            "AND e.time < clock_timestamp() - $3 * interval '1 day' "
            "AND EXISTS (SELECT 1 FROM edit_batches b WHERE b.layer_id = e.layer_id AND b.edit = e.sequence) "
            "ORDER BY e.sequence LIMIT $4",
            Params()
                .id(model.id)
                .integer(after)
                .integer(kAnswersFor.count())
                .integer(kCheckpointsAtOnce));
      }));
      for (int i = 0; i < old.rows(); ++i) {
        if (!go_on()) return {};
        STRATA_TRY(journal_.pool_.write([&](PgConnection& connection) {
          return connection.query("DELETE FROM edit_batches WHERE layer_id = $1 AND edit = $2",
                                  Params().integer(old.integer(i, 0)).integer(old.integer(i, 1)));
        }));
        after = old.integer(i, 1);
      }
      if (old.rows() < kCheckpointsAtOnce) break;
    }
  }
  return {};
}

}  // namespace strata::store
