#include "store/journal/timeline.h"

#include <algorithm>
#include <map>
#include <vector>

#include "store/journal/journal_reads.h"
#include "store/journal/kept_states.h"
#include "store/pg/pg_row.h"
#include "store/pg/sql.h"
#include "store/store_impl.h"

namespace strata::store {
namespace {

constexpr int kRowsOfStep = 8;  // journal rows that are read for each requested step

PgArray ids_of(const std::vector<LayerId>& layers) {
  PgArray ids(oid::kInt8);
  for (const LayerId id : layers) ids.add(id);
  return ids;
}

// Counts strokes, so that the counts stay the same when the batches of a stroke are merged. Only a
// stroke that lasts for several intervals counts in each of them before, and once after the merge.
// Clients receive times in milliseconds. The state at the time of an edit must include the edit.
// A checkpoint (journal_thinner.h) has no author, but contains the number of strokes of each
// author. The query returns one row for each interval, author and layer. The rows of an interval
// are joined in memory, so the number of intervals limits the result. The first grouping is by
// stroke as well: count(DISTINCT stroke) would sort all edits, which takes twice as long.
constexpr const char* kCells =
    "WITH seen AS MATERIALIZED (SELECT time, sequence, layer_id, user_name, stroke FROM edits WHERE model_id = $1 AND layer_id = any($2) "
    "AND time >= coalesce($3::timestamptz, '-infinity') AND time < coalesce($4::timestamptz, 'infinity') + interval '1 millisecond'), "
    "bounds AS (SELECT coalesce($3::timestamptz, min(time)) AS low, coalesce($4::timestamptz, max(time)) AS high FROM seen), "
    "counted AS (SELECT time, sequence, layer_id, user_name, stroke, 0::bigint AS others FROM seen WHERE user_name <> '' UNION ALL "
    "SELECT s.time, s.sequence, s.layer_id, p ->> 'user', NULL, (p ->> 'edits')::bigint FROM seen s CROSS JOIN LATERAL "
    "(SELECT record FROM edits WHERE model_id = $1 AND sequence = s.sequence AND op = 'checkpoint' LIMIT 1) e "
    "CROSS JOIN LATERAL jsonb_array_elements(e.record -> 'people') p WHERE s.user_name = ''), "
    "strokes AS (SELECT least(CASE WHEN b.high > b.low THEN floor(date_part('epoch', s.time - b.low) / "
    "date_part('epoch', b.high - b.low) * $5)::integer ELSE 0 END, $5 - 1) AS number, s.user_name, s.layer_id, s.stroke, "
    "sum(s.others) AS others, min(s.sequence) AS first, max(s.sequence) AS last, min(s.time) AS begun, max(s.time) AS ended "
    "FROM counted s CROSS JOIN bounds b GROUP BY 1, 2, 3, 4) "
    "SELECT b.low, b.high, number, user_name, layer_id, (count(stroke) + sum(others))::bigint, min(first), max(last), min(begun), "
    "max(ended) FROM strokes CROSS JOIN bounds b GROUP BY 1, 2, 3, 4, 5 ORDER BY 3";

// A checkpoint has an author if all its edits are by one person. Its second edit, which has no
// authors, is not a step.
constexpr auto kStepColumns = sql(
    "SELECT coalesce(first_sequence, sequence), sequence, stroke, layer_id, CASE WHEN op = 'checkpoint' "
    "AND jsonb_array_length(record -> 'people') = 1 THEN record -> 'people' -> 0 ->> 'user' ELSE user_name END, op, time, "
    "(answer ->> 'texels_changed')::bigint, (answer ->> 'area_m2')::double precision FROM edits "
    "WHERE model_id = $1 AND layer_id = any($2) AND NOT (op = 'checkpoint' AND record -> 'people' = '[]') ");
constexpr auto kStepsBefore =
    sql(kStepColumns, "AND sequence <= $3 ORDER BY sequence DESC LIMIT $4");
constexpr auto kStepsAfter = sql(kStepColumns, "AND sequence > $3 ORDER BY sequence LIMIT $4");

template <class Counted>
auto by_count(const Counted& counted) {
  std::vector<std::pair<typename Counted::key_type, std::int64_t>> sorted(counted.begin(),
                                                                          counted.end());
  std::ranges::stable_sort(sorted,
                           [](const auto& a, const auto& b) { return a.second > b.second; });
  return sorted;
}

// The interval whose rows are being joined.
struct Joined {
  Timeline::Interval interval;
  std::map<std::string, std::int64_t> people;
  std::map<LayerId, std::int64_t> layers;

