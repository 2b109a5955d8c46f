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

// What somebody wrote on a model: the first comment of a thread, at a place of the surface, or a
// reply in one.
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
  // of a reply: id of the thread's first comment, which has:
  std::optional<CommentId> thread;
  std::optional<Place> place;  // always
  // what it is about; `record` is a key of the table
  std::optional<LayerId> layer_id;
  std::optional<TableId> table_id;
  std::optional<std::int64_t> record;
  std::optional<Resolution> resolved;  // nothing: open
  std::string text;  // plain, UTF-8, at most 10 000 characters; empty where it was deleted
  std::string user;  // who wrote it
  std::chrono::system_clock::time_point time;
  std::optional<std::chrono::system_clock::time_point> edited;  // its text
  bool deleted = false;                                         // stands there for its replies
  std::int64_t version = 1;
  // of the layer that its thread is about, or was when that was deleted
  Visibility visibility = Visibility::everyone;
};

// Threads of comments; of a Store, and as thread-safe and blocking as that, with the same Problems
// for what is not there, stale or away.
class Comments {
 public:
  static constexpr std::int64_t kMaxComments = 10'000;  // of a model, replies and all

  explicit Comments(Pool& pool) : pool_(pool) {}

  struct Query {
    std::optional<bool> resolved;  // only of threads that are, or are not
    // only what was changed then or later (core/text/timestamp.h's text)
    std::optional<std::string> since;
    int limit = 100, offset = 0;
    std::int64_t after = 0;  // only those with higher ids
  };
  struct Page {
    std::vector<Comment> comments;  // by id
    std::int64_t total = 0;
  };
  // Those that the role sees; one that it does not see is not found.
  Result<Page> of_model(ModelId model_id, Role seen_by, const Query& query);
  // invalid: the comment is a reply itself.
  Result<Page> replies(CommentId thread, Role seen_by, int limit, int offset,
                       std::int64_t after = 0);
  Result<Comment> comment(CommentId id, Role seen_by);

  // Id, times and version are given here; of a reply the model is that of its thread. Refused: text
  // that is blank or too long (invalid), a reply to a reply (invalid), one comment too many
  // (conflict).
  Result<Comment> create(const Comment& comment, const IdempotentResponse<Comment>& answer = {});
  // Text, and who has resolved it, where version equals; what it was resolved for already stays
  // with who did it first.
  Result<Comment> update(const Comment& comment, const IdempotentResponse<Comment>& answer = {});
  // What became of a thread when one of its comments was deleted: those that are gone, and the
  // first one where it stays without its text.
  struct Removal {
    ModelId model_id = 0;
    std::vector<CommentId> gone;
    std::optional<Comment> left;
  };
  // Where version equals. conflict: it is deleted and stands there for its replies.
  Result<Removal> remove(const Comment& comment, const IdempotentResponse<Removal>& answer = {});

 private:
  Pool& pool_;
};

// Within the deletion of a person: they wrote and resolved as `former`, which also takes the place
// of their name behind an @.
Result<void> rename_in_comments(PgConnection& connection, const std::string& name,
                                const std::string& former);

}  // namespace strata::store
