#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.h"
#include "core/ids.h"

namespace strata::store {

class Pool;

// All actions of the audit log. The database has the same list (db/migrations/000042_audit.sql).
constexpr std::array<std::string_view, 28> kAuditActions{"sign_in",         "sign_in_failed",
                                                         "sign_out",        "password_changed",
                                                         "account_created", "account_deleted",
                                                         "account_renamed", "account_disabled",
                                                         "account_enabled", "role_changed",
                                                         "member_added",    "member_removed",
                                                         "group_created",   "group_renamed",
                                                         "token_created",   "token_revoked",
                                                         "link_created",    "export",
                                                         "deletion",        "erased",
                                                         "restored",        "visibility_changed",
                                                         "kiosk_created",   "kiosk_changed",
                                                         "kiosk_deleted",   "setting_changed",
                                                         "oidc_bound",      "audit_purged"};

// A row of the audit log. The names are from the time of the action.
struct AuditRow {
  std::int64_t id = 0;
  std::chrono::system_clock::time_point time;
  std::string actor_kind;          // "person", "token", "kiosk", "link" or "server"
  std::string actor;               // empty for the server
  std::optional<PersonId> person;  // the account may be deleted
  std::string address;             // empty if no client caused the action
  std::string action;
  std::string subject_kind;  // "person", "layer", "kiosk", …
  std::optional<std::int64_t> subject_id;
  std::string subject;
  std::optional<ProjectId> project;
  std::string project_slug;  // empty if the project no longer exists
  std::int64_t count = 1;    // number of failed sign-ins
  nlohmann::json details;
};

// Empty properties select all rows.
struct AuditQuery {
  std::string actor{};  // case is ignored
  std::string action{}, subject_kind{};
  std::optional<std::string> from{}, to{};  // times in RFC 3339; `to` is excluded
  std::optional<ProjectId> project{};
  std::optional<std::int64_t> before{};  // only rows with lower ids
  int limit = 100;
};

// Data that a client downloaded.
struct AuditExport {
  std::string kind;  // of the object: "layer", "table", "model", …
  std::optional<std::int64_t> id;
  std::string file;  // name of the file
  std::optional<ProjectId> project;
  nlohmann::json details = nlohmann::json::object();
};

// The audit log. Triggers of the database write most rows. Part of Store, whose rules for threads
// and errors apply.
class Audit {
 public:
  explicit Audit(Pool& pool) : pool_(pool) {}

  Result<void> exported(const AuditExport& data);
  // Counts an attempt of the thread's actor (ActingAs) to sign in as `name`, which may be any text.
  // `way` is "password", "token", "link", "invitation" or "oidc".
  Result<void> failed_sign_in(std::string_view name, std::string_view way);
  // Returns the rows, newest first.
  Result<std::vector<AuditRow>> rows(const AuditQuery& query);
  // Deletes some of the rows that are older than `keep`, which must be at least one day. Returns
  // whether there may be more of them.
  Result<bool> purge_some(std::chrono::days keep);

 private:
  Pool& pool_;
};

}  // namespace strata::store
