#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "core/log.h"
#include "core/trace.h"

namespace strata::log {
namespace {

TEST(LogLevels, one_level_applies_to_all_modules) {
  const auto levels = parse_levels("warning");
  ASSERT_TRUE(levels);
  for (std::size_t i = 0; i < kModules; ++i)
    EXPECT_EQ(levels->of(static_cast<Module>(i)), Level::warning);
  EXPECT_EQ(to_string(*levels), "warning");
}

TEST(LogLevels, modules_have_their_own_levels) {
  const auto levels = parse_levels("net=error,warning,store=debug");
  ASSERT_TRUE(levels);
  EXPECT_EQ(levels->of(Module::store), Level::debug);
  EXPECT_EQ(levels->of(Module::net), Level::error);
  EXPECT_EQ(levels->of(Module::room), Level::warning);
  EXPECT_EQ(to_string(*levels), "warning,net=error,store=debug");
  EXPECT_EQ(parse_levels(to_string(*levels)), *levels);
  EXPECT_EQ(parse_levels("store=debug")->by_default, Level::info);
}

TEST(LogLevels, malformed_lists_are_refused) {
  for (const char* text : {"", ",", "info,", ",info", "loud", "Info", "info,debug", "store",
                           "store=", "=debug", "store=loud", "shop=debug", "store=debug,store=info",
                           "store=debug=info", " info", "info, store=debug"}) {
    const auto levels = parse_levels(text);
    ASSERT_FALSE(levels) << text;
    EXPECT_EQ(levels.error().code, ErrorCode::malformed) << text;
  }
}

TEST(LogLevels, the_module_follows_from_the_path_of_the_file) {
  EXPECT_EQ(module_of_file("/home/a/strata/server/net/api/api.cpp"), Module::net);
  EXPECT_EQ(module_of_file("server/store/store.cpp"), Module::store);
  EXPECT_EQ(module_of_file("../../server/room/rooms.cpp"), Module::room);
  EXPECT_EQ(module_of_file("/srv/server/strata/server/gl/fence.cpp"), Module::gl);
  EXPECT_EQ(module_of_file("/b/build/dev/modules/net/net/http/worker_pool.h"), Module::net);
  EXPECT_EQ(module_of_file("/home/a/strata/server/main.cpp"), Module::other);
  EXPECT_EQ(module_of_file("/home/a/webserver/net/x.cpp"), Module::other);
  EXPECT_EQ(module_of_file("/home/a/strata/tests/unit/core/log_levels_test.cpp"), Module::other);
}

class Log : public ::testing::Test {
 protected:
  void TearDown() override {
    set_levels({});
    set_format(Format::text);
  }
};

TEST_F(Log, lines_below_the_level_of_their_module_are_not_written) {
  set_levels(*parse_levels("debug,other=warning"));
  testing::internal::CaptureStderr();
  info("quiet");
  warning("loud");
  const std::string written = testing::internal::GetCapturedStderr();
  EXPECT_EQ(written.find("quiet"), std::string::npos) << written;
  EXPECT_NE(written.find(" W [other] loud\n"), std::string::npos) << written;
  EXPECT_FALSE(is_enabled(Level::info));
  EXPECT_TRUE(is_enabled(Level::error));
  EXPECT_EQ(to_string(levels()), "debug,other=warning");
}

TEST_F(Log, json_lines_contain_the_trace_and_the_fields) {
  set_format(Format::json);
  const TraceScope scope(random_trace_id());
  testing::internal::CaptureStderr();
  const Field fields[] = {
      {"stage", std::string_view("gpu")}, {"gpu_ms", 1.5}, {"n", std::int64_t(3)}};
  write(Level::warning, "a \"quoted\"\nmessage \xff", fields);
  const std::string written = testing::internal::GetCapturedStderr();
  ASSERT_EQ(written.find('\n'), written.size() - 1) << written;
  const auto line = nlohmann::json::parse(written);
  EXPECT_EQ(line.at("level"), "warning");
  EXPECT_EQ(line.at("module"), "other");
  EXPECT_EQ(line.at("trace_id"), to_string(current_trace()));
  EXPECT_EQ(line.at("stage"), "gpu");
  EXPECT_EQ(line.at("gpu_ms"), 1.5);
  EXPECT_EQ(line.at("n"), 3);
  EXPECT_TRUE(line.at("message").get<std::string>().starts_with("a \"quoted\"\nmessage "));
  EXPECT_TRUE(line.at("time").get<std::string>().ends_with("Z"));
}

TEST_F(Log, text_lines_end_with_the_fields) {
  testing::internal::CaptureStderr();
  const Field fields[] = {{"gpu_ms", 1.25}, {"op", std::string_view("stroke")}};
  write(Level::error, "slow", fields);
  EXPECT_NE(testing::internal::GetCapturedStderr().find(" E [other] slow gpu_ms=1.250 op=stroke\n"),
            std::string::npos);
}

TEST_F(Log, a_text_line_has_no_control_characters_of_its_message_or_fields) {
  testing::internal::CaptureStderr();
  const Field fields[] = {{"path", std::string_view("/a\n2026-01-01 E forged")}};
  write(Level::error, "one\r\ttwo\x7f", fields);
  const std::string written = testing::internal::GetCapturedStderr();
  ASSERT_EQ(written.find('\n'), written.size() - 1) << written;
  EXPECT_NE(written.find("one\\x0d\\x09two\\x7f path=/a\\x0a2026-01-01 E forged\n"),
            std::string::npos)
      << written;
}

}  // namespace
}  // namespace strata::log
