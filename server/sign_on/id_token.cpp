#include "sign_on/id_token.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/secret.h"
#include "core/text/ascii.h"
#include "core/text/base64.h"

namespace strata::sign_on {
namespace {

using nlohmann::json;
constexpr std::size_t kMaxSubject = 255, kMaxKid = 255;

tl::unexpected<Error> refused(const std::string& why) {
  return fail(ErrorCode::unauthenticated, "Invalid ID token", why);
}

struct Parts {
  std::string_view header, payload, signature, signed_text;
};

std::optional<Parts> split(std::string_view token) {
  const auto first = token.find('.');
  const auto second = first == std::string_view::npos ? first : token.find('.', first + 1);
  if (second == std::string_view::npos || token.find('.', second + 1) != std::string_view::npos)
    return std::nullopt;
  return Parts{token.substr(0, first), token.substr(first + 1, second - first - 1),
               token.substr(second + 1), token.substr(0, second)};
}

// Accepts only base64url without padding, as JWS requires.
std::optional<std::vector<std::uint8_t>> decode(std::string_view text) {
  const auto may_stand = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' ||
           c == '_';
  };
  if (text.empty() || !std::ranges::all_of(text, may_stand)) return std::nullopt;
  return from_base64(text);
}

std::optional<json> object_in(std::string_view text) {
  const auto bytes = decode(text);
  if (!bytes) return std::nullopt;
  auto object = json::parse(bytes->begin(), bytes->end(), nullptr, false);
  if (!object.is_object()) return std::nullopt;
  return object;
}

std::optional<std::string> text_of(const json& object, const char* member) {
  const auto found = object.find(member);
  if (found == object.end() || !found->is_string()) return std::nullopt;
  return found->get<std::string>();
}

// Returns the seconds since 1970.
std::optional<double> time_of(const json& claims, const char* claim) {
  const auto found = claims.find(claim);
  if (found == claims.end() || !found->is_number()) return std::nullopt;
  const double seconds = found->get<double>();
  return std::isfinite(seconds) ? std::optional(seconds) : std::nullopt;
}

Result<void> check_audience(const json& claims, const std::string& client_id) {
  const auto audience = claims.find("aud");
  std::size_t others = 0;
  bool is_ours = false;
  if (audience != claims.end() && audience->is_string()) {
    is_ours = *audience == client_id;
  } else if (audience != claims.end() && audience->is_array()) {
    for (const auto& each : *audience) {
      if (each == client_id)
        is_ours = true;
      else
        ++others;
    }
  }
  if (!is_ours) return refused("The token is for another client (aud).");
  const bool has_party = claims.contains("azp");
  if (others > 0 && !has_party)
    return refused("The token is for several clients and names none of them (azp).");
  if (has_party && text_of(claims, "azp") != client_id)
    return refused("The token was issued to another client (azp).");
  return {};
}

Result<void> check_times(const json& claims, std::chrono::system_clock::time_point now_time) {
  const double now = std::chrono::duration<double>(now_time.time_since_epoch()).count();
  const double skew = std::chrono::duration<double>(kClockSkew).count();
  const auto expires = time_of(claims, "exp"), issued = time_of(claims, "iat");
  if (!expires || !issued) return refused("The token lacks a time (exp, iat).");
  if (*expires <= now - skew)
    return refused("The token has expired. Check the clocks of the server and the provider.");
  if (*issued > now + skew)
    return refused(
        "The token is from the future. Check the clocks of the server and the provider.");
  if (claims.contains("nbf")) {
    const auto begins = time_of(claims, "nbf");
    if (!begins || *begins > now + skew) return refused("The token is not valid yet (nbf).");
  }
  return {};
}

}  // namespace

Result<TokenHeader> read_token_header(std::string_view token) {
  if (token.size() > kMaxIdToken) return refused("The token is too long.");
  const auto parts = split(token);
  const auto header = parts ? object_in(parts->header) : std::nullopt;
  if (!header) return refused("The token is not a signed JWT.");
  TokenHeader found;
  const auto algorithm = text_of(*header, "alg");
  if (algorithm == "RS256") {
    found.algorithm = Algorithm::rs256;
  } else if (algorithm == "ES256") {
    found.algorithm = Algorithm::es256;
  } else {
    return refused("The token must be signed with RS256 or ES256 (alg).");
  }
  if (header->contains("crit")) return refused("The token uses an unknown extension (crit).");
  if (header->contains("typ") && to_lower(text_of(*header, "typ").value_or("")) != "jwt")
    return refused("The token is of another type (typ).");
  if (header->contains("kid")) {
    const auto kid = text_of(*header, "kid");
    if (!kid || kid->empty() || kid->size() > kMaxKid)
      return refused("The name of the key is not valid (kid).");
    found.kid = *kid;
  }
  return found;
}

Result<json> verify_id_token(std::string_view token, const KeySet& keys,
                             const ExpectedToken& expected) {
  const auto header = STRATA_TRY(read_token_header(token));
  const Parts parts = *split(token);
  const auto signature = decode(parts.signature);
  if (!keys.has(header.algorithm, header.kid))
    return refused("The provider does not have the key of the token (kid).");
  if (!signature || !keys.verifies(header.algorithm, header.kid, parts.signed_text, *signature))
    return refused("The signature of the token is wrong.");
  auto claims = object_in(parts.payload);
  if (!claims) return refused("The token has no claims.");
  if (text_of(*claims, "iss") != expected.issuer)
    return refused("The token is from another issuer (iss).");
  STRATA_TRY(check_audience(*claims, expected.client_id));
  STRATA_TRY(check_times(*claims, expected.now));
  const auto nonce = text_of(*claims, "nonce");
  if (expected.nonce.empty() || !nonce || !equal_in_constant_time(*nonce, expected.nonce))
    return refused("The token belongs to another sign-in (nonce).");
  const auto subject = text_of(*claims, "sub");
  if (!subject || subject->empty() || subject->size() > kMaxSubject ||
      subject->find('\0') != std::string::npos)
    return refused("The token does not name a person (sub).");
  return std::move(*claims);
}

}  // namespace strata::sign_on
