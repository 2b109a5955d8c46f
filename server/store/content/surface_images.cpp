#include "store/content/surface_images.h"

#include "store/content/surface_image_rows.h"
#include "store/pg/blobs.h"
#include "store/pg/pg_row.h"
#include "store/pg/sql.h"
#include "store/store_impl.h"

namespace strata::store {
namespace {

constexpr auto kSurfaceImageColumns = sql(
    "id, model_id, name, slug::text, description, media_type, width, height, opacity, visible, draw_order, version, "
    "encode(picture, 'hex'), (SELECT b.bytes FROM blobs b WHERE b.sha256 = picture)");

SurfaceImage read_surface_image(const PgResult& rows, int i) {
  PgRow row(rows, i);
  SurfaceImage image;
  image.id = row.id<SurfaceImageId>();
  image.model_id = row.id<ModelId>();
  image.name = row.text();
  image.slug = row.text();
  image.description = row.text();
  image.media_type = row.text();
  image.width = static_cast<int>(row.integer());
  image.height = static_cast<int>(row.integer());
  image.opacity = row.real();
  image.visible = row.boolean();
  image.order = static_cast<int>(row.integer());
  image.version = row.integer();
  image.sha256 = row.text();
  image.bytes = static_cast<std::uint64_t>(row.integer());
  return image;
}

}  // namespace

Result<void> check_surface_image(const SurfaceImage& image) {
  STRATA_TRY(check_name(image.name));
  if (!(image.opacity >= 0 && image.opacity <= 1))
    return fail(ErrorCode::malformed, "Invalid opacity", "`opacity` must be between 0 and 1.",
                "opacity");
  if (image.media_type != "image/jpeg" && image.media_type != "image/png")
    return fail(ErrorCode::unsupported, "Invalid picture",
                "A surface image must be a JPEG or PNG picture.", "media_type");
  if (image.width < 1 || image.height < 1)
    return fail(ErrorCode::invalid, "Invalid picture",
                "A surface image must have at least one pixel on each side.", "width");
  return check_texts({{&image.slug, "slug"}, {&image.description, "description"}});
}

Result<SurfaceImage> insert_surface_image(PgConnection& connection, const SurfaceImage& image,
                                          const Sha256& picture) {
  auto row = STRATA_TRY(insert_with_slug(
      connection, "SELECT slug::text FROM looks WHERE slug LIKE $1 AND model_id = $2",
      image.model_id.number(), image.slug.empty() ? image.name : image.slug,
      [&](const std::string& slug) {
        return connection.query(
            sql("INSERT INTO looks (model_id, name, slug, description, media_type, width, height, opacity, visible, draw_order, "
                "picture) VALUES ($1, $2, $3, $4, $5, $6, $7, $8, $9, $10, $11) "
                "ON CONFLICT (model_id, slug) DO NOTHING RETURNING ",
                kSurfaceImageColumns),
            Params()
                .id(image.model_id)
                .text(image.name)
                .text(slug)
                .text(image.description)
                .text(image.media_type)
                .integer(image.width)
                .integer(image.height)
                .real(image.opacity)
                .boolean(image.visible)
                .integer(image.order)
                .bytes(picture));
      }));
  return read_surface_image(row, 0);
}

Result<std::vector<SurfaceImage>> SurfaceImages::of_model(ModelId model_id) {
  return pool_.read([&](PgConnection& connection) -> Result<std::vector<SurfaceImage>> {
    auto known =
        STRATA_TRY(connection.query("SELECT 1 FROM models WHERE id = $1", Params().id(model_id)));
    if (known.rows() == 0) return no_such("model", to_string(model_id));
    auto rows =
        STRATA_TRY(connection.query(sql("SELECT ", kSurfaceImageColumns,
                                        " FROM looks WHERE model_id = $1 ORDER BY draw_order, id"),
                                    Params().id(model_id)));
    std::vector<SurfaceImage> images;
    for (int i = 0; i < rows.rows(); ++i) images.push_back(read_surface_image(rows, i));
    return images;
  });
}

Result<SurfaceImage> SurfaceImages::find(ModelId model_id, const std::string& ref) {
  if (!check_text(ref, "look")) return no_such("look", ref);
  return pool_.read([&](PgConnection& connection) -> Result<SurfaceImage> {
    const auto id = id_of<SurfaceImageId>(ref);
    auto rows =
        STRATA_TRY(id ? connection.query(sql("SELECT ", kSurfaceImageColumns,
                                             " FROM looks WHERE model_id = $1 AND id = $2"),
                                         Params().id(model_id).id(*id))
                      : connection.query(sql("SELECT ", kSurfaceImageColumns,
                                             " FROM looks WHERE model_id = $1 AND slug = $2"),
                                         Params().id(model_id).text(ref)));
    if (rows.rows() == 0) return no_such("look", ref);
    return read_surface_image(rows, 0);
  });
}

Result<SurfaceImage> SurfaceImages::create(const SurfaceImage& image,
                                           std::span<const std::uint8_t> picture,
                                           const IdempotentResponse<SurfaceImage>& answer) {
  STRATA_TRY(check_surface_image(image));
  Content content = content_of(picture);
  STRATA_TRY(blobs_.upload(content));
  const auto work = [&](PgConnection& connection) -> Result<SurfaceImage> {
    // Lock the model, so that concurrent transactions cannot exceed the limit together.
    auto model = STRATA_TRY(connection.query("SELECT 1 FROM models WHERE id = $1 FOR NO KEY UPDATE",
                                             Params().id(image.model_id)));
    if (model.rows() == 0) return no_such("model", to_string(image.model_id));
    auto count = STRATA_TRY(connection.query("SELECT count(*) FROM looks WHERE model_id = $1",
                                             Params().id(image.model_id)));
    if (count.integer(0, 0) >= kMaxSurfaceImages)
      return fail(ErrorCode::conflict, "Too many surface images",
                  "A model can have at most " + std::to_string(kMaxSurfaceImages) +
                      " surface images. Delete one first.");
    STRATA_TRY(keep_blob(connection, content, {}));
    return insert_surface_image(connection, image, content.hash);
  };
  return change(pool_, answer, work, kBulkLimits);
}

Result<SurfaceImage> SurfaceImages::update(const SurfaceImage& image,
                                           const IdempotentResponse<SurfaceImage>& answer) {
  STRATA_TRY(check_surface_image(image));
  return change(pool_, answer, [&](PgConnection& connection) -> Result<SurfaceImage> {
    auto row = STRATA_TRY(connection.query(
        sql("UPDATE looks SET name = $3, slug = $4, description = $5, opacity = $6, visible = $7, draw_order = $8, "
            "version = version + 1 WHERE id = $1 AND version = $2 RETURNING ",
            kSurfaceImageColumns),
        Params()
            .id(image.id)
            .integer(image.version)
            .text(image.name)
            .text(image.slug)
            .text(image.description)
            .real(image.opacity)
            .boolean(image.visible)
            .integer(image.order)));
    if (row.rows() > 0) return read_surface_image(row, 0);
    auto known =
        STRATA_TRY(connection.query("SELECT 1 FROM looks WHERE id = $1", Params().id(image.id)));
    if (known.rows() == 0) return no_such("look", to_string(image.id));
    return stale("look");
  });
}

Result<void> SurfaceImages::remove(SurfaceImageId id, const IdempotentResponse<>& answer) {
  const auto work = [&](PgConnection& connection) -> Result<void> {
    auto done =
        connection.query("DELETE FROM looks WHERE id = $1 RETURNING picture", Params().id(id));
    if (!done) return tl::unexpected(done.error());
    if (done->rows() == 0) return no_such("look", to_string(id));
    const Bytes hash = done->bytes(0, 0);
    return drop_unused(connection, {{hash.begin(), hash.end()}});
  };
  return change(pool_, answer, work, kBulkLimits);
}

Result<std::vector<std::uint8_t>> SurfaceImages::picture(SurfaceImageId id) {
  const auto row = STRATA_TRY(pool_.read([&](PgConnection& connection) {
    return connection.query("SELECT picture FROM looks WHERE id = $1", Params().id(id));
  }));
  if (row.rows() == 0) return no_such("look", to_string(id));
  return blobs_.read(row.bytes(0, 0));
}

}  // namespace strata::store
