// What rooms of other nodes read after each change of a model.
#include "store/journal/tail.h"

#include "store/journal/journal_reads.h"
#include "store/pg/pg_row.h"
#include "store/pg/sql.h"
#include "store/store_impl.h"

namespace strata::store {
namespace {

using std::chrono::milliseconds;

// Rooms at this node show an old state while the reader waits.
constexpr PgLimits kStatesLimits{milliseconds(2000), milliseconds(2000), milliseconds(1000)};

// The digest of the last edit of a model, up to a sequence. An edit that is made again, even with
// the same id, has another time. An edit that becomes part of a checkpoint keeps its sequence and
// time, but not its id.
consteval auto last_edit(const auto& model, const auto& sequence) {
  return sql(
      "coalesce((SELECT hashtextextended(concat_ws(' ', e.sequence, extract(epoch FROM e.time)), 0) "
      "FROM edits e WHERE e.model_id = ",
      model, " AND e.sequence <= ", sequence, " ORDER BY e.sequence DESC LIMIT 1), 0)");
}

using States = std::map<ModelId, ModelState>;

Result<States> read_states(PgConnection& connection, std::span<const ModelId> models) {
  PgArray ids(oid::kInt8);
  for (const ModelId id : models) ids.add(id);
  auto rows = STRATA_TRY(connection.query(
      sql("SELECT m.id, m.sequence, ", last_edit("m.id", "m.sequence"),
          ", m.owner_epoch, m.version, "
          "(SELECT hashtextextended(coalesce(string_agg(concat_ws(' ', l.id, l.version, l.computed_sequence), ',' "
          "ORDER BY l.id), ''), 0) FROM layers l WHERE l.model_id = m.id), "
          "(SELECT hashtextextended(coalesce(string_agg(concat_ws(' ', i.id, i.version), ',' ORDER BY i.id), ''), 0) "
          "FROM looks i WHERE i.model_id = m.id) FROM models m WHERE m.id = any($1)"),
      Params().array(ids)));
  States states;
  for (int i = 0; i < rows.rows(); ++i) {
    PgRow row(rows, i);
    const auto id = row.id<ModelId>();
    states[id] = {row.integer(), row.integer(), row.integer(),
                  row.integer(), row.integer(), row.integer()};
  }
  return states;
}

}  // namespace

ModelStates::ModelStates(std::string dsn) : dsn_(std::move(dsn)) {}
ModelStates::~ModelStates() = default;

Result<States> ModelStates::read(std::span<const ModelId> models) {
  if (!connection_ || !connection_->alive()) {
    connection_.reset();
    auto fresh = STRATA_TRY(PgConnection::connect(dsn_, kStatesLimits));
    connection_ = std::make_unique<PgConnection>(std::move(fresh));
  }
  return read_states(*connection_, models);
}

void ModelStates::disconnect() { connection_.reset(); }

std::unique_ptr<ModelStates> Journal::states() {
  return std::make_unique<ModelStates>(pool_.dsn());
}

Result<ModelState> Journal::model_state(ModelId model_id) {
  auto states = STRATA_TRY(pool_.read([&](PgConnection& connection) {
    return read_states(connection, {&model_id, 1});
  }));
  const auto found = states.find(model_id);
  if (found == states.end()) return no_such("model", to_string(model_id));
  return found->second;
}

Result<std::int64_t> Journal::last_edit(ModelId model_id, std::int64_t through) {
  return pool_.read([&](PgConnection& connection) -> Result<std::int64_t> {
    auto row = STRATA_TRY(connection.query(sql("SELECT ", store::last_edit("$1", "$2")),
                                           Params().id(model_id).integer(through)));
    return row.integer(0, 0);
  });
}

Result<std::vector<TailEdit>> Journal::last_edits(ModelId model_id, std::int64_t after,
                                                  std::int64_t through, int limit) {
  return pool_.read([&](PgConnection& connection) -> Result<std::vector<TailEdit>> {
    auto rows = STRATA_TRY(connection.query(
        "SELECT sequence, layer_id, id, stroke, user_name, op, coalesce(review = 'pending', false), "
        "coalesce((answer ->> 'provisional')::boolean, false) "
        "FROM edits WHERE model_id = $1 AND sequence > $2 AND sequence <= $3 ORDER BY sequence DESC LIMIT $4",
        Params().id(model_id).integer(after).integer(through).integer(limit)));
    std::vector<TailEdit> edits;
    for (int i = rows.rows() - 1; i >= 0; --i) {
      PgRow row(rows, i);
      edits.push_back({row.integer(), row.id<LayerId>(), row.uuid(), row.uuid(), row.text(),
                       row.text(), row.boolean(), row.boolean()});
    }
    return edits;
  });
}

}  // namespace strata::store
