#include "net/http/router.h"

#include <gtest/gtest.h>

namespace strata::net {
namespace {

Router make_router() {
  Router router;
  auto nothing = [](const Request&, const Respond&) {};
  router.add({.method = Method::get,
              .pattern = "/api/v1/models",
              .handler = nothing,
              .query = {"limit", "offset"}});
  router.add({.method = Method::post, .pattern = "/api/v1/models", .handler = nothing});
  router.add({.method = Method::get,
              .pattern = "/api/v1/models/{model}/layers/{layer}/texels.{format}",
              .handler = nothing});
  router.add({.method = Method::remove, .pattern = "/api/v1/jobs/{job}", .handler = nothing});
  return router;
}

std::vector<std::string> segments(const std::string& target) {
  Request request;
  EXPECT_TRUE(parse_target(target, request));
  return request.segments;
}

TEST(Router, a_pattern_catches_the_parts_of_a_path) {
  const Router router = make_router();
  const auto match =
      router.find(Method::get, segments("/api/v1/models/pot/layers/cracks/texels.png"));
  ASSERT_NE(match.route, nullptr);
  EXPECT_EQ(match.params.at("model"), "pot");
  EXPECT_EQ(match.params.at("layer"), "cracks");
  EXPECT_EQ(match.params.at("format"), "png");
}

TEST(Router, a_caught_part_is_never_empty) {
  const Router router = make_router();
  EXPECT_EQ(router.find(Method::get, segments("/api/v1/models/pot/layers/cracks/texels.")).route,
            nullptr);
  EXPECT_EQ(router.find(Method::remove, segments("/api/v1/jobs/")).route, nullptr);
}

TEST(Router, a_segment_can_have_several_parts) {
  Router router;
  auto nothing = [](const Request&, const Respond&) {};
  for (const char* id : {"{model}.{layer}.{column}", "{model}.{layer}", "{model}"})
    router.add({.method = Method::get, .pattern = std::string("/ogc/") + id, .handler = nothing});
  using Params = std::map<std::string, std::string>;
  const auto params = [&](const char* path) {
    return router.find(Method::get, segments(path)).params;
  };
  EXPECT_EQ(params("/ogc/wall"), (Params{{"model", "wall"}}));
  EXPECT_EQ(params("/ogc/wall.salts"), (Params{{"model", "wall"}, {"layer", "salts"}}));
  EXPECT_EQ(params("/ogc/wall.salts.a"),
            (Params{{"model", "wall"}, {"layer", "salts"}, {"column", "a"}}));
  EXPECT_EQ(params("/ogc/wall.salts.a.b").at("column"), "a.b");
  // Empty parts are not parts, so a shorter pattern finds these.
  EXPECT_EQ(params("/ogc/wall."), (Params{{"model", "wall."}}));
  EXPECT_EQ(params("/ogc/.salts"), (Params{{"model", ".salts"}}));
}

TEST(Router, head_finds_what_get_finds) {
  const Router router = make_router();
  EXPECT_NE(router.find(Method::head, segments("/api/v1/models")).route, nullptr);
  EXPECT_EQ(router.find(Method::head, segments("/api/v1/jobs/1")).route, nullptr);
}

TEST(Router, a_known_path_with_another_method_names_the_allowed_ones) {
  const Router router = make_router();
  const auto match = router.find(Method::remove, segments("/api/v1/models"));
  EXPECT_EQ(match.route, nullptr);
  EXPECT_EQ(allow_header(match.allowed), "GET, HEAD, POST, OPTIONS");
}

TEST(Router, an_unknown_path_allows_nothing) {
  const Router router = make_router();
  for (const char* target :
       {"/api/v1/nothing", "/api/v1/models/pot/layers", "/api/v1", "/api/v1/models/"}) {
    const auto match = router.find(Method::get, segments(target));
    EXPECT_EQ(match.route, nullptr) << target;
    EXPECT_TRUE(match.allowed.empty()) << target;
  }
}

TEST(Router, an_escaped_slash_stays_inside_its_segment) {
  const Router router = make_router();
  const auto match = router.find(Method::remove, segments("/api/v1/jobs/a%2Fb"));
  ASSERT_NE(match.route, nullptr);
  EXPECT_EQ(match.params.at("job"), "a/b");
}

TEST(Router, an_unknown_query_parameter_is_refused_by_name) {
  const Router router = make_router();
  Request request;
  ASSERT_TRUE(parse_target("/api/v1/models?limit=3&colour=red", request));
  const auto match = router.find(Method::get, request.segments);
  const auto refused = check_query(*match.route, request);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::malformed);
  EXPECT_EQ(refused.error().field, "colour");
  EXPECT_NE(refused.error().detail.find("limit, offset"), std::string::npos);
}

}  // namespace
}  // namespace strata::net
