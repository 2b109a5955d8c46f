#include "net/live/node_events.h"

#include <optional>

#include "core/log.h"
#include "domain/scene/tool.h"
#include "net/auth/session_recheck.h"
#include "net/live/close_codes.h"
#include "net/live/comment_events.h"
#include "store/content/projects.h"
#include "store/content/tools.h"
#include "store/tables/tables.h"

namespace strata::net {
namespace {

using store::NodeMessage;

// The events of nodes and of the protocol have the same names.
template <class Event>
Event event_of(const NodeMessage& message) {
  switch (message.event) {
    case NodeMessage::Event::created: return Event::created;
    case NodeMessage::Event::changed: return Event::changed;
    case NodeMessage::Event::deleted: break;
  }
  return Event::deleted;
}

// Sends the event of a part of a model, such as a view. `part` is the member with its id.
template <class PartEvent>
void tell_part(LiveSockets& sockets, const NodeMessage& message, std::int64_t id,
               std::int64_t PartEvent::*part) {
  PartEvent event;
  event.event = event_of<decltype(event.event)>(message);
  event.*part = id;
  event.user = message.user;
  if (message.model) sockets.tell_model(*message.model, event);
}

bool is_gone(const Error& error) { return error.code == ErrorCode::not_found; }

}  // namespace

Result<void> NodeEvents::receive(const NodeMessage& message) {
  if (message.kind == NodeMessage::Kind::access) return check_access(message.user);
  for (const std::int64_t id : message.subjects) {
    switch (message.kind) {
      case NodeMessage::Kind::records: STRATA_TRY(receive_records(message, TableId(id))); break;
      case NodeMessage::Kind::table: STRATA_TRY(receive_table(message, TableId(id))); break;
      case NodeMessage::Kind::comment: STRATA_TRY(receive_comment(message, CommentId(id))); break;
      case NodeMessage::Kind::tool: STRATA_TRY(receive_tool(message, ToolId(id))); break;
      case NodeMessage::Kind::kiosk: STRATA_TRY(check_access(kiosk_name(KioskId(id)))); break;
      case NodeMessage::Kind::view:
        tell_part(sockets_, message, id, &protocol::ViewEvent::view);
        break;
      case NodeMessage::Kind::snapshot:
        tell_part(sockets_, message, id, &protocol::SnapshotEvent::snapshot);
        break;
      case NodeMessage::Kind::selection:
        tell_part(sockets_, message, id, &protocol::SelectionEvent::selection);
        break;
      case NodeMessage::Kind::access: break;
    }
  }
  return {};
}

Result<void> NodeEvents::receive_records(const NodeMessage& message, TableId table) {
  const bool is_shown = message.project && sockets_.has_project(*message.project);
  auto change = store_.tables().change_of(table, message.sequence.value_or(0),
                                          is_shown ? kMaxRecordEvents : 0);
  if (!change) return is_gone(change.error()) ? Result<void>{} : tl::unexpected(change.error());
  tables_.records_changed(*change, message.user);
  return {};
}

Result<void> NodeEvents::receive_table(const NodeMessage& message, TableId id) {
  if (!message.project) return {};
  Table table;
  table.id = id;
  table.project_id = *message.project;
  if (message.event != NodeMessage::Event::deleted) {
    auto now = store_.tables().find(to_string(id), Role::owner);
    if (!now) return is_gone(now.error()) ? Result<void>{} : tl::unexpected(now.error());
    table = std::move(*now);
    // The visibility of a column may have changed, and with it colors, lines and points.
    rooms_.records_changed(id);
  }
  tell_table(sockets_, event_of<protocol::TableEventEvent>(message), table, message.user);
  return {};
}

Result<void> NodeEvents::receive_comment(const NodeMessage& message, CommentId id) {
  if (!message.model || !sockets_.has_model(*message.model)) return {};
  if (message.event != NodeMessage::Event::deleted)
    return tell_comment(store_, sockets_, event_of<protocol::CommentEventEvent>(message), id,
                        message.user);
  tell_comment_deleted(sockets_, *message.model, id, message.user);
  return {};
}

Result<void> NodeEvents::receive_tool(const NodeMessage& message, ToolId id) {
  protocol::ToolEvent event;
  event.event = event_of<protocol::ToolEventEvent>(message);
  event.tool_id = id.number();
  if (message.event != NodeMessage::Event::deleted) {
    const auto tool = store_.tools().find(to_string(id));
    if (!tool) return is_gone(tool.error()) ? Result<void>{} : tl::unexpected(tool.error());
    event.tool = to_json(*tool);
  }
  sockets_.tell_all(event);
  return {};
}

// Only the connections that lose their access, or whose role changes, are closed.
Result<void> NodeEvents::check_access(const std::string& user) {
  auth_.forget();
  std::optional<Error> unknown;
  sockets_.close_unwelcome(
      user,
      [&](const std::string& secret, ProjectId project_id, Role role) {
        const auto welcome = is_welcome(auth_, secret, project_id, role);
        if (!welcome) unknown = welcome.error();
        return welcome.value_or(true);
      },
      kClosePolicy, "your access was changed");
  if (unknown) return tl::unexpected(std::move(*unknown));
  return {};
}

Result<void> NodeEvents::start_over() {
  auth_.forget();
  std::vector<TableId> tables;
  const auto projects = STRATA_TRY(store_.projects().all());
  for (const Project& project : projects) {
    const auto found = store_.tables().of_project(project.id, Role::owner);
    if (!found && !is_gone(found.error())) return tl::unexpected(found.error());
    if (!found) continue;
    for (const Table& table : *found) tables.push_back(table.id);
  }
  log::warning("changes at other nodes may be missing, so all clients connect again");
  for (const TableId table : tables) rooms_.records_changed(table);
  sockets_.close_all(kCloseGoingAway, "changes at other nodes may be missing");
  return {};
}

}  // namespace strata::net
