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
class TourFiles;
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
  int connections = 8;  // pooled, for everything except the journal writer
  PgLimits limits = kRequestLimits;
  std::chrono::milliseconds slot_for{10'000};  // longest wait for a connection of the pool
};

struct StoreInfo {
  std::string server_version;
  std::int64_t schema_version = 0;
  std::uint64_t database_bytes = 0;
};

// All durable data. All calls block the calling thread, are thread-safe and take a connection from
// the pool; when the database is unreachable they return an Error unavailable ("Database
// unavailable") after trying to reconnect. Constraint failures are an Error conflict, unknown ids
// not_found, a stale `version` `stale`. A change stores the caller's answer in the same transaction
// (IdempotentResponse).
class Store {
 public:
  // Connects and applies the missing migrations of `migrations_dir`; refuses a schema that is newer
  // than the known one.
  static Result<std::unique_ptr<Store>> open(StoreOptions options,
                                             const std::filesystem::path& migrations_dir);
  ~Store();

  Result<StoreInfo> info();
  // Makes one round trip, of at most 2 seconds (4 if it must connect first); while another thread
  // makes it, returns the last answer.
  bool ready();

  // The parts, each with a separate header: store/content/projects.h declares Projects. They live
  // as long as the store.
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
  NamedParts& snapshots();
  Jobs& jobs();
  Kiosks& kiosks();
  TourFiles& tour_files();
  Groups& groups();
  Trash& trash();

 private:
  Store();
  friend class JournalWriter;
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace strata::store
