#include "vocabulary/linked_document.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>

namespace strata {
namespace {

using testing::Contains;
using testing::Field;
using testing::HasSubstr;
using testing::Not;

const std::string kRdf = "http://www.w3.org/1999/02/22-rdf-syntax-ns#",
                  kXsd = "http://www.w3.org/2001/XMLSchema#";
const RdfPrefix kPrefixes[] = {{"e", "https://e.example/"}, {"other", "https://other.example/"}};
constexpr LinkedTerm kTerms[] = {
    {"Thing", "e:Thing", LinkedKind::type},        {"knows", "e:knows", LinkedKind::node},
    {"parts", "e:parts", LinkedKind::list},        {"mood", "e:mood", LinkedKind::word},
    {"name", "e:name", LinkedKind::text},          {"since", "e:since", LinkedKind::time, true},
    {"count", "e:count", LinkedKind::count, true},
};
const LinkedContext kContext{"https://e.example/context", kTerms, kPrefixes};

std::vector<Triple> read(const char* text) {
  return triples_of(nlohmann::json::parse(text), kContext);
}

// Returns the triple with this predicate.
Triple said(const std::vector<Triple>& triples, const std::string& predicate) {
  for (const Triple& triple : triples)
    if (triple.predicate == "https://e.example/" + predicate) return triple;
  return {};
}

TEST(LinkedDocument, nodes_become_triples_with_whole_iris) {
  const auto triples = read(R"({"@context": "x", "id": "https://a.example/1", "type": "Thing",
    "knows": [{"id": "https://a.example/2", "name": "B"}, "e:3"], "mood": "Thing"})");
  ASSERT_EQ(triples.size(), 5u);
  const Triple& typed = triples[0].predicate == kRdf + "type" ? triples[0] : triples.back();
  EXPECT_EQ(typed.subject, "https://a.example/1");
  EXPECT_EQ(typed.object, "https://e.example/Thing");
  EXPECT_THAT(triples, Contains(Field(&Triple::object, "https://e.example/3")));
  EXPECT_EQ(said(triples, "mood").object, "https://e.example/Thing");
  EXPECT_EQ(said(triples, "name").subject, "https://a.example/2");
}

TEST(LinkedDocument, nodes_without_an_id_are_blank_and_distinct) {
  const auto triples =
      read(R"({"id": "https://a.example/1", "knows": [{"name": "B"}, {"name": "B"}]})");
  std::vector<std::string> blanks;
  for (const Triple& triple : triples)
    if (triple.predicate == "https://e.example/name") blanks.push_back(triple.subject);
  ASSERT_EQ(blanks.size(), 2u);
  EXPECT_TRUE(blanks[0].starts_with("_:"));
  EXPECT_NE(blanks[0], blanks[1]);
}

TEST(LinkedDocument, lists_keep_their_order) {
  const auto triples = read(R"({"id": "https://a.example/1", "parts": ["e:x", "e:y"]})");
  const std::string first = said(triples, "parts").object;
  std::string second;
  for (const Triple& triple : triples) {
    if (triple.subject != first) continue;
    if (triple.predicate == kRdf + "first") {
      EXPECT_EQ(triple.object, "https://e.example/x");
    }
    if (triple.predicate == kRdf + "rest") second = triple.object;
  }
  EXPECT_THAT(triples, Contains(testing::AllOf(Field(&Triple::subject, second),
                                               Field(&Triple::predicate, kRdf + "rest"),
                                               Field(&Triple::object, kRdf + "nil"))));
  EXPECT_EQ(said(read(R"({"id": "e:1", "parts": []})"), "parts").object, kRdf + "nil");
}

TEST(LinkedDocument, literals_have_the_types_of_json_ld) {
  const auto literal = [](const char* value, const char* member = "name") {
    return said(read((std::string(R"({"id": "e:1", ")") + member + "\": " + value + "}").c_str()),
                member);
  };
  EXPECT_EQ(literal("\"a\"").datatype, "");
  EXPECT_EQ(literal("3").datatype, kXsd + "integer");
  EXPECT_EQ(literal("3.0").object, "3");
  EXPECT_EQ(literal("3.0").datatype, kXsd + "integer");
  EXPECT_EQ(literal("-0.0").object, "0");
  EXPECT_EQ(literal("0.5").datatype, kXsd + "double");
  EXPECT_EQ(std::stod(literal("0.1").object), 0.1);
  EXPECT_EQ(literal("1e300").datatype, kXsd + "double");
  EXPECT_EQ(literal("true").datatype, kXsd + "boolean");
  EXPECT_EQ(literal("\"2024-02-29T00:00:00Z\"", "since").datatype, kXsd + "dateTime");
  EXPECT_EQ(literal("4", "count").datatype, kXsd + "nonNegativeInteger");
  EXPECT_EQ(literal(R"({"@value": "Salz", "@language": "de"})").language, "de");
}

TEST(LinkedDocument, unknown_members_are_mistakes_of_the_program) {
  EXPECT_THROW(read(R"({"id": "e:1", "unknown": 1})"), std::logic_error);
  EXPECT_THROW(read(R"({"id": "e:1", "type": "Unknown"})"), std::logic_error);
}

TEST(LinkedDocument, the_context_defines_what_the_published_one_lacks) {
  const auto context = context_of(kContext);
  ASSERT_TRUE(context.is_array());
  EXPECT_EQ(context[0], "https://e.example/context");
  EXPECT_FALSE(context[1].contains("knows"));
  EXPECT_EQ(context[1]["since"]["@type"], kXsd + "dateTime");
  const auto whole = context_of({{}, kTerms, kPrefixes});
  EXPECT_EQ(whole["id"], "@id");
}

TEST(Rdf, iris_have_a_scheme_and_no_forbidden_characters) {
  for (const char* iri : {"https://a.example/x?y=1#z", "urn:uuid:1", "http://a.example/ä"})
    EXPECT_TRUE(is_iri(iri)) << iri;
  for (const char* text : {"", "a", ":a", "1a:b", "https://a.example/a b", "http://a/<b>", "a\nb:c",
                           "http://a/\"", "/relative", "http://a/\xff"})
    EXPECT_FALSE(is_iri(text)) << text;
}

TEST(LinkedDocument, turtle_is_read_back_as_the_same_triples) {
  const auto document = nlohmann::json::parse(R"({"id": "https://a.example/1", "type": "Thing",
    "name": ["quote \" and \\ and\nline", 0.25, {"@value": "Grüße", "@language": "de"}],
    "knows": {"name": "inner"}})");
  const auto turtle = linked_turtle(document, kContext);
  ASSERT_TRUE(turtle) << turtle.error().detail;
  EXPECT_THAT(*turtle, HasSubstr("@prefix e:"));
  EXPECT_THAT(*turtle, Not(HasSubstr("other.example")));
  std::vector<Triple> again;
  ASSERT_TRUE(read_rdf(*turtle, RdfSyntax::turtle, [&](const Triple& triple) {
    again.push_back(triple);
    return true;
  }));
  EXPECT_EQ(again.size(), triples_of(document, kContext).size());
  EXPECT_THAT(again, Contains(Field(&Triple::object, "quote \" and \\ and\nline")));
  EXPECT_THAT(again, Contains(testing::AllOf(Field(&Triple::object, "Grüße"),
                                             Field(&Triple::language, "de"))));
}

}  // namespace
}  // namespace strata
