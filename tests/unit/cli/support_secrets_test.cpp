#include <gtest/gtest.h>

#include "cli/support_secrets.h"
#include "core/digest.h"
#include "core/secret.h"

namespace strata::cli {
namespace {

std::string hash_of(const std::string& token) {
  const Sha256 hash = sha256(token);
  return {reinterpret_cast<const char*>(hash.data()), hash.size()};
}

TEST(KnownSecrets, a_secret_is_found_in_any_text) {
  KnownSecrets secrets;
  secrets.add("the password", "heron river stone");
  EXPECT_EQ(secrets.find_in("x heron river stone y"), "the password");
  EXPECT_FALSE(secrets.find_in("heron river"));
  EXPECT_FALSE(secrets.find_in(""));
}

TEST(KnownSecrets, a_secret_is_found_as_json_writes_it) {
  KnownSecrets secrets;
  secrets.add("the password", "he\"ron\\");
  EXPECT_TRUE(secrets.find_in(R"({"a": "he\"ron\\"})"));
}

TEST(KnownSecrets, a_short_secret_counts_as_a_whole_word) {
  KnownSecrets secrets;
  secrets.add("the password", "abc");
  EXPECT_FALSE(secrets.find_in("abcd xabc abc_"));
  EXPECT_TRUE(secrets.find_in("password=abc"));
  secrets.add("nothing", "");
  EXPECT_FALSE(secrets.find_in("text"));
}

TEST(KnownSecrets, a_token_is_found_by_its_hash) {
  const std::string token = random_token();
  KnownSecrets secrets;
  secrets.hashes.insert(hash_of(token));
  EXPECT_TRUE(secrets.find_in("link=" + token));
  EXPECT_TRUE(secrets.find_in("/kiosk/" + token + "/x"));
  EXPECT_TRUE(secrets.find_in("x-" + token + "_y"));  // next to other characters of tokens
  EXPECT_FALSE(secrets.find_in("link=" + random_token()));
}

TEST(KnownSecrets, a_private_key_is_a_secret) {
  EXPECT_TRUE(KnownSecrets().find_in("-----BEGIN EC PRIVATE KEY-----\n"));
  EXPECT_FALSE(KnownSecrets().find_in("-----BEGIN CERTIFICATE-----\n"));
}

TEST(Redacted, what_has_the_form_of_a_secret_is_replaced) {
  const std::string token = random_token();
  EXPECT_EQ(redacted("owner link: http://a/login?link=" + token + "\n"),
            "owner link: http://a/login?link=[secret]\n");
  EXPECT_EQ(redacted("GET /kiosk/short-one 200"), "GET /kiosk/[secret] 200");
  EXPECT_EQ(redacted("postgresql://ada:river@db/strata"), "postgresql://ada:[secret]@db/strata");
  EXPECT_EQ(redacted("host=db password='ri ver' user=ada"), "host=db password=[secret] user=ada");
  EXPECT_EQ(redacted("Authorization: Bearer abc.def"), "Authorization: Bearer [secret]");
  EXPECT_EQ(redacted("x " + token + " y"), "x [token] y");
}

TEST(Redacted, values_of_rows_are_left_out) {
  EXPECT_EQ(redacted("ERROR:  duplicate key\nDETAIL:  Key (name)=(Ada) exists.\n\tmore\nnext\n"),
            "ERROR:  duplicate key\nDETAIL:  [left out]\n\t[left out]\nnext\n");
}

TEST(Redacted, other_text_is_kept) {
  for (const char* text :
       {"", "\n", "2026-01-02T03:04:05.678 I [room] slow edit op=stroke queue_ms=1.2\n",
        "trace_id=4bf92f3577b34da6a3ce929d0e0e4736", "0b6fbb21-7e3c-4b1c-9a55-2a2f6a1a9c01",
        "no newline at the end"})
    EXPECT_EQ(redacted(text), text);
}

TEST(Redacted, a_very_long_line_is_left_out) {
  EXPECT_EQ(redacted(std::string(5000, ' ') + "\nnext"),
            "[a line of 5000 characters was left out]\nnext");
}

TEST(Pseudonyms, a_name_has_the_same_pseudonym_everywhere) {
  const Pseudonyms people({"owner", "ada", "Ada Lovelace", "Zoë"});
  EXPECT_EQ(people.replaced_in("ada: ADA, canada, ada_1; Ada Lovelace; Zoë"),
            "person-1: person-1, canada, ada_1; person-2; person-3");
  EXPECT_EQ(people.replaced_in("owner"), "owner");
}

TEST(Pseudonyms, folders_of_users_have_no_names) {
  EXPECT_EQ(Pseudonyms({}).replaced_in("/home/maria/strata and '/home/jan'"),
            "/home/[person]/strata and '/home/[person]'");
}

}  // namespace
}  // namespace strata::cli
