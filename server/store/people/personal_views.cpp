#include "store/people/personal_views.h"
#include "store/store_impl.h"

namespace strata::store {
namespace {

constexpr std::size_t kMaxBytes = 1 << 20;  // as in the SQL table

}  // namespace

Result<nlohmann::json> PersonalViews::find(const std::string& user, ModelId model_id) {
  return pool_.read([&](PgConnection& connection) -> Result<nlohmann::json> {
    auto rows = STRATA_TRY(connection.query(
        "SELECT v.content FROM personal_views v JOIN users u ON u.id = v.user_id WHERE u.name = $1 AND v.model_id = $2",
        Params().text(user).id(model_id)));
    return rows.rows() == 0 ? nlohmann::json::array() : rows.json(0, 0);
  });
}

Result<void> PersonalViews::keep(const std::string& user, ModelId model_id,
                                 const nlohmann::json& layers) {
  STRATA_TRY(check_json(layers, "layers"));
  // PostgreSQL writes a space after every comma and colon, so its text may be up to twice as long
  // as this one.
  if (layers.dump().size() > kMaxBytes / 2)
    return fail(ErrorCode::too_large, "Settings too large",
                "The personal settings of one model can be at most 512 KiB large. Reset "
                "the settings of some layers.",
                "layers");
  return pool_.write([&](PgConnection& connection) -> Result<void> {
    auto done =
        layers.empty()
            ? connection.query(
                  "DELETE FROM personal_views v USING users u WHERE u.id = v.user_id AND u.name = $1 "
                  "AND v.model_id = $2",
                  Params().text(user).id(model_id))
            : connection.query(
                  "INSERT INTO personal_views (user_id, model_id, content) SELECT id, $2, $3 FROM users "
                  "WHERE name = $1 AND deleted IS NULL ON CONFLICT (user_id, model_id) "
                  "DO UPDATE SET content = excluded.content",
                  Params().text(user).id(model_id).json(layers));
    return done ? Result<void>{} : tl::unexpected(done.error());
  });
}

Result<void> PersonalViews::show_layer_to(const std::string& user, ModelId model_id,
                                          LayerId layer_id) {
  const nlohmann::json shown = nlohmann::json::array({{{"layer", layer_id}, {"visible", true}}});
  return pool_.write([&](PgConnection& connection) -> Result<void> {
    auto done = connection.query(
        "INSERT INTO personal_views (user_id, model_id, content) SELECT id, $2, $3 FROM users "
        "WHERE name = $1 AND deleted IS NULL ON CONFLICT (user_id, model_id) "
        "DO UPDATE SET content = personal_views.content || excluded.content",
        Params().text(user).id(model_id).json(shown));
    return done ? Result<void>{} : tl::unexpected(done.error());
  });
}

}  // namespace strata::store
