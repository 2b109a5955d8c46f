#include "store/journal/kept_states.h"

#include <algorithm>
#include <functional>
#include <string>

namespace strata::store {
namespace {

tl::unexpected<Error> was_thinned(const KeptStates& kept) {
  return fail(ErrorCode::gone, "State was thinned",
              "An administrator has thinned the history of this model, and this state is no longer "
              "available. The nearest available states have the sequences " +
                  std::to_string(kept.before) + " and " + std::to_string(kept.after) + ".",
              "at");
}

// The state before the checkpoints that contain a state, and the state at their end.
using SpanOf = std::function<Result<std::optional<KeptStates>>(std::int64_t)>;

// Checkpoints overlap, but only within one period: those of several layers, and the two edits of
// one checkpoint.
Result<std::optional<KeptStates>> nearest(const SpanOf& span_of, std::int64_t sequence) {
  auto kept = STRATA_TRY(span_of(sequence));
  if (!kept) return kept;
  for (;;) {
    const auto wider = STRATA_TRY(span_of(kept->before));
    if (!wider) break;
    kept->before = wider->before;
  }
  for (;;) {
    const auto wider = STRATA_TRY(span_of(kept->after));
    if (!wider) break;
    kept->after = wider->after;
  }
  return kept;
}

Result<std::optional<KeptStates>> span_in(const PgResult& row) {
  if (row.rows() == 0 || row.null(0, 0)) return std::nullopt;
  return KeptStates{row.integer(0, 0), row.integer(0, 1)};
}

}  // namespace

Result<std::optional<KeptStates>> kept_around(PgConnection& connection, ModelId model,
                                              std::int64_t sequence) {
  const auto span_of = [&](std::int64_t at) -> Result<std::optional<KeptStates>> {
    return span_in(STRATA_TRY(connection.query(
        "SELECT min(e.first_sequence) - 1, max(e.sequence) FROM layers l CROSS JOIN LATERAL "
        "(SELECT op, first_sequence, sequence FROM edits WHERE layer_id = l.id AND sequence > $2 ORDER BY sequence LIMIT 1) e "
        "WHERE l.model_id = $1 AND e.op = 'checkpoint' AND e.first_sequence <= $2",
        Params().id(model).integer(at))));
  };
  return nearest(span_of, sequence);
}

Result<ThinnedSpans> ThinnedSpans::read(PgConnection& connection, ModelId model) {
  ThinnedSpans spans;
  const auto thinned = STRATA_TRY(connection.query(
      "SELECT EXISTS (SELECT 1 FROM thinned_layers t JOIN all_layers l ON l.id = t.layer_id WHERE l.model_id = $1)",
      Params().id(model)));
  if (!thinned.boolean(0, 0)) return spans;
  // The index by time contains the names, so only rows without a name are read from the table.
  STRATA_TRY(connection.each_row(
      "WITH nameless AS MATERIALIZED (SELECT sequence FROM edits WHERE model_id = $1 AND user_name = '') "
      "SELECT e.first_sequence - 1, e.sequence, e.time FROM nameless n CROSS JOIN LATERAL (SELECT * FROM edits "
      "WHERE model_id = $1 AND sequence = n.sequence LIMIT 1) e JOIN layers l ON l.id = e.layer_id "
      "WHERE e.op = 'checkpoint' ORDER BY 1, 2",
      Params().id(model), [&](const PgResult& row) -> Result<void> {
        const Span span{{row.integer(0, 0), row.integer(0, 1)}, row.time(0, 2)};
        if (spans.spans_.empty() || spans.spans_.back().states.after <= span.states.before) {
          spans.spans_.push_back(span);
        } else if (Span& last = spans.spans_.back(); last.states.after < span.states.after) {
          last.states.after = span.states.after;
          last.ended = span.ended;
        }
        return {};
      }));
  return spans;
}

const ThinnedSpans::Span* ThinnedSpans::around(std::int64_t sequence) const {
  const auto next = std::ranges::upper_bound(spans_, sequence, {},
                                             [](const Span& span) { return span.states.after; });
  return next != spans_.end() && next->states.before < sequence ? &*next : nullptr;
}

Result<void> check_kept(PgConnection& connection, ModelId model, std::int64_t sequence) {
  const auto kept = STRATA_TRY(kept_around(connection, model, sequence));
  return kept ? was_thinned(*kept) : Result<void>{};
}

Result<void> check_kept(PgConnection& connection, LayerId layer, std::int64_t sequence) {
  const auto span_of = [&](std::int64_t at) -> Result<std::optional<KeptStates>> {
    return span_in(STRATA_TRY(connection.query(
        "SELECT first_sequence - 1, sequence FROM (SELECT op, first_sequence, sequence FROM edits "
        "WHERE layer_id = $1 AND sequence > $2 ORDER BY sequence LIMIT 1) e "
        "WHERE op = 'checkpoint' AND first_sequence <= $2",
        Params().id(layer).integer(at))));
  };
  const auto kept = STRATA_TRY(nearest(span_of, sequence));
  return kept ? was_thinned(*kept) : Result<void>{};
}

}  // namespace strata::store
