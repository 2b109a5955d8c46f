#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/error.h"
#include "domain/scene/model.h"
#include "protocol/messages.h"

namespace strata::store {
class Store;
}

// Metadata of a project for a repository, in the form of DataCite 4.5.
namespace strata::app {

// The metadata with the version for ETag and If-Match.
struct ProjectMetadata {
  protocol::DepositRecord record;
  std::int64_t version = 0;  // 0: nothing was saved yet, and the record is a proposal
};

// Returns the record with identifiers in their usual form: a DOI without an address, and ORCID and
// ROR as addresses. Returns an `invalid` error with the path of the member for a wrong identifier,
// license, date or language, and for a place with only one coordinate.
Result<protocol::DepositRecord> checked_metadata(protocol::DepositRecord record);

// Returns the members of the record that a DOI needs and that are not set.
std::vector<std::string> missing_for_doi(const protocol::DepositRecord& record);

// Returns the saved record, or else one that is made from the project: its name, description and
// models. With `with_people`, its creators are the people with a role in the project.
Result<ProjectMetadata> metadata_of(store::Store& store, const Project& project, bool with_people);

}  // namespace strata::app
