#include <gtest/gtest.h>

#include "net/http/compression.h"
#include "net/http/entity_tags.h"

namespace strata::net {
namespace {

Request request_to(const std::string& target, const std::string& user = "ada",
                   Role role = Role::viewer) {
  Request request;
  EXPECT_TRUE(parse_target(target, request)) << target;
  request.principal = Principal{.user = user, .role = role};
  return request;
}

TEST(EntityTags, are_named_one_by_one_weakly_or_all_at_once) {
  for (const char* named :
       {"\"a\"", "W/\"a\"", "*", "\"x\", \"a\"", "\"x\",W/\"a\" ,\"y\"", " \"a\" "})
    EXPECT_TRUE(names_tag(named, "\"a\"")) << named;
  for (const char* named : {"", "a", "\"A\"", "\"ab\"", "\"a", ",", "\"x\", \"y\"", "**"})
    EXPECT_FALSE(names_tag(named, "\"a\"")) << named;
  EXPECT_TRUE(names_tag("\"a\"", "W/\"a\""));
  EXPECT_FALSE(names_tag("*", "")) << "there is none";
}

TEST(EntityTags, of_a_state_are_of_who_asks_for_what_in_which_format) {
  const std::string tag = tag_of_state(request_to("/a/b?x=1"), "state");
  EXPECT_EQ(tag, tag_of_state(request_to("/a/b?x=1"), "state"));
  EXPECT_EQ(tag.size(), 34u);
  for (const Request& other :
       {request_to("/a/b?x=2"), request_to("/a/b"), request_to("/ab?x=1"), request_to("/a/b/?x=1"),
        request_to("/a/b?x=1&y="), request_to("/a/b?x=1", "eve"),
        request_to("/a/b?x=1", "ada", Role::curator)})
    EXPECT_NE(tag, tag_of_state(other, "state")) << other.target;
  Request as_csv = request_to("/a/b?x=1");
  as_csv.headers = {{"accept", "text/csv"}};
  EXPECT_NE(tag, tag_of_state(as_csv, "state"));
  Request of_kiosk = request_to("/a/b?x=1");
  of_kiosk.principal->kiosk = KioskPass{.id = 3};
  EXPECT_NE(tag, tag_of_state(of_kiosk, "state"));
  EXPECT_NE(tag, tag_of_state(request_to("/a/b?x=1"), "state2"));
}

TEST(EntityTags, of_a_body_are_of_its_bytes_where_it_may_be_kept) {
  const auto tag = tag_of_body(text_response("{}", "application/json"));
  ASSERT_TRUE(tag);
  EXPECT_EQ(tag, tag_of_body(bytes_response({'{', '}'}, "application/json")));
  EXPECT_NE(tag, tag_of_body(text_response("{ }", "application/json")));
  EXPECT_FALSE(
      tag_of_body(text_response("{}", "application/json").with("Cache-Control", "no-store")));
  EXPECT_FALSE(tag_of_body(text_response("{}", "application/json").with("ETag", "\"v1\"")));
  EXPECT_FALSE(tag_of_body(empty_response(200)));
  Response stream, file;
  stream.stream.emplace();
  file.file = "/tmp/x";
  EXPECT_FALSE(tag_of_body(stream));
  EXPECT_FALSE(tag_of_body(file));
}

TEST(EntityTags, what_did_not_change_has_no_body_and_says_nothing_of_one) {
  Response response = text_response("{}", "application/json");
  response.with("Content-Disposition", "attachment")
      .with("ETag", "\"a\"")
      .with("Strata-Sequence", "7")
      .with("Vary", "Accept");
  const Response unchanged = not_modified(std::move(response));
  EXPECT_EQ(unchanged.status, 304);
  EXPECT_TRUE(unchanged.body.empty());
  EXPECT_EQ(unchanged.headers,
            (Headers{{"ETag", "\"a\""}, {"Strata-Sequence", "7"}, {"Vary", "Accept"}}));
}

TEST(EntityTags, a_client_that_knows_a_coding_is_told_the_tag_of_that) {
  for (const auto& [known, expected] :
       {std::pair("\"a-br\"", "\"a-br\""), std::pair("W/\"a-gzip\"", "\"a-gzip\""),
        std::pair("\"a\", \"a-br\"", "\"a\""), std::pair("*", "\"a\"")}) {
    Request request;
    request.headers = {{"if-none-match", known}};
    forget_codings(request);
    EXPECT_TRUE(names_tag(request.header("if-none-match"), "\"a\"")) << known;
    Response response = empty_response(304).with("ETag", "\"a\"");
    compress(response, "br", request.known_tags);
    EXPECT_EQ(response.header("ETag"), expected) << known;
    EXPECT_EQ(response.header("Vary"), "Accept-Encoding");
  }
}

}  // namespace
}  // namespace strata::net
