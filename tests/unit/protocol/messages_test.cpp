// The web client's tests read the same fixtures and golden vectors of protocol/, so both languages
// must agree.
#include <gtest/gtest.h>

#include <atomic>
#include <filesystem>
#include <fstream>
#include <map>
#include <random>
#include <sstream>
#include <thread>

#include "protocol/fast_json.h"
#include "protocol/parse.h"
#include "protocol/problem.h"
#include "strata_dirs.h"

namespace strata::protocol {
namespace {

using nlohmann::json;

struct Fixture {
  std::string name;
  std::string schema;  // name of a definition, or ClientMessage
  json content;
  std::string text() const {
    return content.contains("text") ? content["text"].get<std::string>() : content["json"].dump();
  }
};

std::vector<Fixture> fixtures(const std::string& folder) {
  std::vector<Fixture> found;
  for (const auto& entry :
       std::filesystem::directory_iterator(STRATA_SOURCE_DIR "/protocol/fixtures/" + folder)) {
    std::ifstream file(entry.path());
    json content = json::parse(file);
    found.push_back({entry.path().stem(), content.at("schema"), content});
  }
  return found;
}

std::optional<Schema> schema_named(const std::string& schema_name) {
  for (int i = 0; i < kSchemaCount; ++i)
    if (name(static_cast<Schema>(i)) == schema_name) return static_cast<Schema>(i);
  return std::nullopt;
}

bool is_client_message(const Fixture& f) {
  const json& body = f.content.value("json", json());
  const std::string op =
      body.is_object() && body.contains("op") && body["op"].is_string() ? body["op"] : "";
  const auto schema = client_message_schema(op);
  return f.schema == "ClientMessage" || (schema && name(*schema) == f.schema);
}

bool is_server_message(const Fixture& f) {
  const json& body = f.content["json"];
  const auto schema =
      body.contains("op") ? server_message_schema(body["op"].get<std::string>()) : std::nullopt;
  return schema && name(*schema) == f.schema;
}

constexpr const char* kId = "0b6fbb21-7e3c-4b1c-9a55-2a2f6a1a9c01";

TEST(ProtocolMessages, every_valid_fixture_passes_its_schema) {
  const auto all = fixtures("valid");
  ASSERT_GT(all.size(), 40u);
  for (const auto& f : all) {
    const auto schema = schema_named(f.schema);
    ASSERT_TRUE(schema) << f.name << ": no schema " << f.schema;
    const auto ok = validate(*schema, f.content["json"]);
    EXPECT_TRUE(ok) << f.name << ": " << (ok ? "" : ok.error().field + ": " + ok.error().detail);
  }
}

TEST(ProtocolMessages, every_client_message_has_a_valid_fixture_that_survives_reading_and_writing) {
  std::map<std::size_t, int> seen;
  for (const auto& f : fixtures("valid")) {
    if (!is_client_message(f)) continue;
    const auto message = parse_client_message(f.text());
    ASSERT_TRUE(message) << f.name << ": " << message.error().detail;
    ++seen[message->index()];
    const auto again = parse_client_message(to_text(*message));
    ASSERT_TRUE(again) << f.name << ": " << to_text(*message) << again.error().detail;
    EXPECT_EQ(*message, *again) << f.name;
    // All members that the client sends must be kept. Missing members get their defaults.
    const json written = json::parse(to_text(*message));
    for (const auto& [member, value] : f.content["json"].items())
      if (!value.is_null() && member != "camera" && member != "edit") {
        EXPECT_EQ(written.value(member, json()), value) << f.name << "." << member;
      }
  }
  EXPECT_EQ(seen.size(), std::variant_size_v<ClientMessage>);
}

TEST(ProtocolMessages, every_server_message_has_a_valid_fixture_that_is_written_back_unchanged) {
  std::map<std::size_t, int> seen;
  for (const auto& f : fixtures("valid")) {
    if (is_client_message(f) || !is_server_message(f)) continue;
    const auto message = parse_server_message(f.text());
    ASSERT_TRUE(message) << f.name << ": " << message.error().detail;
    ++seen[message->index()];
    EXPECT_EQ(json::parse(to_text(*message)), f.content["json"]) << f.name;
  }
  EXPECT_EQ(seen.size(), std::variant_size_v<ServerMessage>);
}

TEST(ProtocolMessages, every_invalid_fixture_is_refused_with_the_field_it_names) {
  const auto all = fixtures("invalid");
  ASSERT_GT(all.size(), 70u);
  for (const auto& f : all) {
    Error problem;
    if (is_client_message(f)) {
      const auto message = parse_client_message(f.text());
      ASSERT_FALSE(message) << f.name;
      problem = message.error();
    } else {
      const auto ok = validate(schema_named(f.schema).value(), f.content["json"]);
      ASSERT_FALSE(ok) << f.name;
      problem = ok.error();
    }
    EXPECT_EQ(problem.field, f.content["field"].get<std::string>())
        << f.name << ": " << problem.title << ": " << problem.detail;
    EXPECT_EQ(http_status(problem.code), f.content["status"].get<int>()) << f.name;
    EXPECT_FALSE(problem.title.empty()) << f.name;
    EXPECT_GT(problem.detail.size(), 10u) << f.name;
  }
}

TEST(ProtocolMessages, a_problem_says_what_belongs_in_the_field) {
  auto ok = validate(Schema::Ack, json{{"op", "ack"}, {"frame", -1}});
  ASSERT_FALSE(ok);
  EXPECT_EQ(ok.error().detail, "It must be a whole number from 0 to 4294967295.");
  ok = validate(Schema::LayerCreate, json{{"name", "x"}, {"type", "u64"}});
  ASSERT_FALSE(ok);
  EXPECT_EQ(ok.error().detail,
            R"(It must be one of "u8", "u16", "u32", "i8", "i16", "i32", "f16", "f32".)");
  ok = validate(Schema::Undo, json{{"op", "undo"}, {"layer", 1}}, "messages[2]");
  ASSERT_FALSE(ok);
  EXPECT_EQ(ok.error().field, "messages[2].id");
}

TEST(ProtocolMessages, an_unknown_member_is_named_whatever_its_name) {
  for (const char* member : {"colour", "it's", "'.", "a: 'b'", ""}) {
    const auto ok = validate(Schema::Hello, json{{"op", "hello"}, {member, 1}});
    ASSERT_FALSE(ok);
    EXPECT_EQ(ok.error().field, member);
    EXPECT_EQ(ok.error().title, "Unknown member");
  }
}

TEST(ProtocolMessages, a_refused_message_still_tells_its_id) {
  std::string ref;
  EXPECT_FALSE(parse_client_message(R"({"op":"undo","id":"abc"})", &ref));
  EXPECT_EQ(ref, "abc");
  const json problem = to_json(problem_message(
      Error{ErrorCode::invalid, "Member missing", "It must be given.", "layer"}, ref));
  EXPECT_TRUE(validate(Schema::ProblemMessage, problem));
  EXPECT_EQ(problem["ref"], "abc");
}

TEST(ProtocolMessages, a_problem_keeps_its_bounds_whatever_was_sent) {
  // The text of the client is in the detail and in the field. Each `before` cuts the text at
  // another byte of a three-byte character.
  for (const std::size_t before : {0, 1, 2}) {
    std::string sent(before, 'x');
    for (int i = 0; i < 5000; ++i) sent += "語";
    const Error problem{ErrorCode::invalid, "Not a language of the tour",
                        "The tour has no `" + sent + "`.", "title." + sent};
    const json body = problem_body(problem), message = to_json(problem_message(problem));
    EXPECT_TRUE(validate(Schema::Problem, body));
    EXPECT_TRUE(validate(Schema::ProblemMessage, message));
    for (const json& reply : {body, message}) {
      EXPECT_NO_THROW(static_cast<void>(reply.dump())) << "not UTF-8";
      EXPECT_TRUE(reply["field"].get<std::string>().starts_with("title." + sent.substr(0, 400)));
      EXPECT_TRUE(reply["detail"].get<std::string>().ends_with("語…"));
    }
  }
}

TEST(ProtocolMessages, a_long_list_of_numbers_is_looked_through_to_its_end) {
  const auto with = [](std::size_t place, const json& item) {
    json request{{"points", json::array()}, {"layers", {"moisture"}}};
    for (std::size_t i = 0; i < 300; ++i) request["points"].push_back({0.5, i, -1e15});
    request["points"][place] = item;
    return request;
  };
  for (const std::size_t place : {0, 1, 255, 299}) {
    const std::string field = "points[" + std::to_string(place) + "]";
    const auto good = from_json<PositionsRequest>(with(place, {1, 2, 3}));
    ASSERT_TRUE(good) << good.error().detail;
    EXPECT_EQ(good->points.size(), 300u);
    EXPECT_EQ(good->points[place], glm::dvec3(1, 2, 3));
    for (const auto& [item, wrong] :
         std::map<json, std::string>{{json{1, 2}, field},
                                     {json{1, 2, 3, 4}, field},
                                     {json{1, "2", 3}, field + "[1]"},
                                     {json{1, 2, 1.1e15}, field + "[2]"},
                                     {json{1, nullptr, 3}, field + "[1]"},
                                     {json{1, json::array(), 3}, field + "[1]"},
                                     {json(7), field}}) {
      const auto refused = from_json<PositionsRequest>(with(place, item));
      ASSERT_FALSE(refused) << item;
      EXPECT_EQ(refused.error().code, ErrorCode::invalid);
      EXPECT_EQ(refused.error().field, wrong) << item;
    }
  }
}

TEST(ProtocolMessages, beside_a_long_list_all_else_is_held_to_the_schema) {
  json request{{"points", json(300, {1, 2, 3})}, {"layers", json(300, "moisture")}};
  EXPECT_TRUE(from_json<PositionsRequest>(request));
  const auto field_of = [](const json& wrong) {
    return from_json<PositionsRequest>(wrong).error().field;
  };
  json more = request, text = request, number = request;
  more["extra"] = json(300, 1);
  EXPECT_EQ(field_of(more), "extra");
  text["layers"][280] = json::array();
  EXPECT_TRUE(field_of(text).starts_with("layers[280]")) << field_of(text);
  number["at"] = json(300, 1);
  EXPECT_EQ(field_of(number), "at");
  request["points"] = json(100'001, {1, 2, 3});
  EXPECT_EQ(field_of(request), "points");
}

TEST(ProtocolMessages, a_text_of_the_wrong_form_is_refused_with_examples) {
  const auto read = from_json<ModelPatch>(json{{"survey_date", "31.12.2020"}});
  ASSERT_FALSE(read);
  EXPECT_EQ(read.error().field, "survey_date");
  EXPECT_NE(read.error().detail.find("a text such as 2019 or 2019-05 or 2019-05-01"),
            std::string::npos)
      << read.error().detail;
}

TEST(ProtocolMessages, a_list_that_is_too_long_is_refused_before_its_items_are_built) {
  std::string points;
  for (int i = 0; i <= 100'000; ++i) points += "[1,2,3],";
  const auto problem_of = [](const std::string& text) {
    const auto read = parse<PositionsRequest>(text, {16u << 20, 32});
    EXPECT_FALSE(read);
    return read ? Error{} : read.error();
  };
  const std::string bom = "\xEF\xBB\xBF";  // only the careful reader accepts it
  const Error expected =
      from_json<PositionsRequest>(json{{"points", json(100'001, {1, 2, 3})}}).error();
  for (const std::string& before : {std::string(), bom}) {
    const Error problem = problem_of(before + R"({"points":[)" + points + R"([1,2,3]]})");
    EXPECT_EQ(problem.code, ErrorCode::invalid);
    EXPECT_EQ(problem.field, "points");
    EXPECT_EQ(problem.title, expected.title);
    EXPECT_EQ(problem.detail, expected.detail);
    EXPECT_EQ(problem_of(before + R"({"points":[[1,2,3],[1,2,3,4]]})").field, "points[1]");
  }
  // Neither reader builds the items beyond the limit, so they are not checked. With the careful
  // reader, they need not even be JSON.
  EXPECT_EQ(problem_of(bom + R"({"points":[)" + points + "no JSON").field, "points");
  const auto within = parse<PositionsRequest>(R"({"points":[[1,2,3]],"layers":["a","b"]})");
  ASSERT_TRUE(within) << within.error().detail;
  EXPECT_EQ(within->points.size(), 1u);
}

TEST(ProtocolMessages, a_stroke_arrives_as_it_was_sent) {
  const auto message =
      parse_client_message(R"({"op":"stroke.begin","id":")" + std::string(kId) + R"(","stroke":")" +
                           kId + R"(","layer":"cracks","value":7,"radius_mm":2.5,"shape":"square",
      "camera":{"view":[1,0,0,0,0,1,0,0,0,0,1,0,4,5,6,1],"projection":[1,0,0,0,0,1,0,0,0,0,-1,0,0,0,0,1],"width":800,"height":600}})");
  ASSERT_TRUE(message) << message.error().field << message.error().detail;
  const auto& begin = std::get<StrokeBegin>(*message);
  EXPECT_EQ(to_string(begin.id), kId);
  EXPECT_EQ(to_ref(begin.layer), "cracks");
  EXPECT_EQ(begin.value, 7);
  EXPECT_FALSE(begin.erase);
  EXPECT_FALSE(begin.radius_px);
  EXPECT_EQ(begin.radius_mm, 2.5);
  EXPECT_EQ(begin.shape, ToolShape("square"));
  EXPECT_EQ(begin.camera.view[3], glm::dvec4(4, 5, 6, 1));  // column-major
  EXPECT_EQ(begin.camera.width, 800);
}

TEST(ProtocolMessages, a_text_is_refused_by_its_size_before_it_is_read) {
  JsonLimits limits;
  limits.max_bytes = 100;
  const auto message = parse_client_message(
      "{\"op\":\"hello\",\"client\":\"" + std::string(100, 'x') + "\"}", nullptr, limits);
  ASSERT_FALSE(message);
  EXPECT_EQ(message.error().code, ErrorCode::too_large);
}

TEST(ProtocolMessages, nesting_is_taken_up_to_the_limit_and_not_beyond) {
  auto nested = [](int depth) {
    return std::string(static_cast<std::size_t>(depth), '[') +
           std::string(static_cast<std::size_t>(depth), ']');
  };
  EXPECT_TRUE(parse_json(nested(32)));
  const auto deep = parse_json(nested(33));
  ASSERT_FALSE(deep);
  EXPECT_EQ(deep.error().title, "Nested too deeply");
  EXPECT_FALSE(parse_json(nested(100000)));
}

TEST(ProtocolMessages, invalid_utf_8_is_refused) {
  const auto parsed = parse_json("{\"op\":\"\xC3\x28\"}");
  ASSERT_FALSE(parsed);
  EXPECT_EQ(parsed.error().code, ErrorCode::malformed);
}

TEST(ProtocolMessages, what_only_the_careful_reader_takes_is_still_taken) {
  EXPECT_EQ(parse_json("[100000000000000000000]"), json::array({1e20}));  // as JavaScript writes it
  EXPECT_EQ(parse_json("\xEF\xBB\xBF{}"), json::object());
}

TEST(ProtocolMessages, the_fast_reader_leaves_what_is_wrong_to_the_careful_one) {
  for (const std::string text :
       {"", "[1,]", "{\"a\":1,\"a\":2}", "[\"\\u0000\"]", "{\"\\u0000\":1}", "[1e999]", "[1] 2",
        "[[[]]]", "\"\\ud800\"", "\"\xC3\x28\""})
    EXPECT_FALSE(read_json_fast(text, 2)) << text;
  const auto problem = parse_json("{\"a\":[1,}");
  ASSERT_FALSE(problem);
  EXPECT_NE(problem.error().detail.find("byte 9"), std::string::npos) << problem.error().detail;
}

// Changes random bytes of the fixtures. Every text that the fast reader accepts must be JSON, with
// the same value as nlohmann-json reads.
TEST(ProtocolMessages, the_fast_reader_reads_what_the_careful_one_would) {
  std::vector<std::string> texts{
      "[0,-0,-0.0,1,-1,18446744073709551615,9223372036854775808,-9223372036854775808,1.5e-310,0.1,"
      "123456789.123456789,1E+2,true,false,null,\"\\u00e9\\ud83d\\ude00\\n\\/\",{\"\":{}}]"};
  for (const char* folder : {"valid", "invalid"})
    for (const auto& f : fixtures(folder))
      if (const std::string text = f.text(); !text.empty()) texts.push_back(text);
  constexpr std::string_view kBytes = "0123456789-+.eE\"\\{}[],:utfn \x80\xC3";
  std::mt19937 random(7);
  int taken = 0;
  for (const std::string& original : texts) {
    for (int change = 0; change < 60; ++change) {
      std::string text = original;
      for (int i = 0; i < change % 4; ++i)
        text[random() % text.size()] = kBytes[random() % kBytes.size()];
      const auto fast = read_json_fast(text, 32);
      if (!fast) continue;
      ++taken;
      ASSERT_TRUE(json::accept(text)) << text;
      const json careful = json::parse(text);
      ASSERT_EQ(*fast, careful) << text;
      ASSERT_EQ(fast->dump(), careful.dump()) << text;
    }
  }
  EXPECT_GT(taken, 1000);
}

TEST(ProtocolMessages, every_schema_can_be_built) {
  for (int i = 0; i < kSchemaCount; ++i) {
    const auto schema = static_cast<Schema>(i);
    EXPECT_FALSE(name(schema).empty());
    // Null is valid for only one schema, which describes a cell without a value.
    EXPECT_EQ(validate(schema, json(nullptr)).has_value(), schema == Schema::CellValue)
        << name(schema);
  }
}

TEST(ProtocolMessages, many_threads_may_validate_at_once) {
  const auto all = fixtures("valid");
  std::atomic<int> refused{0};
  std::vector<std::thread> threads;
  for (int t = 0; t < 8; ++t)
    threads.emplace_back([&] {
      for (int round = 0; round < 5; ++round)
        for (const auto& f : all)
          if (!validate(schema_named(f.schema).value(), f.content["json"])) ++refused;
    });
  for (auto& thread : threads) thread.join();
  EXPECT_EQ(refused, 0);
}

}  // namespace
}  // namespace strata::protocol
