// Encoding bytes as text, and decoding.
#include <gtest/gtest.h>

#include <random>
#include <string>
#include <vector>

#include "core/digest.h"
#include "core/secret.h"
#include "core/text/ascii.h"
#include "core/text/base64.h"
#include "core/text/hex.h"
#include "core/text/percent.h"

namespace strata {
namespace {

std::vector<std::uint8_t> bytes_of(std::string_view text) { return {text.begin(), text.end()}; }

std::vector<std::uint8_t> random_bytes(std::size_t size) {
  std::mt19937 random(static_cast<unsigned>(size));
  std::vector<std::uint8_t> bytes(size);
  for (auto& byte : bytes) byte = static_cast<std::uint8_t>(random());
  return bytes;
}

TEST(Base64, is_that_of_the_rfc) {
  // The test vectors of RFC 4648, section 10.
  const std::pair<const char*, const char*> known[] = {{"", ""},
                                                       {"f", "Zg=="},
                                                       {"fo", "Zm8="},
                                                       {"foo", "Zm9v"},
                                                       {"foob", "Zm9vYg=="},
                                                       {"fooba", "Zm9vYmE="},
                                                       {"foobar", "Zm9vYmFy"}};
  for (const auto& [plain, text] : known) {
    EXPECT_EQ(to_base64(bytes_of(plain)), text);
    EXPECT_EQ(from_base64(text), bytes_of(plain));
  }
  EXPECT_EQ(to_base64url(std::vector<std::uint8_t>{0xfb, 0xff}), "-_8");
  EXPECT_EQ(from_base64("-_8"), (std::vector<std::uint8_t>{0xfb, 0xff}));
  EXPECT_EQ(from_base64("+/8="), (std::vector<std::uint8_t>{0xfb, 0xff}));
}

TEST(Base64, comes_back_at_every_length) {
  for (std::size_t size = 0; size < 300; ++size) {
    const auto bytes = random_bytes(size);
    EXPECT_EQ(from_base64(to_base64(bytes)), bytes);
    EXPECT_EQ(from_base64(to_base64url(bytes)), bytes);
  }
}

TEST(Base64, what_is_none_is_refused) {
  for (const char* text : {"Z", "Zg=A", "Z!==", "Zm9v Zm9v", "Zm9vY", "\xc3\xa4"})
    EXPECT_FALSE(from_base64(text)) << text;
}

TEST(Base64, bits_left_over_are_ignored) {
  EXPECT_EQ(from_base64("Zh"), bytes_of("f"));
  EXPECT_EQ(from_base64("Zm9="), bytes_of("fo"));
}

TEST(Percent, comes_back) {
  const std::string text = "Fuß/Säule 1+1 = 50 %\n";
  EXPECT_EQ(percent_encode(text), "Fu%C3%9F%2FS%C3%A4ule%201%2B1%20%3D%2050%20%25%0A");
  EXPECT_EQ(percent_decode(percent_encode(text)), text);
  EXPECT_EQ(percent_encode("aZ09-._~"), "aZ09-._~");
}

TEST(Percent, wrong_escapes_are_refused_or_kept) {
  for (const char* text : {"%", "%4", "%zz", "a%4", "%00"})
    EXPECT_FALSE(percent_decode(text)) << text;
  EXPECT_EQ(percent_decode("%4a%4A"), "JJ");
  EXPECT_EQ(percent_decode_leniently("a%20b%2Fc%zz%4"), "a b/c%zz%4");
}

TEST(Hex, has_two_digits_for_a_byte) {
  EXPECT_EQ(to_hex(std::vector<std::uint8_t>{0x00, 0x0a, 0xff}), "000aff");
  EXPECT_EQ(hex_digit_value('9'), 9);
  EXPECT_EQ(hex_digit_value('F'), 15);
  EXPECT_EQ(hex_digit_value('g'), -1);
}

TEST(Trimmed, takes_blanks_off_both_ends) {
  EXPECT_EQ(trimmed(" \t a b \r\n"), "a b");
  EXPECT_EQ(trimmed(""), "");
  EXPECT_EQ(trimmed(" \n "), "");
  EXPECT_EQ(trimmed("\"a\" ", "\" "), "a");
}

TEST(Uuid, has_one_spelling_and_is_read_in_either_case) {
  const auto uuid = parse_uuid("0123aBcd-4567-89AB-cdef-0123456789ab");
  ASSERT_TRUE(uuid);
  EXPECT_EQ(to_string(*uuid), "0123abcd-4567-89ab-cdef-0123456789ab");
  for (const char* text :
       {"", "0123abcd456789abcdef0123456789ab", "{123abcd-4567-89ab-cdef-0123456789ab",
        "0123abcd-4567-89ab-cdef-0123456789ag", "0123abcd-4567-89ab-cdef-0123456789a",
        "0123abcd-456-789ab-cdef-0123456789ab"})
    EXPECT_FALSE(parse_uuid(text)) << text;
}

TEST(Uuid, random_ones_are_of_version_4_and_differ) {
  const std::string a = to_string(random_uuid()), b = to_string(random_uuid());
  EXPECT_NE(a, b);
  EXPECT_EQ(a[14], '4');
  EXPECT_NE(std::string("89ab").find(a[19]), std::string::npos);
  EXPECT_EQ(to_string(*parse_uuid(a)), a);
}

TEST(Digest, the_same_key_makes_the_same_valid_uuid) {
  const Uuid a = uuid_of_text("key"), b = uuid_of_text("key"), c = uuid_of_text("other");
  EXPECT_EQ(a, b);
  EXPECT_NE(a, c);
  EXPECT_EQ(parse_uuid(to_string(a)), a);
  EXPECT_EQ(sha256_hex("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}

TEST(Digest, a_stream_has_the_sum_of_the_whole) {
  const auto bytes = random_bytes(1000);
  Sha256Stream stream;
  stream.add(std::span(bytes).first(1));
  stream.add(std::span(bytes).subspan(1));
  EXPECT_EQ(stream.finish(), sha256(bytes));
}

TEST(Secret, tokens_differ_and_are_compared) {
  EXPECT_EQ(random_token().size(), 43U);
  EXPECT_NE(random_token(), random_token());
  EXPECT_TRUE(equal_in_constant_time("abc", "abc"));
  EXPECT_FALSE(equal_in_constant_time("abc", "abd"));
  EXPECT_FALSE(equal_in_constant_time("abc", "abcd"));
}

}  // namespace
}  // namespace strata
