#include "sign_on/client.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>

#include "core/digest.h"
#include "core/text/base64.h"
#include "core/text/url.h"
#include "support/signed_tokens.h"

namespace strata::sign_on {
namespace {

using nlohmann::json;
using std::chrono::seconds;
using std::chrono::system_clock;
using test::TokenKey;
using ::testing::HasSubstr;

const std::string kIssuer = "https://login.museum.example";
const std::string kRedirect = "https://strata.museum.example/sign-in/museum/callback";
const Handshake kHandshake{"the state", "the nonce", "the verifier"};

// A provider that answers without a network.
class FakeProvider {
 public:
  FakeProvider() {
    document = {{"issuer", kIssuer},
                {"authorization_endpoint", kIssuer + "/auth"},
                {"token_endpoint", kIssuer + "/token"},
                {"jwks_uri", kIssuer + "/keys"},
                {"userinfo_endpoint", kIssuer + "/me"}};
    publish(key);
  }
  Client client(const std::function<void(Provider&)>& change = [](Provider&) {}) {
    Provider provider;
    provider.id = "museum";
    provider.issuer = kIssuer;
    provider.client_id = "strata";
    change(provider);
    return Client(
        provider, [this](const HttpCall& call) { return answer(call); }, [this] { return now; });
  }
  void publish(const TokenKey& published) {
    keys = {{"keys", json::array({published.public_jwk()})}};
  }
  json claims() const {
    const auto time = system_clock::to_time_t(now);
    return {{"iss", kIssuer}, {"aud", "strata"},   {"sub", "s1"},
            {"iat", time},    {"exp", time + 300}, {"nonce", kHandshake.nonce}};
  }
  int calls_of(const std::string& path) { return calls[kIssuer + path]; }

