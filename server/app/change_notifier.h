#pragma once

#include <string>

#include "store/tables/table_changes.h"

namespace strata::app {

// Notifies connected users of the changes of a use case. Thread-safe.
class ChangeNotifier {
 public:
  virtual ~ChangeNotifier() = default;
  // `user`: the author of the change.
  virtual void records_changed(const store::TableChange& change, const std::string& user) const = 0;
};

}  // namespace strata::app
