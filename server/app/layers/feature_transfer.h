#pragma once

#include "app/services.h"
#include "jobs/transfer.h"

namespace strata::app {

struct FeatureTransfer {
  std::size_t features = 0, lost_features = 0;
};

// Copies the lines and points of the records of the request's layers from the source model to the
// target model. Adds one entry for the user to the journal of each table, and notifies
// participants. Does not change cells that already contain features on the target model.
Result<FeatureTransfer> bring_features(const Services& services, const jobs::TransferTarget& target,
                                       const jobs::TransferRequest& request,
                                       const std::string& user);

}  // namespace strata::app
