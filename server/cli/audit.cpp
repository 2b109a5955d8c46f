// `strata audit` prints the audit log. It runs on the server's machine, even while the server is
// running.
#include <algorithm>
#include <iostream>

#include "cli/subcommands.h"
#include "core/text/timestamp.h"
#include "net/serialization/audit_serialization.h"
#include "store/people/audit.h"

namespace strata::cli {
namespace {

constexpr int kRowsAtOnce = 1000;

struct AuditOptions {
  DataOptions data;
  std::string from, to, action, actor;
};

// For CLI11. Returns the problem of a text that is not a time.
std::string check_time(const std::string& text) {
  return utc_timestamp(text)
             ? std::string()
             : "Enter a time such as 2026-05-04T12:00:00Z, or a day such as 2026-05-04.";
}

std::string check_action(const std::string& text) {
  if (std::ranges::find(store::kAuditActions, text) != store::kAuditActions.end()) return {};
  std::string known;
  for (const std::string_view action : store::kAuditActions)
    known += (known.empty() ? "" : ", ") + std::string(action);
  return "Enter one of these actions: " + known;
}

std::optional<std::string> time_of(const std::string& text) {
  return text.empty() ? std::nullopt : utc_timestamp(text);
}

Result<void> print_rows(store::Store& store, const AuditOptions& options) {
  store::AuditQuery query;
  query.actor = options.actor;
  query.action = options.action;
  query.from = time_of(options.from);
  query.to = time_of(options.to);
  query.limit = kRowsAtOnce;
  for (;;) {
    const auto rows = STRATA_TRY(store.audit().rows(query));
    for (const store::AuditRow& row : rows) std::cout << net::json_line(row);
    if (!std::cout.flush())
      return fail(ErrorCode::storage_full, "Cannot write",
                  "The output could not be written. Check the free disk space.");
    if (rows.size() < kRowsAtOnce) return {};
    query.before = rows.back().id;
  }
}

}  // namespace

Command add_audit(CLI::App& app) {
  auto* command = app.add_subcommand("audit", "Print the audit log as JSON lines, newest first");
  auto options = std::make_shared<AuditOptions>();
  add_data_options(*command, options->data);
  command->add_option("--from", options->from, "Only rows at or after this time (RFC 3339) or day")
      ->check(check_time);
  command->add_option("--to", options->to, "Only rows before this time (RFC 3339) or day")
      ->check(check_time);
  command->add_option("--action", options->action, "Only this action, for example sign_in_failed")
      ->check(check_action);
  command->add_option("--actor", options->actor, "Only actions of this user");
  return [options] {
    auto database = open_database_beside(options->data);
    if (!database) return report(database.error());
    const auto done = print_rows(*(*database)->store, *options);
    return done ? 0 : report(done.error());
  };
}

}  // namespace strata::cli
