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

// The parts that use cases need; all outlive them. A file that uses a part includes its header.
struct Services {
  store::Store& store;
  room::Rooms& rooms;
  EditCounters& edits;
  const ChangeNotifier& changes;
};

}  // namespace strata::app
