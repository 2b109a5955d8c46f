#include "protocol/problem.h"

#include <gtest/gtest.h>

#include <fstream>
#include <set>
#include <sstream>

#include "protocol/parse.h"
#include "strata_dirs.h"

namespace strata::protocol {
namespace {

std::string text_of(const std::string& file) {
  std::ifstream in(STRATA_SOURCE_DIR "/" + file, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

TEST(ProtocolProblem, every_error_code_has_a_type_a_status_and_words) {
  std::set<std::string> types;
  for (int i = 0; i <= static_cast<int>(kLastErrorCode); ++i) {
    const auto code = static_cast<ErrorCode>(i);
    EXPECT_EQ(error_code_named(name(code)), code);
    EXPECT_EQ(code_of_problem_type(problem_type(code)), code);
    EXPECT_EQ(is_server_failure(code), http_status(code) >= 500) << name(code);
    EXPECT_TRUE(types.insert(problem_type(code)).second) << name(code);
    // If several codes share a status, the first code or `unavailable` represents that status.
    EXPECT_EQ(http_status(code_of_http_status(http_status(code))), http_status(code));
  }
  EXPECT_EQ(problem_kinds().size(), types.size());
  EXPECT_FALSE(code_of_problem_type("about:blank"));
  EXPECT_FALSE(code_of_problem_type("/problems#"));
  EXPECT_EQ(code_of_http_status(418), ErrorCode::malformed);
  EXPECT_EQ(code_of_http_status(599), ErrorCode::internal);
}

TEST(ProtocolProblem, the_contract_and_the_documents_list_every_type) {
  const auto bundle = nlohmann::json::parse(schema_bundle());
  std::set<std::string> listed;
  for (const auto& type : bundle["definitions"]["ProblemType"]["enum"]) listed.insert(type);
  const std::string page = text_of("docs/reference/errors.md");
  for (const ProblemKind& kind : problem_kinds()) {
    EXPECT_EQ(listed.erase(problem_type(kind.code)), 1u) << name(kind.code);
    const std::string row = "| `" + problem_type(kind.code) + "` | " + std::to_string(kind.status) +
                            " | " + std::string(kind.meaning) + " | " + std::string(kind.remedy) +
                            " |\n";
    EXPECT_NE(page.find(row), std::string::npos) << "docs/reference/errors.md lacks: " << row;
  }
  EXPECT_TRUE(listed.empty()) << *listed.begin();
}

}  // namespace
}  // namespace strata::protocol
