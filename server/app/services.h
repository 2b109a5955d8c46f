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

// The services that use cases need. All of them must outlive this object. A file that uses a
// service includes its header.
struct Services {
  store::Store& store;
  room::Rooms& rooms;
  EditCounters& edits;
  const ChangeNotifier& changes;
};

}  // namespace strata::app
