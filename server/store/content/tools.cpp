#include "store/content/tools.h"
#include "store/pg/pg_row.h"
#include "store/pg/sql.h"
#include "store/store_impl.h"

namespace strata::store {
namespace {

constexpr auto kToolColumns = sql("id, name, slug::text, deleted IS NOT NULL, version");

Tool read_tool(const PgResult& rows, int i) {
  PgRow row(rows, i);
  return {row.id<ToolId>(), row.text(), row.text(), row.boolean(), row.integer()};
}

constexpr std::size_t kShapeBytes = sizeof(ShapeBits);

std::vector<std::uint8_t> bytes_of(const ShapeBits& bits) {
  std::vector<std::uint8_t> bytes(kShapeBytes);
  for (std::size_t i = 0; i < bytes.size(); ++i)
    bytes[i] = static_cast<std::uint8_t>(bits[i / 8] >> (i % 8 * 8));
  return bytes;
}

ShapeBits bits_of(Bytes bytes) {
  ShapeBits bits{};
  for (std::size_t i = 0; i < bytes.size(); ++i)
    bits[i / 8] |= std::uint64_t{bytes[i]} << (i % 8 * 8);
  return bits;
}

}  // namespace

Result<std::vector<Tool>> Tools::all() {
  return pool_.read([&](PgConnection& connection) -> Result<std::vector<Tool>> {
    auto rows =
        connection.query(sql("SELECT ", kToolColumns,
                             " FROM tool_shapes WHERE deleted IS NULL ORDER BY lower(name), id"));
    if (!rows) return tl::unexpected(rows.error());
    std::vector<Tool> tools;
    for (int i = 0; i < rows->rows(); ++i) tools.push_back(read_tool(*rows, i));
    return tools;
  });
}

Result<Tool> Tools::find(const std::string& ref) {
  if (!check_text(ref, "tool")) return no_such("tool", ref);
  return pool_.read([&](PgConnection& connection) -> Result<Tool> {
    const auto id = id_of<ToolId>(ref);
    auto rows =
        id ? connection.query(sql("SELECT ", kToolColumns, " FROM tool_shapes WHERE id = $1"),
                              Params().id(*id))
           : connection.query(sql("SELECT ", kToolColumns,
                                  " FROM tool_shapes WHERE slug = $1 AND deleted IS NULL"),
                              Params().text(ref));
    if (!rows) return tl::unexpected(rows.error());
    if (rows->rows() == 0) return no_such("tool", ref);
    return read_tool(*rows, 0);
  });
}

Result<Tool> Tools::create(const Tool& tool, const ShapeBits& shape,
                           const IdempotentResponse<Tool>& answer) {
  STRATA_TRY(check_name(tool.name));
  STRATA_TRY(check_text(tool.slug, "slug"));
  const auto cells = bytes_of(shape);
  return change(pool_, answer, [&](PgConnection& connection) -> Result<Tool> {
    // Lock the table, so that two concurrent transactions cannot exceed the limit together. The
    // lock does not block readers.
    STRATA_TRY(connection.query("LOCK TABLE tool_shapes IN SHARE ROW EXCLUSIVE MODE"));
    auto count =
        STRATA_TRY(connection.query("SELECT count(*) FROM tool_shapes WHERE deleted IS NULL"));
    if (count.integer(0, 0) >= kMaxTools)
      return fail(
          ErrorCode::conflict, "Too many tools",
          "A server can have at most " + std::to_string(kMaxTools) + " tools. Delete one first.");
    auto row = STRATA_TRY(insert_with_slug(
        connection,
        "SELECT slug::text FROM tool_shapes WHERE slug LIKE $1 AND deleted IS NULL "
        "UNION ALL SELECT unnest(ARRAY['disc', 'square'])",
        {}, tool.slug.empty() ? tool.name : tool.slug, [&](const std::string& slug) {
          return connection.query(
              sql("INSERT INTO tool_shapes (name, slug, cells) VALUES ($1, $2, $3) "
                  "ON CONFLICT (slug) WHERE deleted IS NULL DO NOTHING RETURNING ",
                  kToolColumns),
              Params().text(tool.name).text(slug).bytes(cells));
        }));
    return read_tool(row, 0);
  });
}

Result<Tool> Tools::update(const Tool& tool, const IdempotentResponse<Tool>& answer) {
  STRATA_TRY(check_name(tool.name));
  return change(pool_, answer, [&](PgConnection& connection) -> Result<Tool> {
    auto row = STRATA_TRY(connection.query(
        sql("UPDATE tool_shapes SET name = $3, version = version + 1 WHERE id = $1 AND version = $2 AND deleted IS NULL "
            "RETURNING ",
            kToolColumns),
        Params().id(tool.id).integer(tool.version).text(tool.name)));
    if (row.rows() > 0) return read_tool(row, 0);
    auto known = STRATA_TRY(connection.query(
        "SELECT 1 FROM tool_shapes WHERE id = $1 AND deleted IS NULL", Params().id(tool.id)));
    if (known.rows() == 0) return no_such("tool", to_string(tool.id));
    return stale("tool");
  });
}

Result<void> Tools::remove(ToolId id, const IdempotentResponse<>& answer) {
  return change(pool_, answer, [&](PgConnection& connection) -> Result<void> {
    auto done = STRATA_TRY(connection.query(
        "UPDATE tool_shapes SET deleted = now(), version = version + 1 WHERE id = $1 AND deleted IS NULL RETURNING id",
        Params().id(id)));
    if (done.rows() == 0) return no_such("tool", to_string(id));
    return {};
  });
}

Result<ShapeBits> Tools::shape(ToolId id) {
  return pool_.read([&](PgConnection& connection) -> Result<ShapeBits> {
    auto row = connection.query("SELECT cells FROM tool_shapes WHERE id = $1", Params().id(id));
    if (!row) return tl::unexpected(row.error());
    if (row->rows() == 0) return no_such("tool", to_string(id));
    return bits_of(row->bytes(0, 0));
  });
}

}  // namespace strata::store
