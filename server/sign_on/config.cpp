#include "sign_on/config.h"

#include <algorithm>
#include <fstream>
#include <initializer_list>
#include <iterator>
#include <nlohmann/json.hpp>

#include "core/text/ascii.h"
#include "core/text/url.h"

namespace strata::sign_on {
namespace {

using nlohmann::json;

constexpr std::size_t kMaxFile = 1u << 20, kMaxSecret = 4096, kMaxText = 255, kMaxId = 32,
                      kMaxRules = 1000;

tl::unexpected<Error> mistake(const std::string& path, const std::string& what) {
  return fail(ErrorCode::invalid, "Invalid sign-on configuration",
              (path.empty() ? std::string("The file") : path) + ": " + what, "--oidc-config");
}

Result<std::string> contents_of(const std::filesystem::path& file, std::size_t most) {
  std::ifstream in(file, std::ios::binary);
  std::string text(most + 1, '\0');
  in.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(in.gcount()));
  if (in.bad() || (!in.eof() && in.fail()) || !in.is_open())
    return mistake({}, file.string() + " cannot be read.");
  if (text.size() > most)
    return mistake({}, file.string() + " is larger than " + std::to_string(most) + " bytes.");
  return text;
}

// Reads one object of the configuration.
class Object {
 public:
  static Result<Object> of(const json& value, std::string path,
                           std::initializer_list<std::string_view> members) {
    if (!value.is_object()) return mistake(path, "Must be an object.");
    for (const auto& [name, ignored] : value.items())
      if (std::ranges::find(members, name) == members.end())
        return mistake(path + "/" + name, "Unknown member.");
    return Object(value, std::move(path));
  }

  const json* find(const std::string& name) const {
    const auto found = value_.find(name);
    return found == value_.end() ? nullptr : &*found;
  }
  std::string path_of(const std::string& name) const { return path_ + "/" + name; }

  Result<std::string> text(const std::string& name, std::size_t most = kMaxText) const {
    const json* value = find(name);
    if (!value) return mistake(path_of(name), "Missing.");
    return text_in(*value, path_of(name), most);
  }
  Result<std::string> text_or(const std::string& name, std::string otherwise) const {
    return find(name) ? text(name) : Result<std::string>(std::move(otherwise));
  }
  Result<std::string> claim(const std::string& name) const {
    auto claim = STRATA_TRY(text(name));
    if (claim.starts_with('/')) {
      try {
        (void)json::json_pointer(claim);
      } catch (const json::exception&) {
        return mistake(path_of(name), "Must be the name of a claim or a valid JSON pointer.");
      }
    }
    return claim;
  }
  Result<std::vector<std::string>> texts(const std::string& name) const {
    const json* list = find(name);
    if (!list || !list->is_array() || list->empty() || list->size() > kMaxRules)
      return mistake(path_of(name), "Must be a list of 1 to 1000 texts.");
    std::vector<std::string> found;
    for (std::size_t i = 0; i < list->size(); ++i) {
      auto each =
          STRATA_TRY(text_in((*list)[i], path_of(name) + "/" + std::to_string(i), kMaxText));
      found.push_back(std::move(each));
    }
    return found;
  }
  // Returns the members of an object by name. All values must be texts.
  Result<std::map<std::string, std::string>> map(const std::string& name) const {
    const json* object = find(name);
    if (!object || !object->is_object() || object->empty() || object->size() > kMaxRules)
      return mistake(path_of(name), "Must be an object with 1 to 1000 members.");
    std::map<std::string, std::string> found;
    for (const auto& [key, value] : object->items())
      found[key] = STRATA_TRY(text_in(value, path_of(name) + "/" + key, kMaxText));
    return found;
  }

 private:
  Object(const json& value, std::string path) : value_(value), path_(std::move(path)) {}
  static Result<std::string> text_in(const json& value, const std::string& path, std::size_t most) {
    if (!value.is_string()) return mistake(path, "Must be a text.");
    auto text = value.get<std::string>();
    const bool has_controls =
        std::ranges::any_of(text, [](char c) { return (c >= 0 && c < ' ') || c == 0x7f; });
    if (text.empty() || text.size() > most || has_controls)
      return mistake(
          path, "Must have 1 to " + std::to_string(most) + " bytes, without control characters.");
    return text;
  }

