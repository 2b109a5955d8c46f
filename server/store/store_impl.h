#pragma once

#include <atomic>
#include <mutex>

#include "core/ids.h"
#include "core/no_such.h"
#include "core/text/slug.h"
#include "store/content/answers.h"
#include "store/content/bills.h"
#include "store/content/comments.h"
#include "store/content/jobs.h"
#include "store/content/layers.h"
#include "store/content/metadata.h"
#include "store/content/models.h"
#include "store/content/named_parts.h"
#include "store/content/objects.h"
#include "store/content/photographs.h"
#include "store/content/projects.h"
#include "store/content/surface_images.h"
#include "store/content/tools.h"
#include "store/content/tour_files.h"
#include "store/content/trash.h"
#include "store/files/files.h"
#include "store/journal/journal_reads.h"
#include "store/nodes/nodes.h"
#include "store/people/accounts.h"
#include "store/people/audit.h"
#include "store/people/groups.h"
#include "store/people/kiosks.h"
#include "store/people/members.h"
#include "store/people/personal_views.h"
#include "store/people/sign_ons.h"
#include "store/people/tokens.h"
#include "store/pg/blobs.h"
#include "store/pg/pool.h"
#include "store/pg/sql.h"
#include "store/store.h"
#include "store/tables/attachments.h"
#include "store/tables/records.h"
#include "store/tables/tables.h"

namespace strata::store {

// Stores a response in the current transaction. Returns a `conflict` error if there is already a
// response with this key.
Result<void> insert_answer(PgConnection& connection, const std::string& key,
                           const nlohmann::json& answer);

// Marks the job as done, with this result, in the current transaction.
Result<void> finish_job(PgConnection& connection, JobId job, nlohmann::json result);

// Sets the author of the changes in the current transaction, for the activity
// (db/migrations/000018_activity.sql). An empty name means no author.
Result<void> act_as(PgConnection& connection, const std::string& user);

// Rename a deleted user in the current transaction. $1 of the SQL is the name, and $2 the name that
// replaces it.
Result<void> rename_in_activity(PgConnection& connection, const std::string& name,
                                const std::string& former);
Result<void> rename_in_journal(PgConnection& connection, const std::string& name,
                               const std::string& former);
// Return SQL for texts that may mention the user with @: a condition, and the text with the new
// name. Case is ignored, as in names. A mention is not part of a longer name or of an email
// address.
consteval auto mentions_them(const auto& text) {
  return sql("position('@' || lower($1) IN lower(", text, ")) > 0");
}
consteval auto mention_renamed(const auto& text, const auto& longest) {
  return sql("left(regexp_replace(", text,
             ", '(^|[^A-Za-z0-9._@-])@' || replace($1, '.', '\\.') || "
             "'(?![A-Za-z0-9_@-]|\\.[A-Za-z0-9])', '\\1@' || $2, 'gi'), ",
             longest, ")");
}

// Locks the user in the current transaction, so that facts that were read about the user stay true
// until the commit.
Result<Person> lock_person(PgConnection& connection, const std::string& name);
// Opens a session for the user, who must be locked. At the limit, it replaces the oldest session.
Result<NewToken> open_session(PgConnection& connection, const Person& person,
                              std::optional<std::chrono::seconds> lifetime,
                              const std::string& label);
Result<void> lock_project(PgConnection& connection, ProjectId id);  // prevents its deletion
// Returns the object with this name, ignoring case. Creates the object if the project has none.
Result<ObjectId> object_named(PgConnection& connection, ProjectId project_id,
                              const std::string& name);
// Locks the object of the model. Returns an `invalid` error if the model's project does not have
// the object, and a `conflict` error if the object has too many other models.
Result<void> check_object(PgConnection& connection, const Model& model);
Result<void> join_groups(PgConnection& connection, PersonId person_id,
                         const std::vector<GroupId>& groups);

Result<void> check_project_role(Role role);  // `invalid` if it is not a project role

template <class T>
Result<void> keep(PgConnection& connection, const IdempotentResponse<T>& answer,
                  const Result<T>& effect) {
  if (answer.job != 0) STRATA_TRY(finish_job(connection, answer.job, answer.make(*effect)));
  return answer.key.empty() ? Result<void>{}
                            : insert_answer(connection, answer.key, answer.make(*effect));
}
inline Result<void> keep(PgConnection& connection, const IdempotentResponse<>& answer,
                         const Result<void>&) {
  return answer.key.empty() ? Result<void>{} : insert_answer(connection, answer.key, answer.make());
}

// Runs a transaction that also stores the response for the caller.
template <class Answer, class Work>
auto change(Pool& pool, const Answer& answer, Work&& work, const PgLimits& limits = kRequestLimits)
    -> std::invoke_result_t<Work, PgConnection&> {
  return pool.write_within(limits, [&](PgConnection& connection) {
    if (auto named = act_as(connection, answer.user); !named)
      return std::invoke_result_t<Work, PgConnection&>(tl::unexpected(named.error()));
    auto effect = work(connection);
    if (effect)
      if (auto saved = keep(connection, answer, effect); !saved)
        effect = tl::unexpected(saved.error());
    return effect;
  });
}

struct Store::Impl {
  Impl(StoreOptions given)
      : options(std::move(given)),
        pool(options.dsn, options.connections, options.limits, options.slot_for) {}
  const StoreOptions options;
  Pool pool;
  Blobs blobs{pool};
  Files files{pool, blobs};
  Comments comments{pool};
  NamedParts views{pool, NamedParts::kViews}, tours{pool, NamedParts::kTours};
  Kiosks kiosks{pool};
  TourFiles tour_files{pool, blobs};
  Photographs photographs{pool, blobs};
  Jobs jobs{pool};
  Nodes nodes{pool};
  Groups groups{pool};
  SignOns sign_ons{pool};
  Trash trash{pool};
  Audit audit{pool};
  Projects projects{pool};
  Models models{pool, blobs};
  Metadata metadata{pool};
  Objects objects{pool};
  Bills bills{pool};
  SurfaceImages images{pool, blobs};
  Layers layers{pool};
  Tables tables{pool};
  Records records{pool};
  Attachments attachments{pool, blobs};
  Journal journal{pool};
  Accounts accounts{pool};
  Members members{pool};
  Tokens tokens{pool};
  PersonalViews personal_views{pool};
  Tools tools{pool};
  Answers answers{pool};
  std::int64_t schema_version = 0, readable_from = 0;
  NamedParts snapshots{pool, NamedParts::kSnapshots};
  NamedParts selections{pool, NamedParts::kSelections};

