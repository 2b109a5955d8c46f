#include "store/content/comments.h"

#include <algorithm>

#include "store/pg/pg_row.h"
#include "store/pg/sql.h"
#include "store/store_impl.h"

// A transaction that adds or removes a reply locks the first comment of the thread. A deletion
// checks whether the comment has replies, and the lock keeps the result true until the commit.

namespace strata::store {
namespace {

constexpr std::size_t kMaxTextLength = 10'000;  // characters

// A thread has the visibility of its layer, which may be in the Trash. The expression also works
// for a comment that the same statement has just made.
constexpr auto kCommentVisibility = sql(
    "CASE WHEN c.thread_id IS NULL THEN coalesce((SELECT visibility FROM all_layers WHERE id = c.layer_id), c.visibility) "
    "ELSE (SELECT coalesce(l.visibility, f.visibility) FROM comments f LEFT JOIN all_layers l ON l.id = f.layer_id "
    "WHERE f.id = c.thread_id) END");
// A layer in the Trash is not returned until it is restored.
constexpr auto kCommentLayer = sql("(SELECT id FROM layers WHERE id = c.layer_id) AS layer_id");
constexpr auto kCommentColumns = sql(
    "c.id, c.model_id, c.thread_id, c.position, c.normal, ", kCommentLayer,
    ", c.table_id, c.record_key, c.text, "
    "c.user_name, c.time, c.edited, c.deleted IS NOT NULL, c.resolved, c.resolved_by, c.version, ",
    kCommentVisibility);

glm::dvec3 point_of(const std::vector<double>& numbers) {
  return {numbers.at(0), numbers.at(1), numbers.at(2)};
}

Comment read_comment(const PgResult& rows, int i) {
  PgRow row(rows, i);
  Comment comment;
  comment.id = row.id<CommentId>();
  comment.model_id = row.id<ModelId>();
  comment.thread = row.id<std::optional<CommentId>>();
  const auto position = row.optional_reals(), normal = row.optional_reals();
  if (position && normal) comment.place = {point_of(*position), point_of(*normal)};
  comment.layer_id = row.id<std::optional<LayerId>>();
  comment.table_id = row.id<std::optional<TableId>>();
  const auto record = row.optional_integer();
  // A key has no meaning without its table, which may have been deleted.
  if (comment.table_id) comment.record = record;
  comment.text = row.text();
  comment.user = row.text();
  comment.time = row.time();
  comment.edited = row.optional_time();
  comment.deleted = row.boolean();
  const auto resolved = row.optional_time();
  const auto resolved_by = row.optional_text();
  if (resolved && resolved_by) comment.resolved = {*resolved_by, *resolved};
  comment.version = row.integer();
  // Replaces an unknown visibility by the most restricted one.
  comment.visibility = parse_visibility(row.text()).value_or(Visibility::curators);
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
    return fail(ErrorCode::invalid, "Text missing", "`text` is empty. Enter a text.", "text");
  const auto begins_character = [](char c) {
    return (static_cast<unsigned char>(c) & 0xc0) != 0x80;
  };
  if (static_cast<std::size_t>(std::ranges::count_if(text, begins_character)) > kMaxTextLength)
    return fail(ErrorCode::invalid, "Text too long",
                "`text` can have at most " + std::to_string(kMaxTextLength) + " characters.",
                "text");
  return {};
}

// Finds a comment of a model that is not in the Trash.
constexpr auto kComment =
    sql("FROM comments c WHERE id = $1 AND EXISTS (SELECT 1 FROM models WHERE id = c.model_id)");

// `keep`: the comment cannot change during this transaction
enum class Lock { none, keep, change };

Result<Comment> load(PgConnection& connection, CommentId id, Lock lock) {
  constexpr auto kRead = sql("SELECT ", kCommentColumns, " ", kComment);
  constexpr auto kKeep = sql(kRead, " FOR SHARE");
  constexpr auto kChange = sql(kRead, " FOR UPDATE");
  const char* statement = lock == Lock::none   ? kRead.c_str()
                          : lock == Lock::keep ? kKeep.c_str()
                                               : kChange.c_str();
  auto rows = STRATA_TRY(connection.query(statement, Params().id(id)));
  if (rows.rows() == 0) return no_such("comment", to_string(id));
  return read_comment(rows, 0);
}

Result<Comment> load_thread(PgConnection& connection, CommentId id, Lock lock) {
  auto first = load(connection, id, lock);
  if (first && first->thread)
    return fail(ErrorCode::invalid, "Cannot reply to a reply",
                "You can reply only to the first comment of a thread. Reply to comment " +
                    to_string(*first->thread) + ".");
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
  // Clients receive times in milliseconds, so `since` includes all changes in its millisecond.
  constexpr auto kMatchingComments = sql(
      " FROM comments c JOIN comments first ON first.id = coalesce(c.thread_id, c.id) WHERE c.model_id = $1"
      " AND ($2::text IS NULL OR ($2 = 'resolved') = (first.resolved IS NOT NULL))"
      " AND ($3::text IS NULL OR date_trunc('milliseconds', c.changed) >= $3::timestamptz)"
      " AND ",
      kCommentVisibility, " = any($4)");
  std::optional<std::string> state;
  if (query.resolved) state = *query.resolved ? "resolved" : "open";
  return pool_.read([&](PgConnection& connection) {
    auto total = connection.query(sql("SELECT count(*)", kMatchingComments),
                                  Params()
                                      .id(model_id)
                                      .optional_text(state)
                                      .optional_text(query.since)
                                      .array(visibilities_seen_by(seen_by)));
    auto rows = connection.query(sql("SELECT ", kCommentColumns, kMatchingComments,
                                     " AND c.id > $7 ORDER BY c.id LIMIT $5 OFFSET $6"),
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
        sql("SELECT ", kCommentColumns,
            " FROM comments c WHERE thread_id = $1 AND c.id > $4 ORDER BY c.id LIMIT $2 OFFSET $3"),
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
    // Lock the model, so that two concurrent transactions cannot exceed the limit of comments
    // together.
    auto model = STRATA_TRY(connection.query("SELECT 1 FROM models WHERE id = $1 FOR NO KEY UPDATE",
                                             Params().id(model_id)));
    if (model.rows() == 0) return no_such("model", to_string(model_id));
    auto count = STRATA_TRY(connection.query("SELECT count(*) FROM comments WHERE model_id = $1",
                                             Params().id(model_id)));
    if (count.integer(0, 0) >= kMaxComments)
      return fail(ErrorCode::conflict, "Too many comments",
                  "A model can have at most " + std::to_string(kMaxComments) +
                      " comments. Delete some comments first.");
    PgArray position(oid::kFloat8), normal(oid::kFloat8);
    if (comment.place) {
      position = array_of(comment.place->position);
      normal = array_of(comment.place->normal);
    }
    auto row = STRATA_TRY(connection.query(
        sql("INSERT INTO comments AS c (model_id, thread_id, position, normal, layer_id, table_id, record_key, text, user_name) "
            "VALUES ($1, $2, nullif($3, '{}'), nullif($4, '{}'), $5, $6, $7, $8, $9) RETURNING ",
            kCommentColumns),
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
        sql("UPDATE comments AS c SET text = $3, edited = CASE WHEN text = $3 THEN edited ELSE clock_timestamp() END, "
            "resolved = CASE WHEN $4::text IS NOT NULL THEN coalesce(resolved, clock_timestamp()) END, "
            "resolved_by = CASE WHEN $4 IS NOT NULL THEN coalesce(resolved_by, $4) END, "
            "changed = clock_timestamp(), version = version + 1 WHERE id = $1 AND version = $2 "
            "RETURNING ",
            kCommentColumns),
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
      return fail(
          ErrorCode::conflict, "Already deleted",
          "Somebody deleted this comment. It disappears when its replies are also deleted.");
    auto others =
        connection.query("SELECT count(*) FROM comments WHERE thread_id = $1 AND id <> $2",
                         Params().id(thread).id(comment.id));
    if (!others) return tl::unexpected(others.error());
    const bool has_others = others->integer(0, 0) > 0;
    Removal removal{first->model_id, {}, {}};
    if (!comment.thread && has_others) {
      auto emptied = STRATA_TRY(connection.query(
          sql("UPDATE comments AS c SET text = '', edited = NULL, deleted = clock_timestamp(), "
              "changed = clock_timestamp(), version = version + 1 WHERE id = $1 RETURNING ",
              kCommentColumns),
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
  constexpr auto kTexts = sql("UPDATE comments SET text = ", mention_renamed("text", "10000"),
                              " WHERE ", mentions_them("text"));
  for (const char* statement :
       {"UPDATE comments SET user_name = $2 WHERE user_name = $1",
        "UPDATE comments SET resolved_by = $2 WHERE resolved_by = $1", kTexts.c_str()})
    STRATA_TRY(connection.query(statement, Params().text(name).text(former)));
  return {};
}

}  // namespace strata::store
