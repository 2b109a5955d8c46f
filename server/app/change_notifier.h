#pragma once

#include <string>

#include "store/tables/table_changes.h"

namespace strata::app {

// Notifies connected users of the changes that a use case makes. Thread-safe.
class ChangeNotifier {
 public:
  virtual ~ChangeNotifier() = default;
  // `user` is the author of the change.
  virtual void records_changed(const store::TableChange& change, const std::string& user) const = 0;
};

}  // namespace strata::app
