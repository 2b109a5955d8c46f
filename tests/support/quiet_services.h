#pragma once

#include "app/change_notifier.h"
#include "app/edits.h"
#include "app/services.h"

namespace strata::test {

// The services that use cases need in addition to the store and the rooms, without any listener.
class QuietServices {
 public:
  app::Services of(store::Store& store, room::Rooms& rooms) {
    return {store, rooms, counters, nobody_};
  }
  app::EditCounters counters;

 private:
  class Nobody final : public app::ChangeNotifier {
   public:
    void records_changed(const store::TableChange&, const std::string&) const override {}
  };
  const Nobody nobody_{};
};

}  // namespace strata::test
