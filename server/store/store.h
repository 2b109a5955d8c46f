#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

#include "core/error.h"
#include "store/files/files_place.h"
#include "store/pg/pg_limits.h"

namespace strata::store {

class Accounts;
class Answers;
class Attachments;
class Trash;
class Audit;
class Comments;
class Files;
class Groups;
class Jobs;
class Journal;
class Kiosks;
class TourFiles;
class Layers;
class SurfaceImages;
class Members;
class Metadata;
class Models;
class NamedParts;
class Nodes;
class Objects;
class Bills;
class PersonalViews;
class Photographs;
class Projects;
class Records;
class SignOns;
class Tables;
class Tokens;
class Tools;

struct StoreOptions {
  std::string dsn;      // libpq connection string
  int connections = 8;  // size of the pool, which all parts except the journal writer use
  PgLimits limits = kRequestLimits;
  std::chrono::milliseconds slot_for{10'000};  // longest wait for a connection from the pool
  FilesPlace files{};                          // the place of new large content
};

struct StoreInfo {
  std::string server_version;
  std::int64_t schema_version = 0;  // the newest migration of the database
  // Programs whose newest migration is this one, or a later one, can use the database.
  std::int64_t readable_from = 0;
  std::uint64_t database_bytes = 0;
};

// All durable data. All calls block the calling thread, are thread-safe and take a connection from
// the pool. If the database is unreachable, they try to reconnect, and then return an `unavailable`
// error ("Database unavailable"). The error is `conflict` for a failed constraint, `not_found` for
// an unknown id, and `stale` for an outdated `version`. A change stores the response for the caller
// in the same transaction (IdempotentResponse).
class Store {
 public:
  // Connects and applies the missing migrations in `migrations_dir`. Returns an error if the schema
  // is newer than these migrations and not readable for them (store/cluster/migrations.h).
  static Result<std::unique_ptr<Store>> open(StoreOptions options,
                                             const std::filesystem::path& migrations_dir);
  ~Store();

  Result<StoreInfo> info();
  // Returns true if one round trip to the database succeeds, within 2 seconds, or 4 seconds if it
  // must connect first. Returns the last result while another thread makes the round trip.
  bool ready();

  // The parts of the store. Each has a separate header: store/content/projects.h declares Projects.
  // They exist as long as the store.
  Projects& projects();
  Models& models();
  Metadata& metadata();  // store/content/metadata.h
  Objects& objects();    // objects with surveys
  Bills& bills();        // of quantities
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
  NamedParts& views();  // saved views (store/content/named_parts.h)
  NamedParts& tours();  // tours (the same header)
  NamedParts& snapshots();
  NamedParts& selections();
  Jobs& jobs();
  Nodes& nodes();
  Kiosks& kiosks();
  TourFiles& tour_files();
  Photographs& photographs();  // store/content/photographs.h
  Groups& groups();
  Trash& trash();
  Audit& audit();       // store/people/audit.h
  SignOns& sign_ons();  // store/people/sign_ons.h
  Files& files();       // store/files/files.h

 private:
  Store();
  friend class JournalWriter;
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace strata::store
