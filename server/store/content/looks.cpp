#include "store/content/looks.h"

#include "store/content/look_rows.h"
#include "store/pg/blobs.h"
#include "store/store_impl.h"

namespace strata::store {
namespace {

#define STRATA_LOOK_COLUMNS                                                                                         \
  "id, model_id, name, slug::text, description, media_type, width, height, opacity, visible, draw_order, version, " \
  "encode(picture, 'hex'), (SELECT b.bytes FROM blobs b WHERE b.sha256 = picture)"

Look read_look(const PgResult& rows, int i) {
  Look look;
  int c = 0;
  look.id = rows.integer(i, c++);
  look.model_id = rows.integer(i, c++);
  look.name = rows.text(i, c++);
  look.slug = rows.text(i, c++);
  look.description = rows.text(i, c++);
  look.media_type = rows.text(i, c++);
  look.width = static_cast<int>(rows.integer(i, c++));
  look.height = static_cast<int>(rows.integer(i, c++));
  look.opacity = rows.real(i, c++);
  look.visible = rows.boolean(i, c++);
  look.order = static_cast<int>(rows.integer(i, c++));
  look.version = rows.integer(i, c++);
  look.sha256 = rows.text(i, c++);
  look.bytes = static_cast<std::uint64_t>(rows.integer(i, c++));
  return look;
}

}  // namespace

Result<void> check_look(const Look& look) {
  STRATA_TRY(check_name(look.name));
  if (!(look.opacity >= 0 && look.opacity <= 1))
    return fail(ErrorCode::malformed, "Bad opacity", "`opacity` must be between 0 and 1.",
                "opacity");
  if (look.media_type != "image/jpeg" && look.media_type != "image/png")
    return fail(ErrorCode::unsupported, "Bad picture", "A look is a JPEG or a PNG picture.",
                "media_type");
  if (look.width < 1 || look.height < 1)
    return fail(ErrorCode::invalid, "Bad picture", "A look has at least one pixel a side.",
                "width");
  return check_texts({{&look.slug, "slug"}, {&look.description, "description"}});
}

Result<Look> insert_look(PgConnection& connection, const Look& look, const Sha256& picture) {
  auto row = STRATA_TRY(insert_with_slug(
      connection, "SELECT slug::text FROM looks WHERE slug LIKE $1 AND model_id = $2",
      look.model_id, look.slug.empty() ? look.name : look.slug, [&](const std::string& slug) {
        return connection.query(
            "INSERT INTO looks (model_id, name, slug, description, media_type, width, height, opacity, visible, draw_order, "
            "picture) VALUES ($1, $2, $3, $4, $5, $6, $7, $8, $9, $10, $11) "
            "ON CONFLICT (model_id, slug) DO NOTHING RETURNING " STRATA_LOOK_COLUMNS,
            Params()
                .integer(look.model_id)
                .text(look.name)
                .text(slug)
                .text(look.description)
                .text(look.media_type)
                .integer(look.width)
                .integer(look.height)
                .real(look.opacity)
                .boolean(look.visible)
                .integer(look.order)
                .bytes(picture));
      }));
  return read_look(row, 0);
}

Result<std::vector<Look>> Looks::of_model(std::int64_t model_id) {
  return pool_.read([&](PgConnection& connection) -> Result<std::vector<Look>> {
    auto known = STRATA_TRY(
        connection.query("SELECT 1 FROM models WHERE id = $1", Params().integer(model_id)));
    if (known.rows() == 0) return no_such("model", std::to_string(model_id));
    auto rows = STRATA_TRY(connection.query(
        "SELECT " STRATA_LOOK_COLUMNS " FROM looks WHERE model_id = $1 ORDER BY draw_order, id",
        Params().integer(model_id)));
    std::vector<Look> looks;
    for (int i = 0; i < rows.rows(); ++i) looks.push_back(read_look(rows, i));
    return looks;
  });
}

Result<Look> Looks::find(std::int64_t model_id, const std::string& ref) {
  if (!check_text(ref, "look")) return no_such("look", ref);
  return pool_.read([&](PgConnection& connection) -> Result<Look> {
    const auto id = id_of(ref);
    auto rows = STRATA_TRY(id ? connection.query("SELECT " STRATA_LOOK_COLUMNS
                                                 " FROM looks WHERE model_id = $1 AND id = $2",
                                                 Params().integer(model_id).integer(*id))
                              : connection.query("SELECT " STRATA_LOOK_COLUMNS
                                                 " FROM looks WHERE model_id = $1 AND slug = $2",
                                                 Params().integer(model_id).text(ref)));
    if (rows.rows() == 0) return no_such("look", ref);
    return read_look(rows, 0);
  });
}

Result<Look> Looks::create(const Look& look, std::span<const std::uint8_t> picture,
                           const FirstAnswer<Look>& answer) {
  STRATA_TRY(check_look(look));
  const Content content = content_of(picture);
  const auto work = [&](PgConnection& connection) -> Result<Look> {
    // Locked, so that of two at once the later one counts the earlier.
    auto model = STRATA_TRY(connection.query("SELECT 1 FROM models WHERE id = $1 FOR NO KEY UPDATE",
                                             Params().integer(look.model_id)));
    if (model.rows() == 0) return no_such("model", std::to_string(look.model_id));
    auto count = STRATA_TRY(connection.query("SELECT count(*) FROM looks WHERE model_id = $1",
                                             Params().integer(look.model_id)));
    if (count.integer(0, 0) >= kMostLooks)
      return fail(
          ErrorCode::conflict, "Too many looks",
          "A model holds at most " + std::to_string(kMostLooks) + " looks. Delete one first.");
    STRATA_TRY(keep_blob(connection, content, {}));
    return insert_look(connection, look, content.hash);
  };
  return change(pool_, answer, work, kBulkLimits);
}

Result<Look> Looks::update(const Look& look, const FirstAnswer<Look>& answer) {
  STRATA_TRY(check_look(look));
  return change(pool_, answer, [&](PgConnection& connection) -> Result<Look> {
    auto row = STRATA_TRY(connection.query(
        "UPDATE looks SET name = $3, slug = $4, description = $5, opacity = $6, visible = $7, draw_order = $8, "
        "version = version + 1 WHERE id = $1 AND version = $2 RETURNING " STRATA_LOOK_COLUMNS,
        Params()
            .integer(look.id)
            .integer(look.version)
            .text(look.name)
            .text(look.slug)
            .text(look.description)
            .real(look.opacity)
            .boolean(look.visible)
            .integer(look.order)));
    if (row.rows() > 0) return read_look(row, 0);
    auto known = STRATA_TRY(
        connection.query("SELECT 1 FROM looks WHERE id = $1", Params().integer(look.id)));
    if (known.rows() == 0) return no_such("look", std::to_string(look.id));
    return stale("look");
  });
}

Result<void> Looks::remove(std::int64_t id, const FirstAnswer<>& answer) {
  const auto work = [&](PgConnection& connection) -> Result<void> {
    auto done =
        connection.query("DELETE FROM looks WHERE id = $1 RETURNING picture", Params().integer(id));
    if (!done) return tl::unexpected(done.error());
    if (done->rows() == 0) return no_such("look", std::to_string(id));
    const Bytes hash = done->bytes(0, 0);
    return drop_unused(connection, {{hash.begin(), hash.end()}});
  };
  return change(pool_, answer, work, kBulkLimits);
}

Result<std::vector<std::uint8_t>> Looks::picture(std::int64_t id) {
  return pool_.read([&](PgConnection& connection) -> Result<std::vector<std::uint8_t>> {
    auto row = STRATA_TRY(connection.query(
        "SELECT b.sha256, b.bytes FROM looks l JOIN blobs b ON b.sha256 = l.picture WHERE l.id = $1",
        Params().integer(id)));
    if (row.rows() == 0) return no_such("look", std::to_string(id));
    return read_blob(connection, row.bytes(0, 0), row.integer(0, 1));
  });
}

}  // namespace strata::store
