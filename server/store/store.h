#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

#include "core/error.h"
#include "store/pg/pg_limits.h"

namespace strata::store {

class Accounts;
class Answers;
class Attachments;
class Trash;
class Comments;
class Groups;
class Jobs;
class Journal;
class Kiosks;
class Layers;
class SurfaceImages;
class Members;
class Models;
class NamedParts;
class PersonalViews;
class Projects;
class Records;
class Tables;
class Tokens;
class Tools;

struct StoreOptions {
  std::string dsn;      // libpq connection string
  int connections = 8;  // pooled, for everything but the journal writer
  PgLimits limits = kRequestLimits;
  std::chrono::milliseconds slot_for{10'000};  // longest wait for one of the pool
};

struct StoreInfo {
  std::string server_version;
  std::int64_t schema_version = 0;
  std::uint64_t database_bytes = 0;
};

// Everything durable. All calls block the calling thread, are thread-safe and take a connection
// from the pool; when the database is away they return an Error unavailable ("Database
// unavailable") after trying to reconnect. Constraint failures are an Error conflict, unknown ids
// not_found, a stale `version` `stale`. Changes keep the caller's answer with them
// (IdempotentResponse).
class Store {
 public:
  // Connects and applies the missing migrations of `migrations_dir`; a newer schema than known is
  // refused.
  static Result<std::unique_ptr<Store>> open(StoreOptions options,
                                             const std::filesystem::path& migrations_dir);
  ~Store();

  Result<StoreInfo> info();
  // One round trip, of 2 seconds at most (4 where it must connect first); while another thread
  // asks, the last answer.
  bool ready();

  // The parts, each with a header of its own: store/content/projects.h has Projects. They live as
  // long as this.
  Projects& projects();
  Models& models();
  SurfaceImages& surface_images();
  Layers& layers();
  Tables& tables();
  Records& records();
  Attachments& attachments();
  Journal& journal();  // store/journal/journal_reads.h
  Accounts& accounts();
  Members& members();
  Tokens& tokens();
  PersonalViews& personal_views();
  Tools& tools();
  Answers& answers();
  Comments& comments();
  NamedParts& views();  // of models (store/content/named_parts.h)
  NamedParts& tours();  // the same
  Jobs& jobs();
  Kiosks& kiosks();
  Groups& groups();
  Trash& trash();

 private:
  Store();
  friend class JournalWriter;
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace strata::store
