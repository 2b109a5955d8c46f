#pragma once

#include "app/services.h"
#include "jobs/transfer.h"

namespace strata::app {

struct FeatureTransfer {
  std::size_t features = 0, lost_features = 0;
};

// Copies the lines and points of the records of the request's layers from the source to the target,
// as one entry of the user in each table's journal, and notifies participants. Cells with features
// on the target stay unchanged.
Result<FeatureTransfer> bring_features(const Services& services, const jobs::TransferTarget& target,
                                       const jobs::TransferRequest& request,
                                       const std::string& user);

}  // namespace strata::app
