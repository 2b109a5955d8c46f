#include "net/serialization/audit_serialization.h"

#include "core/text/timestamp.h"

namespace strata::net {

nlohmann::json to_json(const store::AuditRow& row) {
  nlohmann::json json{
      {"id", row.id},         {"time", utc_text(row.time)}, {"actor_kind", row.actor_kind},
      {"action", row.action}, {"count", row.count},         {"details", row.details}};
  const auto put_text = [&](const char* name, const std::string& text) {
    if (!text.empty()) json[name] = text;
  };
  put_text("actor", row.actor);
  put_text("address", row.address);
  put_text("subject_kind", row.subject_kind);
  put_text("subject", row.subject);
  put_text("project_slug", row.project_slug);
  if (row.person) json["person"] = *row.person;
  if (row.subject_id) json["subject_id"] = *row.subject_id;
  if (row.project) json["project"] = *row.project;
  return json;
}

std::string json_line(const store::AuditRow& row) {
  return to_json(row).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

}  // namespace strata::net
