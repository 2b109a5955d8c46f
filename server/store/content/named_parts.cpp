#include "store/content/named_parts.h"

#include <string_view>

#include "store/journal/kept_states.h"
#include "store/pg/pg_row.h"
#include "store/store_impl.h"

namespace strata::store {
namespace {

NamedPart read_part(const PgResult& rows, int i) {
  PgRow row(rows, i);
  return {row.id<NamedPartId>(),
          row.id<ModelId>(),
          row.text(),
          row.text(),
          row.text(),
          row.json(),
          row.text(),
          row.time(),
          row.integer()};
}

Result<void> check_part(const NamedPart& part) {
  STRATA_TRY(check_name(part.name));
  STRATA_TRY(check_json(part.content, {}));
  return check_texts({{&part.text, "text"}, {&part.user, "user"}});
}

void put_for(std::string& text, std::string_view word, std::string_view value) {
  for (auto at = text.find(word); at != std::string::npos; at = text.find(word))
    text.replace(at, word.size(), value);
}

}  // namespace

// Replaces `TABLE` by the table of the kind, `PART` by the columns that `read_part` reads, and
// `READABLE_BY` by the condition for parts that a user can read.
std::string NamedParts::sql(std::string text) const {
  put_for(text, "TABLE", kind_.table);
  put_for(text, "READABLE_BY",
          "(content ->> 'audience') IS DISTINCT FROM 'personal' OR user_name =");
  put_for(text, "PART", "id, model_id, slug, name, text, content, user_name, time, version");
  return text;
}

Result<NamedParts::Page> NamedParts::of_model(ModelId model_id, int limit, int offset,
                                              std::int64_t after, const std::string& reader) {
  return pool_.read([&](PgConnection& connection) -> Result<Page> {
    auto total = STRATA_TRY(connection.query(
        sql("SELECT count(*) FROM TABLE WHERE model_id = $1 AND (READABLE_BY $2)").c_str(),
        Params().id(model_id).text(reader)));
    auto rows = STRATA_TRY(connection.query(
        sql("SELECT PART FROM TABLE WHERE model_id = $1 AND id > $4 AND (READABLE_BY $5) "
            "ORDER BY id LIMIT $2 OFFSET $3")
            .c_str(),
        Params().id(model_id).integer(limit).integer(offset).integer(after).text(reader)));
    Page page;
    page.total = total.integer(0, 0);
    for (int i = 0; i < rows.rows(); ++i) page.parts.push_back(read_part(rows, i));
    return page;
  });
}

Result<std::map<NamedPartId, std::string>> NamedParts::slugs(ModelId model_id) {
  return pool_.read([&](PgConnection& connection) -> Result<std::map<NamedPartId, std::string>> {
    auto rows = STRATA_TRY(connection.query(
        sql("SELECT id, slug FROM TABLE WHERE model_id = $1").c_str(), Params().id(model_id)));
    std::map<NamedPartId, std::string> slugs;
    for (int i = 0; i < rows.rows(); ++i) slugs[rows.id<NamedPartId>(i, 0)] = rows.text(i, 1);
    return slugs;
  });
}

Result<NamedPart> NamedParts::find(ModelId model_id, const std::string& ref,
                                   const std::string& reader) {
  if (!check_text(ref, kind_.name)) return no_such(kind_.name, ref);
  return pool_.read([&](PgConnection& connection) -> Result<NamedPart> {
    const auto id = id_of<NamedPartId>(ref);
    auto rows =
        id ? connection.query(
                 sql("SELECT PART FROM TABLE WHERE model_id = $1 AND id = $2 AND (READABLE_BY $3)")
                     .c_str(),
                 Params().id(model_id).id(*id).text(reader))
           : connection.query(
                 sql("SELECT PART FROM TABLE WHERE model_id = $1 AND slug = $2 AND (READABLE_BY $3)")
                     .c_str(),
                 Params().id(model_id).text(ref).text(reader));
    if (!rows) return tl::unexpected(rows.error());
    if (rows->rows() == 0) return no_such(kind_.name, ref);
    return read_part(*rows, 0);
  });
}

Result<NamedPart> NamedParts::create(const NamedPart& part,
                                     const IdempotentResponse<NamedPart>& answer) {
  STRATA_TRY(check_part(part));
  return change(pool_, answer, [&](PgConnection& connection) -> Result<NamedPart> {
    // Lock the model, so that concurrent transactions cannot exceed the limit together.
    auto model = STRATA_TRY(connection.query("SELECT 1 FROM models WHERE id = $1 FOR NO KEY UPDATE",
                                             Params().id(part.model_id)));
    if (model.rows() == 0) return no_such("model", to_string(part.model_id));
    auto count = STRATA_TRY(connection.query(
        sql("SELECT count(*) FROM TABLE WHERE model_id = $1").c_str(), Params().id(part.model_id)));
    if (count.integer(0, 0) >= kind_.most)
      return fail(ErrorCode::conflict, "Too many " + std::string(kind_.table),
                  "A model can have at most " + std::to_string(kind_.most) + " " + kind_.table +
                      ". Delete some first.");
    // A later thinning of the journal sees the snapshot, because it locks the model, too.
    if (kind_.names_states)
      STRATA_TRY(
          check_kept(connection, part.model_id, part.content.value("sequence", std::int64_t{0})));
    const std::string taken = sql("SELECT slug FROM TABLE WHERE slug LIKE $1 AND model_id = $2");
    const std::string insert = sql(
        "INSERT INTO TABLE (model_id, slug, name, text, content, user_name) VALUES ($1, $2, $3, $4, $5, $6) "
        "ON CONFLICT (model_id, slug) DO NOTHING RETURNING PART");
    auto row = STRATA_TRY(insert_with_slug(
        connection, taken.c_str(), part.model_id.number(), part.name, [&](const std::string& slug) {
          return connection.query(insert.c_str(), Params()
                                                      .id(part.model_id)
                                                      .text(slug)
                                                      .text(part.name)
                                                      .text(part.text)
                                                      .json(part.content)
                                                      .text(part.user));
        }));
    return read_part(row, 0);
  });
}

namespace {

// Returns the error for an update or deletion that had no effect, because the part does not exist
// or has another version.
tl::unexpected<Error> missed(const Result<PgResult>& known, const NamedParts::Kind& kind,
                             const NamedPart& part) {
  if (!known) return tl::unexpected(known.error());
  if (known->rows() == 0) return no_such(kind.name, part.slug);
  return stale(kind.name);
}

}  // namespace

Result<NamedPart> NamedParts::update(const NamedPart& part,
                                     const IdempotentResponse<NamedPart>& answer) {
  STRATA_TRY(check_part(part));
  return change(pool_, answer, [&](PgConnection& connection) -> Result<NamedPart> {
    auto row = STRATA_TRY(connection.query(
        sql("UPDATE TABLE SET name = $3, text = $4, content = $5, version = version + 1 "
            "WHERE id = $1 AND version = $2 RETURNING PART")
            .c_str(),
        Params()
            .id(part.id)
            .integer(part.version)
            .text(part.name)
            .text(part.text)
            .json(part.content)));
    if (row.rows() > 0) return read_part(row, 0);
    return missed(
        connection.query(sql("SELECT 1 FROM TABLE WHERE id = $1").c_str(), Params().id(part.id)),
        kind_, part);
  });
}

Result<void> NamedParts::remove(const NamedPart& part, const IdempotentResponse<>& answer) {
  return change(pool_, answer, [&](PgConnection& connection) -> Result<void> {
    auto done =
        STRATA_TRY(connection.query(sql("DELETE FROM TABLE WHERE id = $1 AND version = $2").c_str(),
                                    Params().id(part.id).integer(part.version)));
    if (done.affected() > 0) return {};
    return missed(
        connection.query(sql("SELECT 1 FROM TABLE WHERE id = $1").c_str(), Params().id(part.id)),
        kind_, part);
  });
}

}  // namespace strata::store
