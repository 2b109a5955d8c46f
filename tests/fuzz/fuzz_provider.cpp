// Fuzzes the replies of an OpenID Connect provider during a sign-in: the discovery document, the
// reply with the tokens, the set of keys, and errors. A line break of the input begins the next
// reply. No reply contains a valid token, because the private key is not known. Claims without a
// token must always have rights.
#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "sign_on/claims.h"
#include "sign_on/client.h"

namespace {

using namespace strata;
using namespace strata::sign_on;

constexpr long kStatuses[] = {200, 400, 500};

void demand(bool holds) {
  if (!holds) std::abort();
}

const Provider& provider() {
  static const auto providers = parse_config(
      R"({"providers":[{"id":"museum","name":"Museum","issuer":"https://a.example",)"
      R"("client_id":"strata","accounts":{"claim":"/a/b","values":["c"]},)"
      R"("roles":{"claim":"r","map":{"s":"curator"}},"groups":{"claim":"g","map":{"h":"Students"}}}]})",
      "/nowhere");
  demand(providers && providers->size() == 1);
  return providers->front();
}

void read_claims(std::string_view text) {
  const auto claims = nlohmann::json::parse(text, nullptr, false);
  if (!claims.is_object()) return;
  const Rights rights = rights_of(provider(), claims);
  demand(rights.groups.size() <= 1);
  const auto values = claim_values(claims, "/a/b");
  demand(rights.may_create == (std::ranges::find(values, "c") != values.end()));
  (void)claim_text(claims, "preferred_username");
}

void sign_in(std::string_view rest, long status) {
  const Fetch fetch = [&](const HttpCall&) -> Result<HttpReply> {
    const auto end = std::min(rest.find('\n'), rest.size());
    HttpReply reply{status, std::string(rest.substr(0, end))};
    rest.remove_prefix(std::min(end + 1, rest.size()));
    return reply;
  };
  Client client(provider(), fetch);
  const Handshake handshake{"state", "nonce", "verifier"};
  const auto url = client.authorization_url("https://b.example/back", handshake);
  if (url)
    demand(url->starts_with("http"));
  else
    demand(url.error().code == ErrorCode::bad_gateway);
  demand(!client.claims({"code", {}}, "https://b.example/back", handshake).has_value());
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::string_view text(reinterpret_cast<const char*>(data + 1), size - 1);
  read_claims(text);
  sign_in(text, kStatuses[data[0] % std::size(kStatuses)]);
  return 0;
}
