#pragma once

#include "app/services.h"
#include "jobs/transfer.h"

namespace strata::app {

struct FeatureTransfer {
  std::size_t features = 0, lost_features = 0;
};

// Gives records of the tables of the request's layers the lines and points that they have on its
// source on the target, too, as one entry of the user in each table's journal, told to who looks.
// Cells that have something on the target already keep what they have.
Result<FeatureTransfer> bring_features(const Services& services, const jobs::TransferTarget& target,
                                       const jobs::TransferRequest& request,
                                       const std::string& user);

}  // namespace strata::app
