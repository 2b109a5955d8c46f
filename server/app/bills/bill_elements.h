#pragma once

#include <memory>
#include <string>
#include <vector>

#include "app/services.h"
#include "bill/measure.h"
#include "core/error.h"
#include "core/ids.h"
#include "domain/people/role.h"
#include "protocol/messages.h"

namespace strata::app {

struct BillSource {
  ProjectId project = 0;
  Role seen_by = Role::curator;
  std::string language{};  // of the labels of terms
};

inline constexpr std::size_t kMaxDepthClasses = 1000;  // whose depths are read from a layer

// Finds and measures the elements of rules in the newest state of the models. Reads each table and
// layer once. Errors name a field of the rule.
class BillElements {
 public:
  BillElements(const Services& services, BillSource source);
  ~BillElements();
  BillElements(const BillElements&) = delete;
  BillElements& operator=(const BillElements&) = delete;

  struct Cache;  // what the rules share

  // Returns the elements in the order of models, layers and keys. Returns an `invalid` error for a
  // table, model, layer or column that does not exist or that the role does not see, for a depth
  // without a unit, and for too many elements. Opens the models. Blocks, and checks the current
  // question.
  Result<std::vector<bill::Element>> of(const protocol::BillRule& rule);

 private:
  Result<std::vector<bill::Element>> of_layer(const protocol::BillRule& rule);

  const std::unique_ptr<Cache> cache_;
};

}  // namespace strata::app
