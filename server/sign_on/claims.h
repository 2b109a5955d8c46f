#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "domain/people/role.h"
#include "sign_on/config.h"

namespace strata::sign_on {

// The rights that a person gets in Strata from the claims of the provider.
struct Rights {
  bool may_create = false;   // the person gets an account if they have none
  std::optional<Role> role;  // empty if the provider has no rules for roles
  std::vector<std::string> groups;
};

Rights rights_of(const Provider& provider, const nlohmann::json& claims);

// Returns the texts of a claim, which is a text or a list. Ignores other values.
std::vector<std::string> claim_values(const nlohmann::json& claims, const std::string& claim);
// Returns the first text of a claim, or an empty text.
std::string claim_text(const nlohmann::json& claims, const std::string& claim);

}  // namespace strata::sign_on
