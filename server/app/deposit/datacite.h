#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

#include "protocol/messages.h"

namespace strata::app {

inline constexpr const char* kDataciteSchema = "http://datacite.org/schema/kernel-4";

// Write the metadata in the schema DataCite 4.5. Members that the record lacks are left out, so the
// result is only valid if missing_for_doi returns nothing. The JSON is the form of DataCite's REST
// API (`attributes`).
nlohmann::json datacite_json(const protocol::DepositRecord& record);
std::string datacite_xml(const protocol::DepositRecord& record);

// Returns the name of a member of an enumeration as DataCite writes it: IsPartOf for is_part_of.
std::string datacite_name(std::string_view name);

// The parts of a person's name, which is written as `Family, Given`. `given` is empty without a
// comma.
struct NameParts {
  std::string family, given;
};
NameParts name_parts(const std::string& name);

}  // namespace strata::app
