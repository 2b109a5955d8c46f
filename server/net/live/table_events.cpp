#include "net/live/table_events.h"

#include <algorithm>

namespace strata::net {
namespace {

constexpr Visibility kSights[] = {Visibility::everyone, Visibility::team, Visibility::curators};

}  // namespace

void tell_table(LiveSockets& sockets, protocol::TableEventEvent event, const Table& table,
                const std::string& user) {
  protocol::TableEvent message;
  message.event = event;
  message.table_id = table.id.number();
  message.user = user;
  for (const Visibility sight : kSights) {
    if (event != protocol::TableEventEvent::deleted)
      message.table = to_json(seen_by(table, least_role(sight)));
    sockets.tell_project(table.project_id, sight, message);
  }
}

void TableEvents::records_changed(const store::TableChange& change, const std::string& user) const {
  if (change.sequence == 0) return;
  rooms_.admit_keys(change.table.id, change.created);
  rooms_.records_changed(change.table.id);
  if (change.columns_changed ||
      change.created.size() + change.changed.size() + change.deleted.size() > kMaxRecordEvents)
    return tell_table(sockets_, protocol::TableEventEvent::changed, change.table, user);
  protocol::RecordEvent message;
  message.table = change.table.id.number();
  message.user = user;
  for (const Record& record : change.records) {
    const bool is_new =
        std::find(change.created.begin(), change.created.end(), record.key) != change.created.end();
    message.event =
        is_new ? protocol::RecordEventEvent::created : protocol::RecordEventEvent::changed;
    message.key = record.key;
    for (const Visibility sight : kSights) {
      message.record = to_json(record, seen_by(change.table, least_role(sight)).columns);
      sockets_.tell_project(change.table.project_id, sight, message);
    }
  }
  message.event = protocol::RecordEventEvent::deleted;
  message.record.reset();
  for (const auto key : change.deleted) {
    message.key = key;
    sockets_.tell_project(change.table.project_id, message);
  }
}

}  // namespace strata::net
