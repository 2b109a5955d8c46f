#pragma once

#include <string>

#include "app/change_notifier.h"
#include "net/live/live_sockets.h"
#include "room/room.h"
#include "room/rooms.h"

namespace strata::net {

// Sends the event to the participants of the project's models. Each receives only the columns that
// are visible to that participant.
void tell_table(LiveSockets& sockets, protocol::TableEventEvent event, const Table& table,
                const std::string& user);

// If a change affects more records, the server sends one event for the table.
inline constexpr std::size_t kMaxRecordEvents = 100;

// Notifies open rooms and connected users of changed records. Sends one event per record. Sends one
// event for the table instead if its columns also changed or too many records changed.
class TableEvents final : public app::ChangeNotifier {
 public:
  // `rooms` and `sockets` must outlive the object.
  TableEvents(room::Rooms& rooms, LiveSockets& sockets) : rooms_(rooms), sockets_(sockets) {}
  void records_changed(const store::TableChange& change, const std::string& user) const override;

 private:
  room::Rooms& rooms_;
  LiveSockets& sockets_;
};

}  // namespace strata::net
