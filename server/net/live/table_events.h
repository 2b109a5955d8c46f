#pragma once

#include <string>

#include "app/change_notifier.h"
#include "net/live/live_sockets.h"
#include "room/room.h"
#include "room/rooms.h"

namespace strata::net {

// Sends the event to users who look at a model of the table's project, with the columns that they
// see.
void tell_table(LiveSockets& sockets, protocol::TableEventEvent event, const Table& table,
                const std::string& user);

// Lets open rooms and connected users know of changed records: each record, or the table instead
// where its columns changed, too, or there are too many records.
class TableEvents final : public app::ChangeNotifier {
 public:
  // Both outlive it.
  TableEvents(room::Rooms& rooms, LiveSockets& sockets) : rooms_(rooms), sockets_(sockets) {}
  void records_changed(const store::TableChange& change, const std::string& user) const override;

 private:
  room::Rooms& rooms_;
  LiveSockets& sockets_;
};

}  // namespace strata::net
