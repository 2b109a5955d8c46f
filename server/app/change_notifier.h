#pragma once

#include <string>

#include "store/tables/table_changes.h"

namespace strata::app {

// Tells connected users what a use case has changed. Thread-safe.
class ChangeNotifier {
 public:
  virtual ~ChangeNotifier() = default;
  // `user`: who changed the records.
  virtual void records_changed(const store::TableChange& change, const std::string& user) const = 0;
};

}  // namespace strata::app
