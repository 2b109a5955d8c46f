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

// A comment on a model: the first comment of a thread, at a point on the surface, or a reply in a
// thread.
struct Comment {
  struct Place {
    glm::dvec3 position{0}, normal{0};  // world coordinates, in model units
  };
  struct Resolution {
    std::string user;
    std::chrono::system_clock::time_point time;
  };
  CommentId id = 0;
  ModelId model_id = 0;
  std::optional<CommentId> thread;  // for a reply: id of the first comment of the thread
  // The fields up to `resolved` belong to the first comment, which always has a place.
  std::optional<Place> place;
  // the subject; `record` is a key in the table
  std::optional<LayerId> layer_id;
  std::optional<TableId> table_id;
  std::optional<std::int64_t> record;
  std::optional<Resolution> resolved;  // nothing if the thread is open
  std::string text;  // plain, UTF-8, at most 10 000 characters; empty if it was deleted
  std::string user;  // the author
  std::chrono::system_clock::time_point time;
  std::optional<std::chrono::system_clock::time_point> edited;  // last change to the text
  bool deleted = false;  // kept without its text because of its replies
  std::int64_t version = 1;
  // visibility of the layer of the thread; for a deleted layer, its last visibility
  Visibility visibility = Visibility::everyone;
};

// Threads of comments. Part of Store, whose rules for threads and errors apply.
class Comments {
 public:
  static constexpr std::int64_t kMaxComments = 10'000;  // per model, including replies

  explicit Comments(Pool& pool) : pool_(pool) {}

  struct Query {
    std::optional<bool> resolved;  // only of resolved threads, or only of open threads
    // only comments changed at or after this time (text as in core/text/timestamp.h)
    std::optional<std::string> since;
    int limit = 100, offset = 0;
    std::int64_t after = 0;  // only comments with higher ids
  };
  struct Page {
    std::vector<Comment> comments;  // sorted by id
    std::int64_t total = 0;
  };
  // Returns the comments that the role sees. A comment that the role does not see is `not_found`.
  Result<Page> of_model(ModelId model_id, Role seen_by, const Query& query);
  // Returns an `invalid` error if `thread` is a reply.
  Result<Page> replies(CommentId thread, Role seen_by, int limit, int offset,
                       std::int64_t after = 0);
  Result<Comment> comment(CommentId id, Role seen_by);

  // Creates a comment. The store sets id, times and version, and, for a reply, the model of its
  // thread. Returns an `invalid` error for a text that is blank or too long, and for a reply to a
  // reply. Returns a `conflict` error for too many comments.
  Result<Comment> create(const Comment& comment, const IdempotentResponse<Comment>& answer = {});
  // Changes the text and the resolution if `comment.version` is the current version. A thread that
  // is already resolved keeps the user who resolved it first.
  Result<Comment> update(const Comment& comment, const IdempotentResponse<Comment>& answer = {});
  // The effect on a thread of deleting one of its comments: the comments that are erased, and the
  // first comment if it stays without its text.
  struct Removal {
    ModelId model_id = 0;
    std::vector<CommentId> gone;
    std::optional<Comment> left;
  };
  // Deletes the comment if `comment.version` is the current version. Returns a `conflict` error if
  // the comment is already deleted and kept for its replies.
  Result<Removal> remove(const Comment& comment, const IdempotentResponse<Removal>& answer = {});

 private:
  Pool& pool_;
};

// Part of the deletion of a user: makes `former` the author of the user's comments and resolutions,
// and replaces the user's name after an @.
Result<void> rename_in_comments(PgConnection& connection, const std::string& name,
                                const std::string& former);

}  // namespace strata::store