  TokenKey key = TokenKey::rsa("k1");
  json document, keys, userinfo{{"sub", "s1"}, {"groups", {"staff"}}};
  std::optional<HttpReply> token_reply;
  bool is_down = false;
  system_clock::time_point now = system_clock::from_time_t(1'700'000'000);
  std::map<std::string, int> calls;
  HttpCall last_token_call;

 private:
  Result<HttpReply> answer(const HttpCall& call) {
    ++calls[call.url];
    if (is_down) return fail(ErrorCode::bad_gateway, "Provider unreachable", "It is down.");
    const std::string path = call.url.substr(kIssuer.size());
    if (path == "/.well-known/openid-configuration") return HttpReply{200, document.dump()};
    if (path == "/keys") return HttpReply{200, keys.dump()};
    if (path == "/me") return HttpReply{200, userinfo.dump()};
    last_token_call = call;
    if (token_reply) return *token_reply;
    return HttpReply{200,
                     json{{"id_token", key.sign(claims())}, {"access_token", "access"}}.dump()};
  }
};

TEST(SignOnClient, the_address_at_the_provider_has_all_parameters) {
  FakeProvider provider;
  Client client = provider.client();
  const auto url = client.authorization_url(kRedirect, kHandshake);
  ASSERT_TRUE(url) << url.error().detail;
  EXPECT_THAT(*url, ::testing::StartsWith(kIssuer + "/auth?response_type=code&client_id=strata"));
  EXPECT_THAT(*url, HasSubstr("redirect_uri=https%3A%2F%2Fstrata.museum.example%2Fsign-in"));
  EXPECT_THAT(*url, HasSubstr("&scope=openid%20profile&state=the%20state&nonce=the%20nonce"));
  EXPECT_THAT(
      *url, HasSubstr("&code_challenge=" + to_base64url(sha256(std::string_view("the verifier"))) +
                      "&code_challenge_method=S256"));
  EXPECT_EQ(url->find("verifier"), std::string::npos);
  ASSERT_TRUE(client.authorization_url(kRedirect, kHandshake));
  EXPECT_EQ(provider.calls_of("/.well-known/openid-configuration"), 1);
}

TEST(SignOnClient, handshakes_are_random) {
  const Handshake a = Handshake::make(), b = Handshake::make();
  EXPECT_NE(a.state, b.state);
  EXPECT_NE(a.nonce, b.nonce);
  EXPECT_NE(a.code_verifier, b.code_verifier);
  EXPECT_GE(a.code_verifier.size(), 43u);
}

TEST(SignOnClient, a_code_is_exchanged_for_claims) {
  FakeProvider provider;
  Client client = provider.client([](Provider& of) { of.client_secret = "s:e/c"; });
  const auto claims = client.claims({"the code", {}}, kRedirect, kHandshake);
  ASSERT_TRUE(claims) << claims.error().detail;
  EXPECT_EQ(claims->at("sub"), "s1");
  const HttpCall& call = provider.last_token_call;
  EXPECT_THAT(*call.form, HasSubstr("grant_type=authorization_code&code=the%20code"));
  EXPECT_THAT(*call.form, HasSubstr("&code_verifier=the%20verifier"));
  EXPECT_EQ(call.form->find("client_secret"), std::string::npos);
  // strata:s%3Ae%2Fc
  EXPECT_THAT(call.headers,
              ::testing::ElementsAre("Authorization: Basic c3RyYXRhOnMlM0FlJTJGYw=="));
}

TEST(SignOnClient, the_secret_is_sent_as_the_provider_expects_it) {
  FakeProvider provider;
  provider.document["token_endpoint_auth_methods_supported"] = {"client_secret_post"};
  Client in_form = provider.client([](Provider& of) { of.client_secret = "secret"; });
  ASSERT_TRUE(in_form.claims({"c", {}}, kRedirect, kHandshake));
  EXPECT_THAT(*provider.last_token_call.form, HasSubstr("client_id=strata&client_secret=secret"));
  Client open = provider.client();
  ASSERT_TRUE(open.claims({"c", {}}, kRedirect, kHandshake));
  EXPECT_THAT(*provider.last_token_call.form, HasSubstr("client_id=strata"));
  EXPECT_TRUE(provider.last_token_call.headers.empty());
}

TEST(SignOnClient, a_discovery_document_of_another_issuer_is_refused) {
  for (const auto& [member, value] :
       std::map<std::string, json>{{"issuer", kIssuer + "/"},
                                   {"token_endpoint", "http://login.museum.example/token"},
                                   {"jwks_uri", nullptr},
                                   {"authorization_endpoint", "javascript:alert(1)"}}) {
    FakeProvider provider;
    provider.document[member] = value;
    Client client = provider.client();
    const auto url = client.authorization_url(kRedirect, kHandshake);
    ASSERT_FALSE(url) << member;
    EXPECT_EQ(url.error().code, ErrorCode::bad_gateway);
  }
}

TEST(SignOnClient, a_provider_that_is_down_is_not_asked_at_once_again) {
  FakeProvider provider;
  provider.is_down = true;
  Client client = provider.client();
  for (int i = 0; i < 3; ++i) EXPECT_FALSE(client.authorization_url(kRedirect, kHandshake));
  EXPECT_EQ(provider.calls_of("/.well-known/openid-configuration"), 1);
  provider.is_down = false;
  provider.now += seconds(6);
  EXPECT_TRUE(client.authorization_url(kRedirect, kHandshake));
  provider.is_down = true;
  provider.now += std::chrono::hours(2);
  EXPECT_TRUE(client.authorization_url(kRedirect, kHandshake)) << "the old document";
}

TEST(SignOnClient, new_keys_are_loaded_but_not_for_each_unknown_key) {
  FakeProvider provider;
  Client client = provider.client();
  ASSERT_TRUE(client.claims({"c", {}}, kRedirect, kHandshake));
  EXPECT_EQ(provider.calls_of("/keys"), 1);
  provider.key = TokenKey::rsa("k2");
  provider.publish(provider.key);
  EXPECT_FALSE(client.claims({"c", {}}, kRedirect, kHandshake)) << "loaded a moment ago";
  EXPECT_EQ(provider.calls_of("/keys"), 1);
  provider.now += seconds(31);
  EXPECT_TRUE(client.claims({"c", {}}, kRedirect, kHandshake));
  EXPECT_EQ(provider.calls_of("/keys"), 2);
  const TokenKey forged = TokenKey::rsa("k3");
  provider.token_reply = {200, json{{"id_token", forged.sign(provider.claims())}}.dump()};
  for (int i = 0; i < 3; ++i) EXPECT_FALSE(client.claims({"c", {}}, kRedirect, kHandshake));
  EXPECT_EQ(provider.calls_of("/keys"), 2);
}

TEST(SignOnClient, failures_of_the_exchange_have_their_codes) {
  const auto code_of = [](const HttpReply& reply) {
    FakeProvider provider;
    provider.token_reply = reply;
    Client client = provider.client();
    const auto claims = client.claims({"c", {}}, kRedirect, kHandshake);
    return claims ? std::string("none") : std::string(name(claims.error().code));
  };
  const std::string refused(name(ErrorCode::unauthenticated)), broken(name(ErrorCode::bad_gateway));
  EXPECT_EQ(code_of({400, R"({"error":"invalid_grant"})"}), refused);
  EXPECT_EQ(code_of({401, R"({"error":"invalid_client"})"}), broken);
  EXPECT_EQ(code_of({500, ""}), broken);
  EXPECT_EQ(code_of({302, ""}), broken);
  EXPECT_EQ(code_of({200, "no JSON"}), broken);
  EXPECT_EQ(code_of({200, "{}"}), broken);
  EXPECT_EQ(code_of({200, R"({"id_token":"forged"})"}), refused);
}

TEST(SignOnClient, a_response_of_another_provider_is_refused) {
  FakeProvider provider;
  provider.document["authorization_response_iss_parameter_supported"] = true;
  Client client = provider.client();
  EXPECT_TRUE(client.claims({"c", kIssuer}, kRedirect, kHandshake));
  for (const std::optional<std::string>& issuer :
       {std::optional<std::string>(), std::optional<std::string>("https://evil.example")})
    EXPECT_EQ(client.claims({"c", issuer}, kRedirect, kHandshake).error().code,
              ErrorCode::unauthenticated);
}

TEST(SignOnClient, user_information_adds_claims_of_the_same_person) {
  FakeProvider provider;
  Client client = provider.client([](Provider& of) { of.userinfo = true; });
  const auto claims = client.claims({"c", {}}, kRedirect, kHandshake);
  ASSERT_TRUE(claims) << claims.error().detail;
  EXPECT_EQ(claims->at("groups"), json({"staff"}));
  provider.userinfo["iss"] = "https://evil.example";
  EXPECT_EQ(client.claims({"c", {}}, kRedirect, kHandshake)->at("iss"), kIssuer);
  provider.userinfo["sub"] = "s2";
  EXPECT_EQ(client.claims({"c", {}}, kRedirect, kHandshake).error().code,
            ErrorCode::unauthenticated);
}

TEST(SignOnUrls, only_this_machine_may_use_http) {
  for (const char* url : {"https://a", "https://a:8443/b?c", "http://127.0.0.1:1/",
                          "http://[::1]:1", "http://localhost"})
    EXPECT_TRUE(is_safe_url(url)) << url;
  for (const char* url : {"http://a", "https://", "https:///a", "https://[::1", "ftp://a", "a", "",
                          "http://127.0.0.1@a/", "https://a\n", "https://a/#b"})
    EXPECT_FALSE(is_safe_url(url)) << url;
}

TEST(SignOnFetch, addresses_that_are_not_safe_are_refused) {
  EXPECT_EQ(fetch({.url = "http://museum.example/"}).error().code, ErrorCode::bad_gateway);
  EXPECT_EQ(fetch({.url = "file:///etc/passwd"}).error().code, ErrorCode::bad_gateway);
}

}  // namespace
}  // namespace strata::sign_on
