#include <algorithm>

#include "domain/tables/column_value.h"
#include "media/media_type.h"
#include "store/pg/blobs.h"
#include "store/pg/pg_row.h"
#include "store/pg/sql.h"
#include "store/store_impl.h"
#include "store/tables/attachments.h"
#include "store/tables/table_rows.h"
#include "store/tables/table_writer.h"

namespace strata::store {
namespace {

constexpr auto kAttachmentColumns =
    sql("a.id, a.table_id, a.name, a.media_type, b.bytes, encode(a.sha256, 'hex'), a.width, "
        "a.height, a.user_name, a.time, a.visibility");

std::optional<int> side_of(std::optional<std::int64_t> pixels) {
  return pixels ? std::optional(static_cast<int>(*pixels)) : std::nullopt;
}

Attachment read_attachment_row(const PgResult& rows, int i) {
  PgRow row(rows, i);
  return {row.id<AttachmentId>(),
          row.id<TableId>(),
          row.text(),
          row.text(),
          static_cast<std::uint64_t>(row.integer()),
          row.text(),
          side_of(row.optional_integer()),
          side_of(row.optional_integer()),
          row.text(),
          row.time(),
          parse_visibility(row.text()).value_or(Visibility::curators)};
}

Result<std::vector<Attachment>> rows_of_ids(PgConnection& connection, TableId table_id,
                                            std::span<const AttachmentId> ids) {
  PgArray list(oid::kInt8);
  for (const auto id : ids) list.add(id);
  auto rows =
      STRATA_TRY(connection.query(sql("SELECT ", kAttachmentColumns,
                                      " FROM attachments a JOIN blobs b USING (sha256) "
                                      "WHERE a.table_id = $1 AND a.id = any($2) ORDER BY a.id"),
                                  Params().id(table_id).array(list)));
  std::vector<Attachment> found;
  for (int i = 0; i < rows.rows(); ++i) found.push_back(read_attachment_row(rows, i));
  return found;
}

// Returns the column for the files: the requested column, or the first column that accepts all
// files.
Result<const Column*> column_for(const Table& table, std::optional<ColumnId> requested,
                                 const std::vector<NewAttachment>& files) {
  const auto is_picture = [](const auto& file) { return is_raster_picture(file.media_type); };
  const bool all_pictures = std::all_of(files.begin(), files.end(), is_picture);
  const Column *pictures = nullptr, *documents = nullptr;
  for (const Column& column : table.columns) {
    if (requested && column.id == *requested) {
      if (!holds_attachments(column.kind))
        return fail(ErrorCode::invalid, "No column for files",
                    "\"" + column.name + "\" is of kind `" + std::string(name(column.kind)) +
                        "`. Choose a column of kind `picture` or `document`.",
                    "column");
      return &column;
    }
    if (column.kind == ColumnKind::picture && !pictures) pictures = &column;
    if (column.kind == ColumnKind::document && !documents) documents = &column;
  }
  if (requested) return no_such("column", to_string(*requested));
  if (all_pictures && pictures) return pictures;
  if (documents) return documents;
  return fail(
      ErrorCode::invalid, "No column for files",
      pictures
          ? table.name +
                " has only columns for pictures, but some of the files are not pictures (JPEG, "
                "PNG, TIFF, WebP, GIF, HEIC, AVIF, BMP, JPEG 2000)."
          : table.name + " has no column of kind `picture` or `document`. Add one first.",
      "column");
}

Result<Record> record_of(PgConnection& connection, const OpenTable& open, std::int64_t key,
                         std::optional<std::int64_t> version) {
  auto rows = STRATA_TRY(load_rows(connection, open.table.id, open.all, std::vector{key}));
  if (rows.empty()) return no_such("record", std::to_string(key));
  if (version && *version != rows.front().version) return stale("record");
  return std::move(rows.front());
}

nlohmann::json cell_of(const Record& record, const Column& column) {
  const auto value = record.values.find(column.id);
  return value == record.values.end() ? nlohmann::json::array() : value->second;
}

Result<Attachment> insert_attachment(PgConnection& connection, TableId table_id,
                                     const NewAttachment& file, const Sha256& hash,
                                     const std::string& user) {
  auto row = STRATA_TRY(connection.query(
      "INSERT INTO attachments (table_id, sha256, name, media_type, width, height, user_name, visibility) "
      "VALUES ($1, $2, $3, $4, $5, $6, $7, $8) RETURNING id",
      Params()
          .id(table_id)
          .bytes(hash)
          .text(file.name)
          .text(file.media_type)
          .optional_integer(file.width)
          .optional_integer(file.height)
          .text(user)
          .text(name(file.visibility))));
  auto made =
      STRATA_TRY(rows_of_ids(connection, table_id, std::vector{row.id<AttachmentId>(0, 0)}));
  return std::move(made.front());
}

Result<TableChange> without_problems(Result<TableChange> change) {
  if (change && !change->problems.empty()) return tl::unexpected(change->problems.front().problem);
  return change;
}

}  // namespace

Result<Attached> Attachments::attach(TableId table_id, std::int64_t key,
                                     std::optional<ColumnId> column_id,
                                     const std::vector<NewAttachment>& files,
                                     std::optional<std::int64_t> version, const Author& who,
                                     const IdempotentResponse<Attached>& answer) {
  STRATA_TRY(check_text(who.user, "user"));
  std::vector<Content> contents;
  for (const NewAttachment& file : files) {
    STRATA_TRY(check_name(file.name));
    auto content = STRATA_TRY(content_of(file.file, {}));
    contents.push_back(std::move(content));
  }
  // Check the request before gigabytes are stored. The check is repeated when the table is locked.
  // The table is locked late, because other transactions wait for the lock. The first check is a
  // separate transaction, because it could otherwise deadlock with a deletion of the table. The
  // deletion would wait for the rows that the check has read, and the check for the table that the
  // deletion has locked.
  auto may = pool_.read([&](PgConnection& connection) -> Result<void> {
    auto open = STRATA_TRY(read_table(connection, table_id, who.role));
    if (auto there = record_of(connection, open, key, version); !there) {
      // The table was deleted between the two reads.
      if (connection.sqlstate() == "42P01") return no_such("table", to_string(table_id));
      return tl::unexpected(there.error());
    }
    auto column = column_for(open.table, column_id, files);
    return column ? Result<void>{} : tl::unexpected(column.error());
  });
  if (!may) return tl::unexpected(may.error());
  STRATA_TRY(blobs_.upload(contents, {}));
  std::vector<const Content*> by_hash;
  for (const Content& content : contents) by_hash.push_back(&content);
  std::sort(by_hash.begin(), by_hash.end(),
            [](const Content* a, const Content* b) { return a->hash < b->hash; });
  const auto work = [&](PgConnection& connection) -> Result<Attached> {
    for (const Content* content : by_hash) STRATA_TRY(keep_blob(connection, *content, {}));
    auto open = STRATA_TRY(lock_table(connection, table_id));
    auto record = STRATA_TRY(record_of(connection, open, key, version));
    const Table seen = seen_by(open.table, who.role);
    auto column = STRATA_TRY(column_for(seen, column_id, files));
    Attached attached;
    nlohmann::json cell = cell_of(record, *column), ids = nlohmann::json::array();
    for (std::size_t i = 0; i < files.size(); ++i) {
      auto made =
          STRATA_TRY(insert_attachment(connection, table_id, files[i], contents[i].hash, who.user));
      cell.push_back(made.id);
      ids.push_back(made.id);
      attached.attachments.push_back(std::move(made));
    }
    auto value = STRATA_TRY(check_value(*column, cell, "column"));
    TableEdit edit{who.user,
                   "attach",
                   {{"records", 1}, {"keys", nlohmann::json::array({key})}, {"attachments", ids}},
                   {},
                   {}};
    edit.records[key][to_string(column->id)] = std::move(value);
    auto change = STRATA_TRY(without_problems(apply_edit(connection, open, std::move(edit))));
    attached.change = std::move(change);
    return attached;
  };
  return change(pool_, answer, work, kBulkLimits);
}

Result<TableChange> Attachments::detach(AttachmentId attachment_id, const std::string& user,
                                        const IdempotentResponse<TableChange>& answer) {
  STRATA_TRY(check_text(user, "user"));
  return change(pool_, answer, [&](PgConnection& connection) -> Result<TableChange> {
    auto owner = STRATA_TRY(connection.query("SELECT table_id FROM attachments WHERE id = $1",
                                             Params().id(attachment_id)));
    if (owner.rows() == 0) return no_such("attachment", to_string(attachment_id));
    auto open = STRATA_TRY(lock_table(connection, owner.id<TableId>(0, 0)));
    TableEdit edit{
        user, "detach", {{"attachments", nlohmann::json::array({attachment_id})}}, {}, {}};
    std::vector<std::int64_t> keys;
    for (const Column& column : open.table.columns) {
      if (!holds_attachments(column.kind)) continue;
      auto holding = STRATA_TRY(rows_holding(connection, open.table.id, column, attachment_id));
      auto rows = STRATA_TRY(load_rows(connection, open.table.id, {column}, holding));
      for (const Record& row : rows) {
        nlohmann::json cell = cell_of(row, column);
        cell.erase(std::remove(cell.begin(), cell.end(), nlohmann::json(attachment_id)),
                   cell.end());
        edit.records[row.key][to_string(column.id)] =
            cell.empty() ? nlohmann::json() : std::move(cell);
      }
      keys.insert(keys.end(), holding.begin(), holding.end());
    }
    if (edit.records.empty())
      return fail(ErrorCode::not_found, "Not found",
                  "The attachment " + to_string(attachment_id) + " no longer belongs to a record.");
    edit.record["records"] = edit.records.size();
    if (keys.size() > kMaxRowProblems) keys.resize(kMaxRowProblems);
    edit.record["keys"] = keys;
    return without_problems(apply_edit(connection, open, std::move(edit)));
  });
}

Result<Attachment> Attachments::find(AttachmentId id, const Author& seen_by) {
  return pool_.read([&](PgConnection& connection) -> Result<Attachment> {
    auto row = STRATA_TRY(
        connection.query(sql("SELECT ", kAttachmentColumns,
                             " FROM attachments a JOIN blobs b USING (sha256) WHERE a.id = $1"),
                         Params().id(id)));
    if (row.rows() == 0) return no_such("attachment", to_string(id));
    Attachment found = read_attachment_row(row, 0);
    if (!sees(seen_by, found)) return no_such("attachment", to_string(id));
    return found;
  });
}

Result<std::vector<Attachment>> Attachments::of_table(TableId table_id, const Author& seen_by,
                                                      std::span<const AttachmentId> ids) {
  auto found =
      pool_.read([&](PgConnection& connection) { return rows_of_ids(connection, table_id, ids); });
  if (found)
    std::erase_if(*found, [&](const Attachment& attachment) { return !sees(seen_by, attachment); });
  return found;
}

Result<Attachment> Attachments::show(AttachmentId id, Visibility visibility,
                                     const IdempotentResponse<Attachment>& answer) {
  return change(pool_, answer, [&](PgConnection& connection) -> Result<Attachment> {
    auto row = STRATA_TRY(connection.query(
        sql("WITH a AS (UPDATE attachments SET visibility = $2 WHERE id = $1 RETURNING *) SELECT ",
            kAttachmentColumns, " FROM a JOIN blobs b USING (sha256)"),
        Params().id(id).text(name(visibility))));
    if (row.rows() == 0) return no_such("attachment", to_string(id));
    return read_attachment_row(row, 0);
  });
}

Result<void> Attachments::read(const std::string& sha256, std::uint64_t begin, std::uint64_t end,
                               const std::function<bool(std::span<const std::uint8_t>)>& sink) {
  auto row = STRATA_TRY(pool_.read([&](PgConnection& connection) {
    return connection.query("SELECT sha256 FROM blobs WHERE sha256 = decode($1, 'hex')",
                            Params().text(sha256));
  }));
  if (row.rows() == 0) return no_such("file", sha256);
  return blobs_.stream(row.bytes(0, 0), begin, end, sink);
}

Result<std::optional<std::vector<std::uint8_t>>> Attachments::thumbnail(const std::string& sha256,
                                                                        int side) {
  using Found = std::optional<std::vector<std::uint8_t>>;
  return pool_.read([&](PgConnection& connection) -> Result<Found> {
    auto row = STRATA_TRY(connection.query(
        "SELECT picture FROM thumbnails WHERE sha256 = decode($1, 'hex') AND side = $2",
        Params().text(sha256).integer(side)));
    if (row.rows() == 0) return Found();
    const Bytes picture = row.bytes(0, 0);
    return Found(std::vector(picture.begin(), picture.end()));
  });
}

Result<void> Attachments::keep_thumbnail(const std::string& sha256, int side,
                                         std::span<const std::uint8_t> picture) {
  return pool_.write([&](PgConnection& connection) -> Result<void> {
    auto saved = connection.query(
        "INSERT INTO thumbnails (sha256, side, picture) SELECT sha256, $2, $3 FROM blobs "
        "WHERE sha256 = decode($1, 'hex') ON CONFLICT DO NOTHING",
        Params().text(sha256).integer(side).bytes(picture));
    return saved ? Result<void>{} : tl::unexpected(saved.error());
  });
}

Result<std::int64_t> Attachments::drop_orphans() {
  return pool_.write_within(kBulkLimits,
                            [](PgConnection& connection) { return drop_all_unused(connection); });
}

}  // namespace strata::store
