#include "store/journal/journal_commit.h"

#include <map>
#include <optional>
#include <set>

#include "store/journal/tile_sums.h"
#include "store/nodes/deposed.h"
#include "store/store_impl.h"

namespace strata::store {
namespace {

constexpr std::size_t kBytesPerInsert = 8u << 20;
constexpr int kTilesASide = 16384 / kTileSize;

// An entry that fails these checks can never be written. The database makes all other checks.
Result<void> check(const JournalEntry& entry) {
  STRATA_TRY(check_texts({{&entry.user, "user"}, {&entry.op, "op"}}));
  STRATA_TRY(check_json(entry.record, "record"));
  STRATA_TRY(check_json(entry.answer, "answer"));
  for (const auto& revision : entry.revisions)
    if (revision.tile.x >= kTilesASide || revision.tile.y >= kTilesASide ||
        revision.difference.empty())
      return fail(ErrorCode::malformed, "Invalid edit",
                  "A tile revision is outside all layers, or it is empty.", "revisions");
  return {};
}

struct Span {
  std::int64_t first, last, epoch;
};

// Returns the range of sequences of each model; they must be consecutive and of one epoch.
Result<std::map<ModelId, Span>> model_spans(std::span<const JournalEntry* const> entries) {
  std::map<ModelId, Span> spans;
  for (const JournalEntry* entry : entries) {
    const auto [span, fresh] =
        spans.try_emplace(entry->model_id, Span{entry->sequence, entry->sequence, entry->epoch});
    if (!fresh && (entry->sequence != ++span->second.last || entry->epoch != span->second.epoch))
      return fail(ErrorCode::conflict, "Journal out of order",
                  "Edit " + std::to_string(entry->sequence) +
                      " must have the next sequence and the epoch of the previous edit.");
  }
  return spans;
}

using Statements = std::deque<PgConnection::Statement>;

void advance_models(const std::map<ModelId, Span>& spans, Statements& out) {
  PgArray ids(oid::kInt8), firsts(oid::kInt8), lasts(oid::kInt8), epochs(oid::kInt8);
  for (const auto& [model, span] : spans) {
    ids.add(model);
    firsts.add(span.first);
    lasts.add(span.last);
    epochs.add(span.epoch);
  }
  Params params;
  params.array(ids).array(firsts).array(lasts).array(epochs);
  out.push_back(
      {"UPDATE models m SET sequence = v.last FROM unnest($1::bigint[], $2::bigint[], $3::bigint[], $4::bigint[]) "
       "AS v (id, first, last, epoch) WHERE m.id = v.id AND m.sequence = v.first - 1 AND m.owner_epoch = v.epoch",
       std::move(params)});
}

std::size_t advance_layers(std::span<const JournalEntry* const> entries, Statements& out) {
  std::map<std::pair<LayerId, ModelId>, std::int64_t> lasts;
  for (const JournalEntry* entry : entries)
    lasts[{entry->layer_id, entry->model_id}] = entry->sequence;
  PgArray ids(oid::kInt8), models(oid::kInt8), sequences(oid::kInt8);
  for (const auto& [key, last] : lasts) {
    ids.add(key.first);
    models.add(key.second);
    sequences.add(last);
  }
  Params params;
  params.array(ids).array(models).array(sequences);
  out.push_back(
      {"UPDATE layers l SET sequence = v.last FROM unnest($1::bigint[], $2::bigint[], $3::bigint[]) "
       "AS v (id, model_id, last) WHERE l.id = v.id AND l.model_id = v.model_id",
       std::move(params)});
  return lasts.size();
}

// A room reads the edits that an undo or a review changes before the undo is committed. In the
// meantime, they may have become part of a checkpoint (journal_thinner.h). Adds a query that
// returns a row in this case. Returns its place, or nothing if no entry changes other edits.
std::optional<std::size_t> find_thinned(std::span<const JournalEntry* const> entries,
                                        Statements& out) {
  PgArray layers(oid::kInt8), sequences(oid::kInt8);
  const auto add = [&](const JournalEntry& entry, const std::vector<std::int64_t>& edits) {
    for (const std::int64_t sequence : edits) {
      layers.add(entry.layer_id);
      sequences.add(sequence);
    }
  };
  for (const JournalEntry* entry : entries) {
    add(*entry, entry->disable);
    add(*entry, entry->enable);
    if (entry->reviewed) add(*entry, entry->reviewed->edits);
  }
  if (sequences.size() == 0) return std::nullopt;
  Params params;
  params.array(layers).array(sequences);
  out.push_back(
      {"SELECT 1 FROM unnest($1::bigint[], $2::bigint[]) AS v (layer_id, sequence) CROSS JOIN LATERAL "
       "(SELECT op, first_sequence FROM edits WHERE layer_id = v.layer_id AND sequence >= v.sequence ORDER BY sequence LIMIT 1) e "
       "WHERE e.op = 'checkpoint' AND e.first_sequence <= v.sequence LIMIT 1",
       std::move(params)});
  return out.size() - 1;
}

void insert_edits(std::span<const JournalEntry* const> entries, Statements& out) {
  PgArray models(oid::kInt8), sequences(oid::kInt8), ids(oid::kUuid), layers(oid::kInt8),
      strokes(oid::kUuid), users(oid::kText), ops(oid::kText), records(oid::kJsonb),
      answers(oid::kJsonb), times(oid::kTimestamptz), reviews(oid::kText);
  for (const JournalEntry* entry : entries) {
    models.add(entry->model_id);
    sequences.add(entry->sequence);
    ids.add(entry->id);
    layers.add(entry->layer_id);
    strokes.add(entry->stroke);
    users.add(std::string_view(entry->user));
    ops.add(std::string_view(entry->op));
    records.add(entry->record);
    answers.add(entry->answer);
    times.add(entry->time);
    if (entry->review == Review::none)
      reviews.add_null();
    else
      reviews.add(name(entry->review));
  }
  Params params;
  params.array(models)
      .array(sequences)
      .array(ids)
      .array(layers)
      .array(strokes)
      .array(users)
      .array(ops)
      .array(records)
      .array(answers)
      .array(times)
      .array(reviews);
  out.push_back(
      {"INSERT INTO edits (model_id, sequence, id, layer_id, stroke, user_name, op, record, answer, time, review) "
       "SELECT * FROM unnest($1::bigint[], $2::bigint[], $3::uuid[], $4::bigint[], $5::uuid[], $6::text[], "
       "$7::text[], $8::jsonb[], $9::jsonb[], $10::timestamptz[], $11::text[])",
       std::move(params)});
}

struct RevisionColumns {
  PgArray layers{oid::kInt8}, ys{oid::kInt2}, xs{oid::kInt2}, sequences{oid::kInt8},
      differences{oid::kBytea}, keys{oid::kBytea};
  std::size_t bytes = 0;

