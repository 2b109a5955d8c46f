#pragma once

namespace strata::store {
class Store;
}
namespace strata::room {
class Rooms;
}

namespace strata::app {

class ChangeNotifier;
struct EditCounters;

// What use cases work with. All of it outlives them. Who uses a part includes its header.
struct Services {
  store::Store& store;
  room::Rooms& rooms;
  EditCounters& edits;
  const ChangeNotifier& changes;
};

}  // namespace strata::app
