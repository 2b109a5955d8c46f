#pragma once

#include <chrono>
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/ids.h"
#include "domain/people/visibility.h"
#include "store/content/idempotent_response.h"

namespace strata::store {

class PgConnection;
class Pool;

// A comment on a model: the first comment of a thread, at a place on the surface, or a reply in a
// thread.
struct Comment {
  struct Place {
    glm::dvec3 position{0}, normal{0};  // world, model's unit
  };
  struct Resolution {
    std::string user;
    std::chrono::system_clock::time_point time;
  };
  CommentId id = 0;
  ModelId model_id = 0;
  // of a reply: id of the first comment of the thread, which has:
  std::optional<CommentId> thread;
  std::optional<Place> place;  // always
  // the subject; `record` is a key of the table
  std::optional<LayerId> layer_id;
  std::optional<TableId> table_id;
  std::optional<std::int64_t> record;
  std::optional<Resolution> resolved;  // nothing: open
  std::string text;  // plain, UTF-8, at most 10 000 characters; empty if it was deleted
  std::string user;  // the author
  std::chrono::system_clock::time_point time;
  std::optional<std::chrono::system_clock::time_point> edited;  // time of the last change of its
                                                                // text
  bool deleted = false;                                         // kept without its text, because it
                                                                // has replies
  std::int64_t version = 1;
  // of the layer that its thread is about; of a deleted layer, its last one
  Visibility visibility = Visibility::everyone;
};

// Threads of comments. Part of Store: thread-safe and blocking as Store is, with the same errors
// for missing, stale or unreachable data.
class Comments {
 public:
  static constexpr std::int64_t kMaxComments = 10'000;  // of a model, including replies

  explicit Comments(Pool& pool) : pool_(pool) {}

  struct Query {
    std::optional<bool> resolved;  // only of resolved threads, or only of open ones
    // only comments changed at or after this time (the text of core/text/timestamp.h)
    std::optional<std::string> since;
    int limit = 100, offset = 0;
    std::int64_t after = 0;  // only those with higher ids
  };
  struct Page {
    std::vector<Comment> comments;  // by id
    std::int64_t total = 0;
  };
  // Returns the comments that the role sees; a comment that it does not see is not_found.
  Result<Page> of_model(ModelId model_id, Role seen_by, const Query& query);
  // invalid: the comment is a reply.
  Result<Page> replies(CommentId thread, Role seen_by, int limit, int offset,
                       std::int64_t after = 0);
  Result<Comment> comment(CommentId id, Role seen_by);

  // The store sets id, times and version, and, for a reply, the model of its thread. Refused: text
  // that is blank or too long (invalid), a reply to a reply (invalid), too many comments
  // (conflict).
  Result<Comment> create(const Comment& comment, const IdempotentResponse<Comment>& answer = {});
  // Changes the text and the resolution if the version equals. A thread that is already resolved
  // keeps the user who resolved it first.
  Result<Comment> update(const Comment& comment, const IdempotentResponse<Comment>& answer = {});
  // The effect on a thread of deleting one of its comments: the comments that are erased, and the
  // first comment if it stays without its text.
  struct Removal {
    ModelId model_id = 0;
    std::vector<CommentId> gone;
    std::optional<Comment> left;
  };
  // Deletes the comment if the version equals. conflict: it is deleted already and kept for its
  // replies.
  Result<Removal> remove(const Comment& comment, const IdempotentResponse<Removal>& answer = {});

 private:
  Pool& pool_;
};

// Part of deleting a user: makes `former` the author of their comments and resolutions, and
// replaces their name after an @.
Result<void> rename_in_comments(PgConnection& connection, const std::string& name,
                                const std::string& former);

}  // namespace strata::store
