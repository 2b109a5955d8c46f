#pragma once

#include <atomic>
#include <mutex>

#include "core/ids.h"
#include "core/no_such.h"
#include "core/text/slug.h"
#include "store/content/answers.h"
#include "store/content/comments.h"
#include "store/content/jobs.h"
#include "store/content/layers.h"
#include "store/content/models.h"
#include "store/content/named_parts.h"
#include "store/content/projects.h"
#include "store/content/surface_images.h"
#include "store/content/tools.h"
#include "store/content/trash.h"
#include "store/journal/journal_reads.h"
#include "store/people/accounts.h"
#include "store/people/groups.h"
#include "store/people/kiosks.h"
#include "store/people/members.h"
#include "store/people/personal_views.h"
#include "store/people/tokens.h"
#include "store/pg/pool.h"
#include "store/pg/sql.h"
#include "store/store.h"
#include "store/tables/attachments.h"
#include "store/tables/records.h"
#include "store/tables/tables.h"

namespace strata::store {

// In the transaction at hand; `conflict` where a call with this key was answered already.
Result<void> insert_answer(PgConnection& connection, const std::string& key,
                           const nlohmann::json& answer);

// In the transaction at hand: the job ended well, with that as its result.
Result<void> finish_job(PgConnection& connection, JobId job, nlohmann::json result);

// In the transaction at hand: what it changes is told as this person's doing
// (db/migrations/000018_activity.sql). Empty: as nobody's.
Result<void> act_as(PgConnection& connection, const std::string& user);

// Of somebody who is deleted, in the transaction at hand: $1 and $2 of the SQL are the name and the
// one that stands for it from now on.
Result<void> rename_in_activity(PgConnection& connection, const std::string& name,
                                const std::string& former);
Result<void> rename_in_journal(PgConnection& connection, const std::string& name,
                               const std::string& former);
// Texts that may call them with @: in any case, as names are, and where no longer name and no
// address of a mail begins or ends there.
consteval auto mentions_them(const auto& text) {
  return sql("position('@' || lower($1) IN lower(", text, ")) > 0");
}
consteval auto mention_renamed(const auto& text, const auto& longest) {
  return sql("left(regexp_replace(", text,
             ", '(^|[^A-Za-z0-9._@-])@' || replace($1, '.', '\\.') || "
             "'(?![A-Za-z0-9_@-]|\\.[A-Za-z0-9])', '\\1@' || $2, 'gi'), ",
             longest, ")");
}

// In the transaction at hand: what is said of them holds until it is written.
Result<Person> lock_person(PgConnection& connection, const std::string& name);
Result<void> lock_project(PgConnection& connection, ProjectId id);  // against its being deleted
Result<void> join_groups(PgConnection& connection, PersonId person_id,
                         const std::vector<GroupId>& groups);

Result<void> check_project_role(Role role);  // invalid: not one that is given in projects

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

// A transaction that also keeps the answer to who asked for it.
template <class Answer, class Work>
auto change(Pool& pool, const Answer& answer, Work&& work, const PgLimits& limits = kRequestLimits)
    -> std::invoke_result_t<Work, PgConnection&> {
  return pool.write_within(limits, [&](PgConnection& connection) {
    if (auto named = act_as(connection, answer.user); !named)
      return std::invoke_result_t<Work, PgConnection&>(tl::unexpected(named.error()));
    auto effect = work(connection);
    if (effect)
      if (auto kept = keep(connection, answer, effect); !kept)
        effect = tl::unexpected(kept.error());
    return effect;
  });
}

struct Store::Impl {
  Impl(StoreOptions given)
      : options(std::move(given)),
        pool(options.dsn, options.connections, options.limits, options.slot_for) {}
  const StoreOptions options;
  Pool pool;
  Comments comments{pool};
  NamedParts views{pool, NamedParts::kViews}, tours{pool, NamedParts::kTours};
  Kiosks kiosks{pool};
  Jobs jobs{pool};
  Groups groups{pool};
  Trash trash{pool};
  Projects projects{pool};
  Models models{pool};
  SurfaceImages images{pool};
  Layers layers{pool};
  Tables tables{pool};
  Records records{pool};
  Attachments attachments{pool};
  Journal journal{pool};
  Accounts accounts{pool};
  Members members{pool};
  Tokens tokens{pool};
  PersonalViews personal_views{pool};
  Tools tools{pool};
  Answers answers{pool};
  std::int64_t schema_version = 0;

  template <class Answer, class Work>
  auto change(const Answer& answer, Work&& work, const PgLimits& limits = kRequestLimits)
      -> std::invoke_result_t<Work, PgConnection&> {
    return store::change(pool, answer, std::forward<Work>(work), limits);
  }

  // Of its own, so that a busy pool is not taken for a database that is away.
  std::mutex probe_mutex;
  std::optional<PgConnection> probe;
  std::atomic<bool> was_ready = true;
};

// With all that hangs on it, in the transaction at hand, in the Trash or not
// (store/content/bin.cpp).
Result<void> erase_layer(PgConnection& connection, LayerId id);
Result<void> erase_model(PgConnection& connection, ModelId id);

// Of what the role sees, for `= any($n)`.
PgArray visibilities_seen_by(Role role);

inline constexpr std::size_t kMaxNameLength = 255;

inline tl::unexpected<Error> stale(std::string_view kind) {
  return fail(ErrorCode::stale, "Changed meanwhile",
              "The " + std::string(kind) +
                  " was changed since you read it. Read it again and repeat your change.",
              "version");
}

// 1…255 bytes of storable text.
Result<void> check_name(const std::string& name);
Result<void> check_texts(std::initializer_list<std::pair<const std::string*, const char*>> texts);
// Refuses JSON whose strings PostgreSQL cannot keep.
Result<void> check_json(const nlohmann::json& json, const std::string& field);

// An id for a reference in digits; nothing for a slug, and 0 (no row has it) for digits beyond 64
// bits.
std::optional<std::int64_t> number_of(const std::string& ref);
template <class Id>
std::optional<Id> id_of(const std::string& ref) {
  const auto number = number_of(ref);
  return number ? std::optional(Id(*number)) : std::nullopt;
}

// `wished`, or `wished-2`, `wished-3`… that `taken` (one text column) does not list.
std::string free_slug(const std::string& wished, const PgResult& taken);

// Inserts with a free slug. `taken_sql` lists the slugs in use that start with the wished one ($1 =
// like pattern, $2 = parent if any); `insert` runs an INSERT … ON CONFLICT DO NOTHING RETURNING …:
// no row means that another one took the slug meanwhile, and the next is tried.
Result<PgResult> insert_with_slug(
    PgConnection& connection, const char* taken_sql, std::optional<std::int64_t> parent,
    const std::string& wished, const std::function<Result<PgResult>(const std::string&)>& insert);

}  // namespace strata::store
