#include "sign_on/claims.h"

#include <algorithm>

namespace strata::sign_on {
namespace {

constexpr std::size_t kMaxValues = 10'000;

const nlohmann::json* find_claim(const nlohmann::json& claims, const std::string& claim) {
  if (claim.starts_with('/')) {
    const nlohmann::json::json_pointer at(claim);
    return claims.contains(at) ? &claims.at(at) : nullptr;
  }
  const auto found = claims.find(claim);
  return found == claims.end() ? nullptr : &*found;
}

bool gives_account(const AccountRules& rules, const nlohmann::json& claims) {
  if (rules.who != AccountRules::Who::some) return rules.who == AccountRules::Who::everybody;
  const auto values = claim_values(claims, rules.claim);
  return std::ranges::any_of(values, [&](const std::string& value) {
    return std::ranges::find(rules.values, value) != rules.values.end();
  });
}

}  // namespace

std::vector<std::string> claim_values(const nlohmann::json& claims, const std::string& claim) {
  const nlohmann::json* found = find_claim(claims, claim);
  if (!found) return {};
  if (found->is_string()) return {found->get<std::string>()};
  std::vector<std::string> values;
  if (found->is_array())
    for (const auto& value : *found)
      if (value.is_string() && values.size() < kMaxValues)
        values.push_back(value.get<std::string>());
  return values;
}

std::string claim_text(const nlohmann::json& claims, const std::string& claim) {
  const auto values = claim_values(claims, claim);
  return values.empty() ? std::string() : values.front();
}

Rights rights_of(const Provider& provider, const nlohmann::json& claims) {
  Rights rights;
  rights.may_create = gives_account(provider.accounts, claims);
  if (provider.roles) {
    Role role = provider.role;
    for (const std::string& value : claim_values(claims, provider.roles->claim))
      if (const auto found = provider.roles->roles.find(value);
          found != provider.roles->roles.end())
        role = std::max(role, found->second);
    rights.role = role;
  }
  if (provider.groups)
    for (const std::string& value : claim_values(claims, provider.groups->claim))
      if (const auto found = provider.groups->groups.find(value);
          found != provider.groups->groups.end())
        rights.groups.push_back(found->second);
  return rights;
}

}  // namespace strata::sign_on
