#include "sign_on/config.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>

#include "sign_on/claims.h"

namespace strata::sign_on {
namespace {

using nlohmann::json;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::StartsWith;

json good() {
  return json::parse(R"({
    "id": "museum",
    "name": "Museum",
    "issuer": "https://login.museum.example/realms/staff",
    "client_id": "strata",
    "accounts": {"claim": "groups", "values": ["strata"]},
    "roles": {"claim": "/realm_access/roles",
              "map": {"strata-admin": "administrator", "strata-staff": "curator"}},
    "groups": {"claim": "groups", "map": {"/excavation": "Excavation 2026"}}
  })");
}
Result<std::vector<Provider>> parse(const json& providers) {
  return parse_config(json{{"providers", providers}}.dump(), "/nowhere");
}
// Returns the detail of the error for a provider with another value of a member.
std::string mistake(const std::string& member, const json& value) {
  json provider = good();
  provider[member] = value;
  const auto parsed = parse(json::array({provider}));
  return parsed ? "valid" : parsed.error().detail;
}

TEST(SignOnConfig, a_whole_provider_is_read) {
  const auto providers = parse(json::array({good()}));
  ASSERT_TRUE(providers) << providers.error().detail;
  const Provider& provider = providers->front();
  EXPECT_EQ(provider.name, "Museum");
  EXPECT_EQ(provider.client_secret, "");
  EXPECT_THAT(provider.scopes, ElementsAre("openid", "profile"));
  EXPECT_EQ(provider.role, Role::guest);
  EXPECT_EQ(provider.accounts.who, AccountRules::Who::some);
  EXPECT_EQ(provider.roles->roles.at("strata-staff"), Role::curator);
  EXPECT_EQ(provider.groups->groups.at("/excavation"), "Excavation 2026");
}

TEST(SignOnConfig, mistakes_name_their_place) {
  const std::string here = "/providers/0/";
  EXPECT_THAT(mistake("isuer", "x"), StartsWith(here + "isuer: Unknown"));
  for (const json& id :
       {json("Museum"), json("a/b"), json(""), json(7), json(std::string(33, 'a'))})
    EXPECT_THAT(mistake("id", id), StartsWith(here + "id: "));
  for (const char* issuer :
       {"http://login.museum.example", "ftp://a", "https://", "https://u:p@museum.example",
        "https://museum.example?a", "https://museum.example#a", "https://mu seum.example",
        "http://127.0.0.1.evil.example", "http://localhost@evil.example"})
    EXPECT_THAT(mistake("issuer", issuer), StartsWith(here + "issuer: ")) << issuer;
  EXPECT_EQ(mistake("issuer", "http://127.0.0.1:9000"), "valid");
  EXPECT_THAT(mistake("name", std::string("a\nb")), StartsWith(here + "name: "));
  EXPECT_THAT(mistake("scopes", {"profile"}), StartsWith(here + "scopes: "));
  EXPECT_THAT(mistake("scopes", {"openid", 7}), StartsWith(here + "scopes/1: "));
  EXPECT_THAT(mistake("userinfo", 1), StartsWith(here + "userinfo: "));
  EXPECT_THAT(mistake("role", "owner"), StartsWith(here + "role: "));
  EXPECT_THAT(mistake("accounts", "some"), StartsWith(here + "accounts: "));
  EXPECT_THAT(mistake("accounts", {{"claim", "groups"}}), StartsWith(here + "accounts/values: "));
  EXPECT_THAT(mistake("roles", {{"claim", "r"}, {"map", {{"boss", "owner"}}}}),
              StartsWith(here + "roles/map/boss: "));
  EXPECT_THAT(mistake("groups", {{"claim", "/a~2"}, {"map", {{"a", "b"}}}}),
              StartsWith(here + "groups/claim: "));
  EXPECT_THAT(mistake("groups", {{"claim", "a"}, {"map", {{"a", ""}}}}),
              StartsWith(here + "groups/map/a: "));
  json incomplete = good();
  incomplete.erase("accounts");
  EXPECT_THAT(parse(json::array({incomplete})).error().detail,
              StartsWith(here + "accounts: Missing"));
  EXPECT_THAT(parse(json::array({good(), good()})).error().detail, StartsWith("/providers/1/id: "));
  EXPECT_THAT(parse(json::array()).error().detail, StartsWith("/providers: "));
  EXPECT_THAT(parse_config("{", "/").error().detail, StartsWith("The file: "));
  EXPECT_THAT(parse_config(R"({"providers": [], "more": 1})", "/").error().detail,
              StartsWith("/more: "));
}

TEST(SignOnConfig, the_secret_is_in_another_file) {
  const auto folder =
      std::filesystem::temp_directory_path() / ("strata-sign-on-" + std::to_string(::getpid()));
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "secret") << " the secret\n";
  json provider = good();
  provider["client_secret_file"] = "secret";
  std::ofstream(folder / "oidc.json") << json{{"providers", json::array({provider})}};
  const auto read = read_config(folder / "oidc.json");
  ASSERT_TRUE(read) << read.error().detail;
  EXPECT_EQ(read->front().client_secret, "the secret");
  std::ofstream(folder / "secret") << "\n";
  EXPECT_THAT(read_config(folder / "oidc.json").error().detail,
              StartsWith("/providers/0/client_secret_file: "));
  std::filesystem::remove_all(folder);
  EXPECT_FALSE(read_config(folder / "oidc.json"));
  EXPECT_THAT(mistake("client_secret_file", "missing"),
              StartsWith("/providers/0/client_secret_file: "));
}

TEST(Claims, they_give_roles_groups_and_accounts) {
  const Provider provider = parse(json::array({good()}))->front();
  const json claims{
      {"groups", {"/excavation", "/other", "strata", 7}},
      {"realm_access", {{"roles", {"strata-staff", "strata-admin", "another"}}}},
  };
  const Rights rights = rights_of(provider, claims);
  EXPECT_TRUE(rights.may_create);
  EXPECT_EQ(rights.role, Role::administrator);
  EXPECT_THAT(rights.groups, ElementsAre("Excavation 2026"));
}

TEST(Claims, missing_and_strange_claims_give_nothing) {
  const Provider provider = parse(json::array({good()}))->front();
  for (const json& claims :
       {json::object(), json{{"groups", 7}, {"realm_access", {"roles"}}},
        json{{"groups", {{"strata", true}}}, {"realm_access", {{"roles", nullptr}}}}}) {
    const Rights rights = rights_of(provider, claims);
    EXPECT_FALSE(rights.may_create);
    EXPECT_EQ(rights.role, Role::guest);
    EXPECT_THAT(rights.groups, IsEmpty());
  }
}

TEST(Claims, a_provider_without_rules_gives_no_role) {
  json value = good();
  value.erase("roles");
  value["accounts"] = "everybody";
  const Rights rights = rights_of(parse(json::array({value}))->front(), json::object());
  EXPECT_TRUE(rights.may_create);
  EXPECT_FALSE(rights.role);
}

}  // namespace
}  // namespace strata::sign_on