  void end(Timeline& timeline) {
    if (interval.edits == 0) return;
    for (const auto& [user, edits] : by_count(people)) {
      if (interval.people.size() < Timeline::kMaxNamed)
        interval.people.push_back({user, edits});
      else
        ++interval.others;
    }
    for (const auto& [layer, edits] : by_count(layers))
      if (interval.layers.size() < Timeline::kMaxNamed) interval.layers.push_back(layer);
    timeline.edits += interval.edits;
    timeline.intervals.push_back(std::move(interval));
  }
};

}  // namespace

Result<Timeline> Journal::timeline(ModelId model_id, const TimelineQuery& query) {
  return pool_.read([&](PgConnection& connection) -> Result<Timeline> {
    Timeline timeline;
    Joined joined;
    STRATA_TRY(connection.each_row(
        kCells,
        Params()
            .id(model_id)
            .array(ids_of(query.layers))
            .optional_text(query.from)
            .optional_text(query.to)
            .integer(query.intervals),
        [&](const PgResult& row) -> Result<void> {
          PgRow columns(row, 0);
          timeline.from = columns.time();
          timeline.to = columns.time();
          const auto number = static_cast<int>(columns.integer());
          if (number != joined.interval.number || joined.interval.edits == 0) {
            joined.end(timeline);
            joined = {};
            joined.interval.number = number;
          }
          const std::string user = columns.text();
          const LayerId layer(columns.integer());
          const std::int64_t edits = columns.integer();
          const std::int64_t first = columns.integer(), last = columns.integer();
          const auto begun = columns.time(), ended = columns.time();
          Timeline::Interval& interval = joined.interval;
          const bool is_new = interval.edits == 0;
          interval.first = is_new ? first : std::min(interval.first, first);
          interval.last = std::max(interval.last, last);
          interval.begun = is_new ? begun : std::min(interval.begun, begun);
          interval.ended = is_new ? ended : std::max(interval.ended, ended);
          interval.edits += edits;
          joined.people[user] += edits;
          joined.layers[layer] += edits;
          return {};
        }));
    joined.end(timeline);
    // An interval shows no state that is newer than its end.
    const auto thinned = STRATA_TRY(ThinnedSpans::read(connection, model_id));
    for (Timeline::Interval& interval : timeline.intervals)
      if (const auto* span = thinned.around(interval.last)) interval.last = span->states.before;
    return timeline;
  });
}

Result<TimelineSteps> Journal::timeline_steps(ModelId model_id, const std::vector<LayerId>& layers,
                                              std::int64_t from, bool backward, int limit) {
  return pool_.read([&](PgConnection& connection) -> Result<TimelineSteps> {
    const int most = limit * kRowsOfStep;
    auto rows = STRATA_TRY(connection.query(
        backward ? kStepsBefore.c_str() : kStepsAfter.c_str(),
        Params().id(model_id).array(ids_of(layers)).integer(from).integer(most + 1)));
    TimelineSteps found;
    found.more = rows.rows() > most;
    std::map<Uuid, std::size_t> of_stroke;
    for (int i = 0; i < std::min(rows.rows(), most); ++i) {
      PgRow columns(rows, i);
      TimelineStep row;
      row.first = columns.integer();
      row.last = columns.integer();
      row.stroke = columns.uuid();
      row.layer = LayerId(columns.integer());
      row.user = columns.text();
      row.op = columns.text();
      row.time = columns.time();
      row.texels = static_cast<std::uint64_t>(columns.optional_integer().value_or(0));
      row.area_m2 = columns.optional_real().value_or(0);
      const auto [known, is_new] = of_stroke.try_emplace(row.stroke, found.steps.size());
      if (is_new) {
        if (static_cast<int>(found.steps.size()) == limit) {
          found.more = true;
          break;
        }
        found.steps.push_back(std::move(row));
        continue;
      }
      TimelineStep& step = found.steps[known->second];
      if (row.last > step.last) {
        step.last = row.last;
        step.time = row.time;
      }
      step.first = std::min(step.first, row.first);
      step.texels += row.texels;
      step.area_m2 += row.area_m2;
    }
    std::ranges::sort(found.steps, {}, &TimelineStep::last);
    // Within the checkpoint of another layer, the model has no state. A step leads to a state that
    // contains it.
    const auto thinned = STRATA_TRY(ThinnedSpans::read(connection, model_id));
    for (TimelineStep& step : found.steps) {
      const auto* span = thinned.around(step.last);
      if (!span) continue;
      step.last = span->states.after;
      step.time = std::max(step.time, span->ended);
    }
    return found;
  });
}

}  // namespace strata::store
