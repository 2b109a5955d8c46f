#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.h"
#include "domain/people/role.h"

namespace strata::sign_on {

// Claims are members of the ID token. A name that begins with `/` is a JSON pointer, such as
// `/realm_access/roles`.

struct RoleRules {
  std::string claim;
  std::map<std::string, Role> roles;  // by value of the claim
};
struct GroupRules {
  std::string claim;
  std::map<std::string, std::string> groups;  // names of groups by value of the claim
};
// Selects the people who get a new account.
struct AccountRules {
  enum class Who { everybody, nobody, some };
  Who who = Who::nobody;
  std::string claim;  // for `some`: people with one of the values
  std::vector<std::string> values;
};

struct Provider {
  std::string id;    // part of addresses: 1 to 32 lowercase letters, digits and hyphens
  std::string name;  // for people
  std::string issuer;
  std::string client_id;
  std::string client_secret;  // empty for a public client
  std::vector<std::string> scopes{"openid", "profile"};
  bool userinfo = false;  // also read the claims of the UserInfo endpoint
  std::string user_name_claim = "preferred_username";
  AccountRules accounts;
  Role role = Role::guest;  // of new accounts, and of people without a role from `roles`
  std::optional<RoleRules> roles;
  std::optional<GroupRules> groups;
};

inline constexpr std::size_t kMaxProviders = 16;

// Reads the JSON file of `--oidc-config`. Returns an `invalid` error that names the JSON pointer of
// the first mistake, also for unknown members. Relative names of files are relative to the folder
// of the file.
Result<std::vector<Provider>> read_config(const std::filesystem::path& file);
Result<std::vector<Provider>> parse_config(std::string_view text,
                                           const std::filesystem::path& folder);

}  // namespace strata::sign_on
