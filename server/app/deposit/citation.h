#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "protocol/messages.h"

// The citation of a project, from its metadata. Members that are not set are left out.
namespace strata::app {

// Returns one line: "Muster, A. (2026). Title (Version 2) [Dataset]. Publisher.
// https://doi.org/10.5281/zenodo.1", in the style that DataCite recommends.
std::string citation_text(const protocol::DepositRecord& record);
std::string bibtex(const protocol::DepositRecord& record, const std::string& key);
std::string ris(const protocol::DepositRecord& record);
// An array with one item of CSL-JSON.
nlohmann::json csl_json(const protocol::DepositRecord& record, const std::string& id);
// A `Dataset` of schema.org.
nlohmann::json schema_org(const protocol::DepositRecord& record);

}  // namespace strata::app
