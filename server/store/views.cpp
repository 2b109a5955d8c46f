#include "store/views.h"

#include "store/store_impl.h"

namespace strata::store {
namespace {

#define STRATA_VIEW_COLUMNS "id, model_id, slug, name, text, content, user_name, time, version"

NamedView read_view(const PgResult& rows, int i) {
  return {rows.integer(i, 0), rows.integer(i, 1), rows.text(i, 2), rows.text(i, 3),   rows.text(i, 4),
          rows.json(i, 5),    rows.text(i, 6),    rows.time(i, 7), rows.integer(i, 8)};
}

Result<void> check_view(const NamedView& view) {
  if (auto good = check_name(view.name); !good) return good;
  return check_texts({{&view.text, "text"}, {&view.user, "user"}});
}

// Where nothing was changed or deleted: because it is not there, or is of another version.
tl::unexpected<Problem> missed(PgConnection& connection, const NamedView& view) {
  auto known = connection.query("SELECT 1 FROM views WHERE id = $1", Params().integer(view.id));
  if (!known) return tl::unexpected(known.error());
  if (known->rows() == 0) return not_found("view", view.slug);
  return stale("view");
}

}  // namespace

Result<Views::Page> Views::of_model(std::int64_t model_id, int limit, int offset) {
  return pool_.read([&](PgConnection& connection) -> Result<Page> {
    auto total = connection.query("SELECT count(*) FROM views WHERE model_id = $1", Params().integer(model_id));
    if (!total) return tl::unexpected(total.error());
    auto rows =
        connection.query("SELECT " STRATA_VIEW_COLUMNS " FROM views WHERE model_id = $1 ORDER BY id LIMIT $2 OFFSET $3",
                         Params().integer(model_id).integer(limit).integer(offset));
    if (!rows) return tl::unexpected(rows.error());
    Page page;
    page.total = total->integer(0, 0);
    for (int i = 0; i < rows->rows(); ++i) page.views.push_back(read_view(*rows, i));
    return page;
  });
}

Result<NamedView> Views::view(std::int64_t model_id, const std::string& ref) {
  if (!check_text(ref, "view")) return not_found("view", ref);
  return pool_.read([&](PgConnection& connection) -> Result<NamedView> {
    const auto id = id_of(ref);
    auto rows = id ? connection.query("SELECT " STRATA_VIEW_COLUMNS " FROM views WHERE model_id = $1 AND id = $2",
                                      Params().integer(model_id).integer(*id))
                   : connection.query("SELECT " STRATA_VIEW_COLUMNS " FROM views WHERE model_id = $1 AND slug = $2",
                                      Params().integer(model_id).text(ref));
    if (!rows) return tl::unexpected(rows.error());
    if (rows->rows() == 0) return not_found("view", ref);
    return read_view(*rows, 0);
  });
}

Result<NamedView> Views::create(const NamedView& view, const FirstAnswer<NamedView>& answer) {
  if (auto good = check_view(view); !good) return tl::unexpected(good.error());
  return change(pool_, answer, [&](PgConnection& connection) -> Result<NamedView> {
    // Locked, so that of two at once the later one counts the earlier.
    auto model =
        connection.query("SELECT 1 FROM models WHERE id = $1 FOR NO KEY UPDATE", Params().integer(view.model_id));
    if (!model) return tl::unexpected(model.error());
    if (model->rows() == 0) return not_found("model", std::to_string(view.model_id));
    auto count = connection.query("SELECT count(*) FROM views WHERE model_id = $1", Params().integer(view.model_id));
    if (!count) return tl::unexpected(count.error());
    if (count->integer(0, 0) >= kMostViews)
      return fail(409, "Too many views",
                  "A model has at most " + std::to_string(kMostViews) + " views. Delete some first.");
    auto row = insert_with_slug(
        connection, "SELECT slug FROM views WHERE slug LIKE $1 AND model_id = $2", view.model_id, view.name,
        [&](const std::string& slug) {
          return connection.query(
              "INSERT INTO views (model_id, slug, name, text, content, user_name) VALUES ($1, $2, $3, $4, $5, $6) "
              "ON CONFLICT (model_id, slug) DO NOTHING RETURNING " STRATA_VIEW_COLUMNS,
              Params()
                  .integer(view.model_id)
                  .text(slug)
                  .text(view.name)
                  .text(view.text)
                  .json(view.content)
                  .text(view.user));
        });
    if (!row) return tl::unexpected(row.error());
    return read_view(*row, 0);
  });
}

Result<NamedView> Views::update(const NamedView& view, const FirstAnswer<NamedView>& answer) {
  if (auto good = check_view(view); !good) return tl::unexpected(good.error());
  return change(pool_, answer, [&](PgConnection& connection) -> Result<NamedView> {
    auto row = connection.query(
        "UPDATE views SET name = $3, text = $4, content = $5, version = version + 1 WHERE id = $1 AND version = $2 "
        "RETURNING " STRATA_VIEW_COLUMNS,
        Params().integer(view.id).integer(view.version).text(view.name).text(view.text).json(view.content));
    if (!row) return tl::unexpected(row.error());
    return row->rows() > 0 ? Result<NamedView>(read_view(*row, 0)) : missed(connection, view);
  });
}

Result<void> Views::remove(const NamedView& view, const FirstAnswer<>& answer) {
  return change(pool_, answer, [&](PgConnection& connection) -> Result<void> {
    auto done = connection.query("DELETE FROM views WHERE id = $1 AND version = $2",
                                 Params().integer(view.id).integer(view.version));
    if (!done) return tl::unexpected(done.error());
    return done->affected() > 0 ? Result<void>{} : missed(connection, view);
  });
}

}  // namespace strata::store
