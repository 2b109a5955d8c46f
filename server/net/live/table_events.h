#pragma once

#include <string>

#include "app/change_notifier.h"
#include "net/live/live_sockets.h"
#include "room/room.h"
#include "room/rooms.h"

namespace strata::net {

// Sends the event to the participants of the project's models, with the columns that they see.
void tell_table(LiveSockets& sockets, protocol::TableEventEvent event, const Table& table,
                const std::string& user);

// Notifies open rooms and connected users of changed records: one event per record, or one of the
// table if its columns changed too or there are too many records.
class TableEvents final : public app::ChangeNotifier {
 public:
  // Both must outlive it.
  TableEvents(room::Rooms& rooms, LiveSockets& sockets) : rooms_(rooms), sockets_(sockets) {}
  void records_changed(const store::TableChange& change, const std::string& user) const override;

 private:
  room::Rooms& rooms_;
  LiveSockets& sockets_;
};

}  // namespace strata::net
