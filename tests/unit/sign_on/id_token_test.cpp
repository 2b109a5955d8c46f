#include "sign_on/id_token.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/signed_tokens.h"

namespace strata::sign_on {
namespace {

using nlohmann::json;
using test::TokenKey;
using ::testing::HasSubstr;

constexpr std::int64_t kNow = 1'700'000'000;

const TokenKey& rsa() {
  static const TokenKey key = TokenKey::rsa("r1");
  return key;
}
const TokenKey& p256() {
  static const TokenKey key = TokenKey::p256("e1");
  return key;
}
const TokenKey& stranger() {
  static const TokenKey key = TokenKey::rsa("r1");
  return key;
}

json good_claims() {
  return {{"iss", "https://login.museum.example"},
          {"aud", "strata"},
          {"sub", "s1"},
          {"exp", kNow + 300},
          {"iat", kNow},
          {"nonce", "the nonce"}};
}
json with(const std::string& name, const json& value) {
  json claims = good_claims();
  claims[name] = value;
  return claims;
}
json without(const std::string& name) {
  json claims = good_claims();
  claims.erase(name);
  return claims;
}

KeySet keys(std::initializer_list<json> list = {rsa().public_jwk(), p256().public_jwk()}) {
  return KeySet::parse(json{{"keys", list}}.dump()).value();
}
Result<json> verify(const std::string& token, const KeySet& set = keys()) {
  return verify_id_token(token, set,
                         {"https://login.museum.example", "strata", "the nonce",
                          std::chrono::system_clock::from_time_t(kNow)});
}
// Returns the reason why the token is refused, or an empty text.
std::string refusal(const std::string& token, const KeySet& set = keys()) {
  const auto verified = verify(token, set);
  if (verified) return {};
  EXPECT_EQ(verified.error().code, ErrorCode::unauthenticated);
  return verified.error().detail;
}

TEST(IdToken, tokens_with_both_algorithms_are_valid) {
  const auto by_rsa = verify(rsa().sign(good_claims()));
  ASSERT_TRUE(by_rsa) << by_rsa.error().detail;
  EXPECT_EQ(by_rsa->at("sub"), "s1");
  EXPECT_EQ(refusal(p256().sign(good_claims())), "");
}

TEST(IdToken, a_token_without_a_signature_is_refused) {
  const json none{{"alg", "none"}, {"kid", "r1"}};
  const std::string text =
      test::base64url_of(none.dump()) + "." + test::base64url_of(good_claims().dump()) + ".";
  EXPECT_THAT(refusal(text), HasSubstr("alg"));
  EXPECT_THAT(refusal(text + "AAAA"), HasSubstr("alg"));
  const std::string whole = rsa().sign(good_claims());
  EXPECT_THAT(refusal(whole.substr(0, whole.rfind('.') + 1)), HasSubstr("signature"));
  EXPECT_NE(refusal(whole.substr(0, whole.rfind('.'))), "");
}

TEST(IdToken, the_public_key_is_not_a_secret_of_hs256) {
  for (const char* algorithm : {"HS256", "hs256", "RS256"}) {
    const json header{{"alg", algorithm}, {"kid", "r1"}};
    EXPECT_NE(refusal(test::sign_hs256(header, good_claims(), rsa().public_pem())), "");
  }
}

TEST(IdToken, other_algorithms_are_refused) {
  for (const json& algorithm : {json("RS384"), json("PS256"), json("ES384"), json("EdDSA"),
                                json("None"), json(""), json(256), json(nullptr)})
    EXPECT_THAT(refusal(rsa().sign({{"alg", algorithm}, {"kid", "r1"}}, good_claims())),
                HasSubstr("alg"));
  EXPECT_THAT(refusal(rsa().sign({{"kid", "r1"}}, good_claims())), HasSubstr("alg"));
}

TEST(IdToken, a_key_is_used_only_with_its_algorithm) {
  EXPECT_NE(refusal(rsa().sign({{"alg", "ES256"}, {"kid", "r1"}}, good_claims())), "");
  EXPECT_NE(refusal(p256().sign({{"alg", "RS256"}, {"kid", "e1"}}, good_claims())), "");
}

TEST(IdToken, the_key_must_be_that_of_the_provider) {
  EXPECT_THAT(refusal(stranger().sign(good_claims())), HasSubstr("signature"));
  EXPECT_THAT(refusal(TokenKey::rsa("r2").sign(good_claims())), HasSubstr("kid"));
  // a key in the header is not a key of the provider
  const json header{{"alg", "RS256"}, {"kid", "r1"}, {"jwk", stranger().public_jwk()}};
  EXPECT_THAT(refusal(stranger().sign(header, good_claims())), HasSubstr("signature"));
}

TEST(IdToken, a_token_without_a_key_name_needs_a_single_key) {
  const std::string token = rsa().sign({{"alg", "RS256"}}, good_claims());
  EXPECT_EQ(refusal(token), "") << "the other key has another algorithm";
  EXPECT_THAT(refusal(token, keys({rsa().public_jwk(), TokenKey::rsa("r2").public_jwk()})),
              HasSubstr("kid"));
  for (const json& kid : {json(""), json(1), json(std::string(256, 'k'))})
    EXPECT_THAT(refusal(rsa().sign({{"alg", "RS256"}, {"kid", kid}}, good_claims())),
                HasSubstr("kid"));
}

TEST(IdToken, a_changed_token_is_refused) {
  const std::string token = rsa().sign(good_claims()), other = rsa().sign(with("sub", "s2"));
  const auto first = token.find('.'), last = token.rfind('.');
  const auto other_first = other.find('.'), other_last = other.rfind('.');
  EXPECT_THAT(refusal(token.substr(0, first) + other.substr(other_first, other_last - other_first) +
                      token.substr(last)),
              HasSubstr("signature"));
  const std::string by_curve = p256().sign(good_claims());
  EXPECT_NE(refusal(by_curve.substr(0, by_curve.size() - 4)), "");
  EXPECT_NE(refusal(by_curve + "AAAA"), "");
  // two zeros are no signature (CVE-2022-21449)
  EXPECT_NE(refusal(by_curve.substr(0, by_curve.rfind('.') + 1) + std::string(86, 'A')), "");
}

TEST(IdToken, extensions_and_other_types_are_refused) {
  EXPECT_THAT(
      refusal(rsa().sign({{"alg", "RS256"}, {"kid", "r1"}, {"crit", {"b64"}}}, good_claims())),
      HasSubstr("crit"));
  EXPECT_THAT(
      refusal(rsa().sign({{"alg", "RS256"}, {"kid", "r1"}, {"typ", "at+jwt"}}, good_claims())),
      HasSubstr("typ"));
}

TEST(IdToken, the_issuer_must_be_equal) {
  for (const json& issuer : {json("https://evil.example"), json("https://login.museum.example/"),
                             json("HTTPS://login.museum.example"), json(nullptr),
                             json({"https://login.museum.example"})})
    EXPECT_THAT(refusal(rsa().sign(with("iss", issuer))), HasSubstr("iss"));
  EXPECT_THAT(refusal(rsa().sign(without("iss"))), HasSubstr("iss"));
}

TEST(IdToken, the_audience_must_be_this_client) {
  for (const json& audience :
       {json("other"), json({"other"}), json(json::array()), json(7), json(nullptr)})
    EXPECT_THAT(refusal(rsa().sign(with("aud", audience))), HasSubstr("aud"));
  EXPECT_THAT(refusal(rsa().sign(without("aud"))), HasSubstr("aud"));
  EXPECT_EQ(refusal(rsa().sign(with("aud", {"strata"}))), "");
  EXPECT_THAT(refusal(rsa().sign(with("aud", {"strata", "other"}))), HasSubstr("azp"));
  json both = with("aud", {"strata", "other"});
  both["azp"] = "strata";
  EXPECT_EQ(refusal(rsa().sign(both)), "");
  EXPECT_THAT(refusal(rsa().sign(with("azp", "other"))), HasSubstr("azp"));
}

TEST(IdToken, the_times_must_fit) {
  EXPECT_EQ(refusal(rsa().sign(with("exp", kNow - 59))), "") << "clocks may differ a little";
  EXPECT_THAT(refusal(rsa().sign(with("exp", kNow - 60))), HasSubstr("expired"));
  EXPECT_THAT(refusal(rsa().sign(with("exp", "9999999999"))), HasSubstr("exp"));
  EXPECT_THAT(refusal(rsa().sign(without("exp"))), HasSubstr("exp"));
  EXPECT_THAT(refusal(rsa().sign(without("iat"))), HasSubstr("iat"));
  EXPECT_EQ(refusal(rsa().sign(with("iat", kNow + 60))), "");
  EXPECT_THAT(refusal(rsa().sign(with("iat", kNow + 61))), HasSubstr("future"));
  EXPECT_THAT(refusal(rsa().sign(with("nbf", kNow + 61))), HasSubstr("nbf"));
}

TEST(IdToken, the_nonce_must_be_that_of_the_sign_in) {
  for (const json& nonce : {json("another"), json(""), json(nullptr), json({"the nonce"})})
    EXPECT_THAT(refusal(rsa().sign(with("nonce", nonce))), HasSubstr("nonce"));
  EXPECT_THAT(refusal(rsa().sign(without("nonce"))), HasSubstr("nonce"));
}

TEST(IdToken, a_token_names_a_person) {
  for (const json& subject :
       {json(""), json(7), json(std::string(256, 's')), json(std::string("s\0", 2))})
    EXPECT_THAT(refusal(rsa().sign(with("sub", subject))), HasSubstr("sub"));
  EXPECT_THAT(refusal(rsa().sign(without("sub"))), HasSubstr("sub"));
}

TEST(IdToken, malformed_and_large_tokens_are_refused) {
  const std::string token = rsa().sign(good_claims());
  for (const std::string& text :
       {std::string(), std::string("."), std::string(".."), std::string("..."), token + ".x",
        "." + token, token + "=", " " + token, std::string("bm90IGpzb24.e30.AAAA"),
        std::string("W10.e30.AAAA"), std::string(kMaxIdToken + 1, 'a')})
    EXPECT_NE(refusal(text), "") << text.substr(0, 60);
  EXPECT_THAT(refusal(rsa().sign(with("more", std::string(kMaxIdToken, 'x')))),
              HasSubstr("too long"));
  EXPECT_NE(refusal(rsa().sign(json::array())), "");
}

TEST(KeySet, weak_and_foreign_keys_are_left_out) {
  json weak_exponent = rsa().public_jwk();
  weak_exponent["e"] = "AQ";
  json for_encryption = rsa().public_jwk();
  for_encryption["use"] = "enc";
  json off_the_curve = p256().public_jwk();
  off_the_curve["x"] = off_the_curve["y"];
  for (const json& key :
       {TokenKey::rsa("weak", 1024).public_jwk(), weak_exponent, for_encryption, off_the_curve,
        json{{"kty", "oct"}, {"k", "c2VjcmV0"}}, json{{"kty", "RSA"}}, json(7)})
    EXPECT_EQ(keys({key}).size(), 0u) << key;
}

TEST(KeySet, texts_that_are_no_sets_are_refused) {
  for (const std::string text : {"", "[]", "{}", R"({"keys":{}})", R"({"keys":[)"})
    EXPECT_EQ(KeySet::parse(text).error().code, ErrorCode::bad_gateway) << text;
  EXPECT_FALSE(KeySet::parse(json{{"keys", std::vector<int>(65)}}.dump()));
}

}  // namespace
}  // namespace strata::sign_on
