#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "app/services.h"
#include "core/progress.h"
#include "core/temporary_file.h"
#include "domain/people/role.h"
#include "domain/scene/model.h"
#include "protocol/messages.h"

namespace strata::app {

// A deposit of a project for a repository.
struct DepositRequest {
  Project project;
  Author reader{{}, Role::curator};  // gets only what this user sees
  protocol::DepositRecord record;    // complete (missing_for_doi)
};

// Writes a zip to `folder` with all data of the project: a bag (RFC 8493) whose payload is an
// RO-Crate 1.1. docs/reference/deposits.md describes the files. Data in the Trash are not included.
// Each layer and each table is in a consistent state, which may be newer than that of an earlier
// part. Returns 503 if there is too little memory for one layer or mesh, `storage_full`,
// `cancelled`, and `damaged` for a content of the store that is damaged. Blocks.
Result<std::shared_ptr<const TemporaryFile>> make_deposit(const Services& services,
                                                          const DepositRequest& request,
                                                          const std::filesystem::path& folder,
                                                          Progress& progress);

}  // namespace strata::app