  void add(const JournalEntry& entry, const JournalEntry::Revision& revision) {
    layers.add(entry.layer_id);
    ys.add_int2(static_cast<std::int16_t>(revision.tile.y));
    xs.add_int2(static_cast<std::int16_t>(revision.tile.x));
    sequences.add(entry.sequence);
    differences.add(Bytes(revision.difference));
    if (revision.key_tile.empty())
      keys.add_null();
    else
      keys.add(Bytes(revision.key_tile));
    bytes += revision.difference.size() + revision.key_tile.size();
  }
  void flush(Statements& out) {
    if (layers.size() == 0) return;
    Params params;
    params.array(layers).array(ys).array(xs).array(sequences).array(differences).array(keys);
    out.push_back(
        {"INSERT INTO tile_revisions (layer_id, tile_y, tile_x, sequence, difference, key_tile) "
         "SELECT * FROM unnest($1::bigint[], $2::smallint[], $3::smallint[], $4::bigint[], $5::bytea[], $6::bytea[])",
         std::move(params)});
    *this = RevisionColumns();
  }
};

void insert_revisions(std::span<const JournalEntry* const> entries, Statements& out) {
  RevisionColumns columns;
  for (const JournalEntry* entry : entries)
    for (const auto& revision : entry->revisions) {
      columns.add(*entry, revision);
      if (columns.bytes >= kBytesPerInsert) columns.flush(out);
    }
  columns.flush(out);
}

// Appends the statements that enable and disable edits. They run after the inserts and in the order
// of the entries, because an undo may be in the same transaction as the edit that it undoes.
void switch_edits(std::span<const JournalEntry* const> entries, Statements& out) {
  for (const JournalEntry* entry : entries)
    for (const auto* sequences : {&entry->disable, &entry->enable}) {
      if (sequences->empty()) continue;
      const bool disable = sequences == &entry->disable;
      PgArray list(oid::kInt8);
      for (const std::int64_t sequence : *sequences) list.add(sequence);
      Params params;
      params.id(entry->layer_id).id(entry->model_id).array(list);
      params.optional_integer(disable ? std::optional(entry->sequence) : std::nullopt);
      out.push_back(
          {"UPDATE edits SET in_force = $4::bigint IS NULL, undone_by = $4 "
           "WHERE layer_id = $1 AND model_id = $2 AND sequence = any($3)",
           std::move(params)});
    }
}

void keep_decisions(std::span<const JournalEntry* const> entries, Statements& out) {
  for (const JournalEntry* entry : entries) {
    if (!entry->reviewed) continue;
    PgArray list(oid::kInt8);
    for (const std::int64_t sequence : entry->reviewed->edits) list.add(sequence);
    const Review becomes = entry->reviewed->becomes;
    Params params;
    params.id(entry->layer_id).id(entry->model_id).array(list).text(name(becomes));
    params.optional_integer(becomes == Review::pending ? std::nullopt
                                                       : std::optional(entry->sequence));
    out.push_back(
        {"UPDATE edits SET review = $4, reviewed_by = $5 WHERE layer_id = $1 AND model_id = $2 AND sequence = any($3)",
         std::move(params)});
  }
}

tl::expected<void, CommitFailure> write_entries(PgConnection& connection,
                                                std::span<const JournalEntry* const> entries,
                                                const std::map<ModelId, Span>& spans) {
  const auto never = [](Error problem) {
    return tl::unexpected(CommitFailure{std::move(problem), false});
  };
  const auto failed = [&](const Error& problem) {
    return tl::unexpected(CommitFailure{problem, is_transient(connection.sqlstate())});
  };
  Statements statements;
  statements.push_back({"BEGIN", {}});
  advance_models(spans, statements);
  const std::size_t layer_count = advance_layers(entries, statements);
  const auto thinned = find_thinned(entries, statements);
  insert_edits(entries, statements);
  insert_revisions(entries, statements);
  switch_edits(entries, statements);
  keep_decisions(entries, statements);
  write_tile_sums(entries, statements);

  Transaction transaction = Transaction::adopt(connection);
  const auto results = connection.pipeline(statements);
  if (!results) return failed(results.error());
  if ((*results)[1].affected() != static_cast<std::int64_t>(spans.size()))
    return never({ErrorCode::conflict, "Journal out of order",
                  "The model was deleted, or an earlier edit was not saved. Nothing changed. "
                  "Read the layer again.",
                  ""});
  if ((*results)[2].affected() != static_cast<std::int64_t>(layer_count))
    return never(
        {ErrorCode::conflict, "Layer was deleted",
         "Somebody deleted the layer in the meantime, so the server did not save the edit.", ""});
  if (thinned && (*results)[*thinned].rows() > 0)
    return never(
        {ErrorCode::conflict, "Edits were thinned",
         "An administrator has thinned the history of this model in the meantime, so these "
         "edits can no longer be changed. Nothing changed.",
         ""});
  if (auto committed = transaction.commit(); !committed) return failed(committed.error());
  return {};
}

}  // namespace

tl::expected<void, CommitFailure> commit_entries(PgConnection& connection,
                                                 std::span<const JournalEntry* const> entries) {
  for (const JournalEntry* entry : entries)
    if (auto good = check(*entry); !good) return tl::unexpected(CommitFailure{good.error(), false});
  const auto spans = model_spans(entries);
  if (!spans) return tl::unexpected(CommitFailure{spans.error(), false});
  auto written = write_entries(connection, entries, *spans);
  if (written || written.error().transient) return written;
  // Another node may have claimed the model and written the same sequences. Any permanent failure
  // can have this cause.
  for (const auto& [model, span] : *spans) {
    auto deposed = deposed_problem(connection, model, span.epoch);
    if (!deposed) return tl::unexpected(CommitFailure{deposed.error(), true});
    if (*deposed) return tl::unexpected(CommitFailure{std::move(**deposed), false});
  }
  return written;
}

Result<std::vector<bool>> find_saved(PgConnection& connection,
                                     std::span<const JournalEntry* const> entries) {
  PgArray models(oid::kInt8), sequences(oid::kInt8), ids(oid::kUuid);
  for (const JournalEntry* entry : entries) {
    models.add(entry->model_id);
    sequences.add(entry->sequence);
    ids.add(entry->id);
  }
  auto rows = STRATA_TRY(connection.query(
      "SELECT v.n FROM unnest($1::bigint[], $2::bigint[], $3::uuid[]) WITH ORDINALITY AS v (model_id, sequence, id, n) "
      "WHERE EXISTS (SELECT 1 FROM edits e WHERE e.model_id = v.model_id AND e.sequence = v.sequence AND e.id = v.id) "
      "OR EXISTS (SELECT 1 FROM edit_batches b WHERE b.model_id = v.model_id AND b.id = v.id AND b.sequence = v.sequence)",
      Params().array(models).array(sequences).array(ids)));
  if (rows.rows() > 0) STRATA_TRY(connection.confirm_visible());
  std::vector<bool> saved(entries.size());
  for (int i = 0; i < rows.rows(); ++i)
    saved[static_cast<std::size_t>(rows.integer(i, 0)) - 1] = true;
  return saved;
}

}  // namespace strata::store