  const json& value_;
  std::string path_;
};

Result<Role> role_named(const std::string& name, const std::string& path) {
  const auto role = parse_role(name);
  if (role && *role != Role::owner) return *role;
  return mistake(path, "Must be guest, viewer, annotator, curator or administrator.");
}

Result<AccountRules> accounts_in(const Object& provider) {
  using Who = AccountRules::Who;
  const json* given = provider.find("accounts");
  const std::string path = provider.path_of("accounts");
  if (!given) return mistake(path, "Missing. Write \"everybody\", \"nobody\" or an object.");
  if (*given == "everybody") return AccountRules{Who::everybody, {}, {}};
  if (*given == "nobody") return AccountRules{Who::nobody, {}, {}};
  if (!given->is_object())
    return mistake(path, "Must be \"everybody\", \"nobody\" or an object with claim and values.");
  const auto object = STRATA_TRY(Object::of(*given, path, {"claim", "values"}));
  AccountRules rules{Who::some, {}, {}};
  rules.claim = STRATA_TRY(object.claim("claim"));
  rules.values = STRATA_TRY(object.texts("values"));
  return rules;
}

Result<std::optional<RoleRules>> roles_in(const Object& provider) {
  const json* given = provider.find("roles");
  if (!given) return std::optional<RoleRules>();
  const auto object = STRATA_TRY(Object::of(*given, provider.path_of("roles"), {"claim", "map"}));
  RoleRules rules;
  rules.claim = STRATA_TRY(object.claim("claim"));
  const auto roles = STRATA_TRY(object.map("map"));
  for (const auto& [value, role] : roles)
    rules.roles[value] = STRATA_TRY(role_named(role, object.path_of("map") + "/" + value));
  return std::optional(std::move(rules));
}

Result<std::optional<GroupRules>> groups_in(const Object& provider) {
  const json* given = provider.find("groups");
  if (!given) return std::optional<GroupRules>();
  const auto object = STRATA_TRY(Object::of(*given, provider.path_of("groups"), {"claim", "map"}));
  GroupRules rules;
  rules.claim = STRATA_TRY(object.claim("claim"));
  rules.groups = STRATA_TRY(object.map("map"));
  return std::optional(std::move(rules));
}

Result<std::string> secret_in(const Object& provider, const std::filesystem::path& folder) {
  if (!provider.find("client_secret_file")) return std::string();
  const auto name = STRATA_TRY(provider.text("client_secret_file", 4096));
  const auto contents = contents_of(folder / name, kMaxSecret);
  const std::string path = provider.path_of("client_secret_file");
  if (!contents) return mistake(path, contents.error().detail);
  const std::string secret(trimmed(*contents));
  if (secret.empty()) return mistake(path, "The file with the secret is empty.");
  return secret;
}

bool is_id(const std::string& id) {
  const auto may_stand = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '-';
  };
  return id.size() <= kMaxId && std::ranges::all_of(id, may_stand);
}

Result<Provider> provider_in(const json& value, const std::string& path,
                             const std::filesystem::path& folder) {
  const auto object = STRATA_TRY(
      Object::of(value, path,
                 {"id", "name", "issuer", "client_id", "client_secret_file", "scopes", "userinfo",
                  "user_name_claim", "accounts", "role", "roles", "groups"}));
  Provider provider;
  provider.id = STRATA_TRY(object.text("id"));
  if (!is_id(provider.id))
    return mistake(object.path_of("id"),
                   "Must have 1 to 32 lowercase letters (a to z), digits and hyphens.");
  provider.name = STRATA_TRY(object.text("name", 100));
  provider.issuer = STRATA_TRY(object.text("issuer"));
  if (!is_safe_url(provider.issuer) || provider.issuer.find('?') != std::string::npos)
    return mistake(object.path_of("issuer"),
                   "Must be an https URL without a query. Only a provider on this machine can use "
                   "http.");
  provider.client_id = STRATA_TRY(object.text("client_id"));
  provider.client_secret = STRATA_TRY(secret_in(object, folder));
  if (object.find("scopes")) provider.scopes = STRATA_TRY(object.texts("scopes"));
  if (std::ranges::find(provider.scopes, "openid") == provider.scopes.end())
    return mistake(object.path_of("scopes"), "Must contain openid.");
  if (const json* userinfo = object.find("userinfo")) {
    if (!userinfo->is_boolean())
      return mistake(object.path_of("userinfo"), "Must be true or false.");
    provider.userinfo = userinfo->get<bool>();
  }
  if (object.find("user_name_claim"))
    provider.user_name_claim = STRATA_TRY(object.claim("user_name_claim"));
  provider.accounts = STRATA_TRY(accounts_in(object));
  const auto role = STRATA_TRY(object.text_or("role", "guest"));
  provider.role = STRATA_TRY(role_named(role, object.path_of("role")));
  provider.roles = STRATA_TRY(roles_in(object));
  provider.groups = STRATA_TRY(groups_in(object));
  return provider;
}

}  // namespace

Result<std::vector<Provider>> parse_config(std::string_view text,
                                           const std::filesystem::path& folder) {
  const json config = json::parse(text, nullptr, false);
  if (config.is_discarded()) return mistake({}, "This is not valid JSON.");
  const auto object = STRATA_TRY(Object::of(config, {}, {"providers"}));
  const json* list = object.find("providers");
  if (!list || !list->is_array() || list->empty() || list->size() > kMaxProviders)
    return mistake("/providers", "Must be a list of 1 to 16 providers.");
  std::vector<Provider> providers;
  for (std::size_t i = 0; i < list->size(); ++i) {
    const std::string path = "/providers/" + std::to_string(i);
    auto provider = STRATA_TRY(provider_in((*list)[i], path, folder));
    if (std::ranges::find(providers, provider.id, &Provider::id) != providers.end())
      return mistake(path + "/id", "Another provider has the same id.");
    providers.push_back(std::move(provider));
  }
  return providers;
}

Result<std::vector<Provider>> read_config(const std::filesystem::path& file) {
  const auto text = STRATA_TRY(contents_of(file, kMaxFile));
  return parse_config(text, file.parent_path());
}

}  // namespace strata::sign_on