  template <class Answer, class Work>
  auto change(const Answer& answer, Work&& work, const PgLimits& limits = kRequestLimits)
      -> std::invoke_result_t<Work, PgConnection&> {
    return store::change(pool, answer, std::forward<Work>(work), limits);
  }

  // A separate connection, so that a busy pool does not look like an unreachable database.
  std::mutex probe_mutex;
  std::optional<PgConnection> probe;
  std::atomic<bool> was_ready = true;
};

// Erase an object with everything that depends on it, in the current transaction. The object may be
// in the Trash or not (store/content/trash.cpp).
Result<void> erase_layer(PgConnection& connection, LayerId id);
Result<void> erase_model(PgConnection& connection, ModelId id);

// Returns the visibilities that the role sees, for `= any($n)`.
PgArray visibilities_seen_by(Role role);

inline constexpr std::size_t kMaxNameLength = 255;

inline tl::unexpected<Error> stale(std::string_view kind) {
  return fail(ErrorCode::stale, "Changed by somebody else",
              "The " + std::string(kind) +
                  " was changed since you read it. Read it again and repeat your change.",
              "version");
}

// Checks that the name has 1 to 255 bytes of text that PostgreSQL can store.
Result<void> check_name(const std::string& name);
Result<void> check_texts(std::initializer_list<std::pair<const std::string*, const char*>> texts);
// Refuses JSON whose strings PostgreSQL cannot store.
Result<void> check_json(const nlohmann::json& json, const std::string& field);

// Returns the id for a reference in digits, and nothing for a slug. Returns 0, which no row has,
// for more than 18 digits.
std::optional<std::int64_t> number_of(const std::string& ref);
template <class Id>
std::optional<Id> id_of(const std::string& ref) {
  const auto number = number_of(ref);
  return number ? std::optional(Id(*number)) : std::nullopt;
}

// Returns the first of `requested`, `requested-2`, `requested-3`… that is not in `taken` (one text
// column).
std::string free_slug(const std::string& requested, const PgResult& taken);

// Inserts a row with a free slug. `taken_sql` selects the used slugs that begin with the requested
// slug ($1 is the LIKE pattern, $2 the parent, if any). `insert` runs an INSERT … ON CONFLICT DO
// NOTHING RETURNING …. If it returns no row, another transaction took the slug first, and the next
// slug is tried.
Result<PgResult> insert_with_slug(
    PgConnection& connection, const char* taken_sql, std::optional<std::int64_t> parent,
    const std::string& requested,
    const std::function<Result<PgResult>(const std::string&)>& insert);

}  // namespace strata::store
