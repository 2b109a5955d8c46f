#include "store/content/comments.h"

#include <algorithm>

#include "store/store_impl.h"

// A thread's first comment is locked by whoever adds or takes away a reply, so that it is not
// deleted, or kept, for what is no longer so.

namespace strata::store {
namespace {

constexpr std::size_t kMaxTextLength = 10'000;  // characters

// Who sees the layer that the thread is about, in the Trash or not, sees the thread. Also of a
// comment that a statement has just made.
#define STRATA_COMMENT_VISIBILITY                                                                                         \
  "CASE WHEN c.thread_id IS NULL THEN coalesce((SELECT visibility FROM all_layers WHERE id = c.layer_id), c.visibility) " \
  "ELSE (SELECT coalesce(l.visibility, f.visibility) FROM comments f LEFT JOIN all_layers l ON l.id = f.layer_id "        \
  "WHERE f.id = c.thread_id) END"
// One in the Trash is not told, and is there again when it comes back.
#define STRATA_COMMENT_LAYER "(SELECT id FROM layers WHERE id = c.layer_id) AS layer_id"
#define STRATA_COMMENT_COLUMNS                                                 \
  "c.id, c.model_id, c.thread_id, c.position, c.normal, " STRATA_COMMENT_LAYER \
  ", c.table_id, c.record_key, c.text, "                                       \
  "c.user_name, c.time, c.edited, c.deleted IS NOT NULL, c.resolved, c.resolved_by, c.version, " STRATA_COMMENT_VISIBILITY

std::optional<std::int64_t> id_at(const PgResult& rows, int row, int column) {
  return rows.null(row, column) ? std::nullopt : std::optional(rows.integer(row, column));
}

glm::dvec3 point_at(const PgResult& rows, int row, int column) {
  const auto numbers = rows.reals(row, column);
  return {numbers.at(0), numbers.at(1), numbers.at(2)};
}

Comment read_comment(const PgResult& rows, int i) {
  Comment comment;
  comment.id = rows.id<CommentId>(i, 0);
  comment.model_id = rows.id<ModelId>(i, 1);
  comment.thread = rows.id<std::optional<CommentId>>(i, 2);
  if (!rows.null(i, 3)) comment.place = {point_at(rows, i, 3), point_at(rows, i, 4)};
  comment.layer_id = rows.id<std::optional<LayerId>>(i, 5);
  comment.table_id = rows.id<std::optional<TableId>>(i, 6);
  // A key says nothing without its table, which may have been deleted.
  if (comment.table_id) comment.record = id_at(rows, i, 7);
  comment.text = rows.text(i, 8);
  comment.user = rows.text(i, 9);
  comment.time = rows.time(i, 10);
  if (!rows.null(i, 11)) comment.edited = rows.time(i, 11);
  comment.deleted = rows.boolean(i, 12);
  if (!rows.null(i, 13)) comment.resolved = {rows.text(i, 14), rows.time(i, 13)};
  comment.version = rows.integer(i, 15);
  // What cannot be told is not shown.
  comment.visibility = parse_visibility(rows.text(i, 16)).value_or(Visibility::curators);
  return comment;
}

PgArray array_of(const glm::dvec3& point) {
  PgArray numbers(oid::kFloat8);
  for (int axis = 0; axis < 3; ++axis) numbers.add(point[axis]);
  return numbers;
}

Result<void> check_words(const std::string& text) {
  STRATA_TRY(check_text(text, "text"));
  if (text.find_first_not_of(" \t\r\n\v\f") == std::string::npos)
    return fail(ErrorCode::invalid, "Nothing written", "`text` is blank.", "text");
  const auto begins_character = [](char c) {
    return (static_cast<unsigned char>(c) & 0xc0) != 0x80;
  };
  if (static_cast<std::size_t>(std::ranges::count_if(text, begins_character)) > kMaxTextLength)
    return fail(ErrorCode::invalid, "Text too long",
                "`text` has at most " + std::to_string(kMaxTextLength) + " characters.", "text");
  return {};
}

// One of a model that is there.
#define STRATA_COMMENT \
  "FROM comments c WHERE id = $1 AND EXISTS (SELECT 1 FROM models WHERE id = c.model_id)"

enum class Lock { none, keep, change };  // `keep`: it stays while this transaction lasts

Result<Comment> load(PgConnection& connection, CommentId id, Lock lock) {
  const char* sql = lock == Lock::none ? "SELECT " STRATA_COMMENT_COLUMNS " " STRATA_COMMENT
                    : lock == Lock::keep
                        ? "SELECT " STRATA_COMMENT_COLUMNS " " STRATA_COMMENT " FOR SHARE"
                        : "SELECT " STRATA_COMMENT_COLUMNS " " STRATA_COMMENT " FOR UPDATE";
  auto rows = STRATA_TRY(connection.query(sql, Params().id(id)));
  if (rows.rows() == 0) return no_such("comment", to_string(id));
  return read_comment(rows, 0);
}

Result<Comment> load_thread(PgConnection& connection, CommentId id, Lock lock) {
  auto first = load(connection, id, lock);
  if (first && first->thread)
    return fail(ErrorCode::invalid, "A reply",
                "Replies are to the first comment of a thread, which is " +
                    to_string(*first->thread) + " here.");
  return first;
}

Result<Comments::Page> page_of(Result<PgResult> total, Result<PgResult> rows) {
  if (!total) return tl::unexpected(total.error());
  if (!rows) return tl::unexpected(rows.error());
  Comments::Page page;
  page.total = total->integer(0, 0);
  for (int i = 0; i < rows->rows(); ++i) page.comments.push_back(read_comment(*rows, i));
  return page;
}

}  // namespace

Result<Comments::Page> Comments::of_model(ModelId model_id, Role seen_by, const Query& query) {
// Times are told in milliseconds: one that was read counts what was changed then.
#define STRATA_ASKED_COMMENTS                                                                            \
  " FROM comments c JOIN comments first ON first.id = coalesce(c.thread_id, c.id) WHERE c.model_id = $1" \
  " AND ($2::text IS NULL OR ($2 = 'resolved') = (first.resolved IS NOT NULL))"                          \
  " AND ($3::text IS NULL OR date_trunc('milliseconds', c.changed) >= $3::timestamptz)"                  \
  " AND " STRATA_COMMENT_VISIBILITY " = any($4)"
  std::optional<std::string> state;
  if (query.resolved) state = *query.resolved ? "resolved" : "open";
  return pool_.read([&](PgConnection& connection) {
    auto total = connection.query("SELECT count(*)" STRATA_ASKED_COMMENTS,
                                  Params()
                                      .id(model_id)
                                      .optional_text(state)
                                      .optional_text(query.since)
                                      .array(visibilities_seen_by(seen_by)));
    auto rows = connection.query("SELECT " STRATA_COMMENT_COLUMNS STRATA_ASKED_COMMENTS
                                 " AND c.id > $7 ORDER BY c.id LIMIT $5 OFFSET $6",
                                 Params()
                                     .id(model_id)
                                     .optional_text(state)
                                     .optional_text(query.since)
                                     .array(visibilities_seen_by(seen_by))
                                     .integer(query.limit)
                                     .integer(query.offset)
                                     .integer(query.after));
    return page_of(std::move(total), std::move(rows));
  });
}

Result<Comments::Page> Comments::replies(CommentId thread, Role seen_by, int limit, int offset,
                                         std::int64_t after) {
  return pool_.read([&](PgConnection& connection) -> Result<Page> {
    auto first = load_thread(connection, thread, Lock::none);
    if (first && !sees(seen_by, first->visibility)) return no_such("comment", to_string(thread));
    if (!first) return tl::unexpected(first.error());
    auto total =
        connection.query("SELECT count(*) FROM comments WHERE thread_id = $1", Params().id(thread));
    auto rows = connection.query(
        "SELECT " STRATA_COMMENT_COLUMNS
        " FROM comments c WHERE thread_id = $1 AND c.id > $4 ORDER BY c.id LIMIT $2 OFFSET $3",
        Params().id(thread).integer(limit).integer(offset).integer(after));
    return page_of(std::move(total), std::move(rows));
  });
}

Result<Comment> Comments::comment(CommentId id, Role seen_by) {
  auto found =
      pool_.read([&](PgConnection& connection) { return load(connection, id, Lock::none); });
  if (found && !sees(seen_by, found->visibility)) return no_such("comment", to_string(id));
  return found;
}

Result<Comment> Comments::create(const Comment& comment,
                                 const IdempotentResponse<Comment>& answer) {
  STRATA_TRY(check_words(comment.text));
  STRATA_TRY(check_text(comment.user, "user"));
  return change(pool_, answer, [&](PgConnection& connection) -> Result<Comment> {
    ModelId model_id = comment.model_id;
    if (comment.thread) {
      auto first = STRATA_TRY(load_thread(connection, *comment.thread, Lock::keep));
      model_id = first.model_id;
    }
    // Locked, so that of two at once the later one counts the earlier.
    auto model = STRATA_TRY(connection.query("SELECT 1 FROM models WHERE id = $1 FOR NO KEY UPDATE",
                                             Params().id(model_id)));
    if (model.rows() == 0) return no_such("model", to_string(model_id));
    auto count = STRATA_TRY(connection.query("SELECT count(*) FROM comments WHERE model_id = $1",
                                             Params().id(model_id)));
    if (count.integer(0, 0) >= kMaxComments)
      return fail(ErrorCode::conflict, "Too many comments",
                  "A model holds at most " + std::to_string(kMaxComments) +
                      " comments. Delete some first.");
    PgArray position(oid::kFloat8), normal(oid::kFloat8);
    if (comment.place) {
      position = array_of(comment.place->position);
      normal = array_of(comment.place->normal);
    }
    auto row = STRATA_TRY(connection.query(
        "INSERT INTO comments AS c (model_id, thread_id, position, normal, layer_id, table_id, record_key, text, user_name) "
        "VALUES ($1, $2, nullif($3, '{}'), nullif($4, '{}'), $5, $6, $7, $8, $9) RETURNING " STRATA_COMMENT_COLUMNS,
        Params()
            .id(model_id)
            .optional_id(comment.thread)
            .array(position)
            .array(normal)
            .optional_id(comment.layer_id)
            .optional_id(comment.table_id)
            .optional_integer(comment.record)
            .text(comment.text)
            .text(comment.user)));
    return read_comment(row, 0);
  });
}

Result<Comment> Comments::update(const Comment& comment,
                                 const IdempotentResponse<Comment>& answer) {
  if (!comment.deleted) STRATA_TRY(check_words(comment.text));
  const auto resolver = comment.resolved ? std::optional(comment.resolved->user) : std::nullopt;
  if (resolver) STRATA_TRY(check_text(*resolver, "user"));
  return change(pool_, answer, [&](PgConnection& connection) -> Result<Comment> {
    auto row = STRATA_TRY(connection.query(
        "UPDATE comments AS c SET text = $3, edited = CASE WHEN text = $3 THEN edited ELSE clock_timestamp() END, "
        "resolved = CASE WHEN $4::text IS NOT NULL THEN coalesce(resolved, clock_timestamp()) END, "
        "resolved_by = CASE WHEN $4 IS NOT NULL THEN coalesce(resolved_by, $4) END, "
        "changed = clock_timestamp(), version = version + 1 WHERE id = $1 AND version = $2 "
        "RETURNING " STRATA_COMMENT_COLUMNS,
        Params()
            .id(comment.id)
            .integer(comment.version)
            .text(comment.text)
            .optional_text(resolver)));
    if (row.rows() > 0) return read_comment(row, 0);
    STRATA_TRY(load(connection, comment.id, Lock::none));
    return stale("comment");
  });
}

Result<Comments::Removal> Comments::remove(const Comment& comment,
                                           const IdempotentResponse<Removal>& answer) {
  return change(pool_, answer, [&](PgConnection& connection) -> Result<Removal> {
    const CommentId thread = comment.thread.value_or(comment.id);
    auto first = load(connection, thread, Lock::change);
    if (!first) return tl::unexpected(first.error());
    auto now = STRATA_TRY(comment.thread ? load(connection, comment.id, Lock::change) : first);
    if (now.version != comment.version) return stale("comment");
    if (now.deleted)
      return fail(ErrorCode::conflict, "Deleted already",
                  "The comment was deleted; it stands there for its replies until they are.");
    auto others =
        connection.query("SELECT count(*) FROM comments WHERE thread_id = $1 AND id <> $2",
                         Params().id(thread).id(comment.id));
    if (!others) return tl::unexpected(others.error());
    const bool has_others = others->integer(0, 0) > 0;
    Removal removal{first->model_id, {}, {}};
    if (!comment.thread && has_others) {
      auto emptied = STRATA_TRY(connection.query(
          "UPDATE comments AS c SET text = '', edited = NULL, deleted = clock_timestamp(), "
          "changed = clock_timestamp(), version = version + 1 WHERE id = $1 RETURNING " STRATA_COMMENT_COLUMNS,
          Params().id(comment.id)));
      removal.left = read_comment(emptied, 0);
      return removal;
    }
    removal.gone.push_back(comment.id);
    if (comment.thread && first->deleted && !has_others) removal.gone.push_back(thread);
    for (const auto id : removal.gone)
      if (auto done = connection.query("DELETE FROM comments WHERE id = $1", Params().id(id));
          !done)
        return tl::unexpected(done.error());
    return removal;
  });
}

Result<void> rename_in_comments(PgConnection& connection, const std::string& name,
                                const std::string& former) {
  for (const char* sql : {"UPDATE comments SET user_name = $2 WHERE user_name = $1",
                          "UPDATE comments SET resolved_by = $2 WHERE resolved_by = $1",
                          "UPDATE comments SET text = " STRATA_CALL_RENAMED(
                              "text", "10000") " WHERE " STRATA_CALLS_THEM("text")})
    STRATA_TRY(connection.query(sql, Params().text(name).text(former)));
  return {};
}

}  // namespace strata::store
