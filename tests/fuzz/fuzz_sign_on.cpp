// Fuzzes data from OpenID Connect providers and administrators: ID tokens, sets of keys, and
// configurations. The first byte selects the reader. No input is a valid token, because the private
// key is not known.
#include <cstdint>
#include <cstdlib>
#include <string>

#include "sign_on/config.h"
#include "sign_on/id_token.h"
#include "sign_on/key_set.h"

namespace {

using namespace strata;

void demand(bool holds) {
  if (!holds) std::abort();
}

// the public key of RFC 7515, A.3
const sign_on::KeySet& keys() {
  static const auto set = sign_on::KeySet::parse(
      R"({"keys":[{"kty":"EC","crv":"P-256","kid":"a","x":"f83OJ3D2xF1Bg8vub9tLe1gHMzV76e8Tus9uPHvRVEU","y":"x_FEzRu9m36HLN_tue659LNpXW6pCyStikYjKIWI5a0"}]})");
  demand(set && set->size() == 1);
  return *set;
}

void read_token(const std::string& text) {
  const auto header = sign_on::read_token_header(text);
  if (!header) demand(header.error().code == ErrorCode::unauthenticated);
  const auto claims = sign_on::verify_id_token(text, keys(), {"issuer", "client", "nonce", {}});
  demand(!claims && claims.error().code == ErrorCode::unauthenticated);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::string text(reinterpret_cast<const char*>(data + 1), size - 1);
  if (data[0] % 3 == 0) {
    read_token(text);
  } else if (data[0] % 3 == 1) {
    const auto set = sign_on::KeySet::parse(text);
    demand(set ? set->size() <= sign_on::KeySet::kMaxKeys
               : set.error().code == ErrorCode::bad_gateway);
  } else {
    const auto providers = sign_on::parse_config(text, "/nowhere");
    demand(providers ? !providers->empty() : providers.error().code == ErrorCode::invalid);
  }
  return 0;
}
