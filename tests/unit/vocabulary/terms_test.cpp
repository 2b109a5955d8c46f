#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/text/csv.h"
#include "core/text/search_text.h"
#include "domain/tables/term_list.h"
#include "vocabulary/terms_csv.h"
#include "vocabulary/terms_skos.h"
#include "vocabulary/xml_bounds.h"

namespace strata {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr const char* kTurtle = R"(@prefix skos: <http://www.w3.org/2004/02/skos/core#> .
@prefix t: <https://terms.example/stone/> .
t:loss a skos:Concept ; skos:prefLabel "Loss"@en, "Pérdida"@es ; skos:definition "Missing."@en .
t:worn a skos:Concept ; skos:notation "W1" ; skos:prefLabel "Worn"@en ; skos:broader t:loss .
t:loss skos:narrower t:broken .
t:broken skos:prefLabel "Broken off" .
)";

constexpr const char* kRdfXml = R"(<?xml version="1.0"?>
<!DOCTYPE rdf:RDF [<!ENTITY skos "http://www.w3.org/2004/02/skos/core#">]>
<rdf:RDF xmlns:rdf="http://www.w3.org/1999/02/22-rdf-syntax-ns#" xmlns:skos="&skos;">
 <skos:Concept rdf:about="https://terms.example/stone/loss"><skos:prefLabel xml:lang="en">Loss</skos:prefLabel></skos:Concept>
 <skos:Concept rdf:about="https://terms.example/stone/worn">
  <skos:prefLabel xml:lang="en">Worn</skos:prefLabel><skos:broader rdf:resource="https://terms.example/stone/loss"/>
 </skos:Concept>
</rdf:RDF>)";

const Term* term(const TermList& list, const std::string& code) {
  for (const Term& each : list.terms)
    if (each.code == code) return &each;
  return nullptr;
}

std::string turtle(const std::string& body) {
  return "@prefix skos: <http://www.w3.org/2004/02/skos/core#> . @prefix t: <https://t.example/> . " +
         body;
}

TEST(TermsSkos, a_vocabulary_in_turtle_becomes_terms) {
  const auto list = read_terms_skos(kTurtle, RdfSyntax::turtle);
  ASSERT_TRUE(list) << list.error().detail;
  ASSERT_EQ(list->terms.size(), 3u);
  const Term* loss = term(*list, "loss");
  ASSERT_TRUE(loss);
  EXPECT_EQ(loss->label, "Loss");
  EXPECT_EQ(loss->labels, (Labels{{"en", "Loss"}, {"es", "Pérdida"}}));
  EXPECT_EQ(loss->definition, "Missing.");
  EXPECT_EQ(loss->uri, "https://terms.example/stone/loss");
  ASSERT_TRUE(term(*list, "W1"));
  EXPECT_EQ(term(*list, "W1")->parent, "loss");
  ASSERT_TRUE(term(*list, "broken"));
  EXPECT_EQ(term(*list, "broken")->parent, "loss");
  EXPECT_THAT(list->columns, testing::Contains("label-es"));
}

TEST(TermsSkos, a_vocabulary_in_rdf_xml_becomes_terms_also_with_entities_for_its_namespaces) {
  const auto list = read_terms_skos(kRdfXml, RdfSyntax::rdf_xml);
  ASSERT_TRUE(list) << list.error().detail;
  ASSERT_EQ(list->terms.size(), 2u);
  EXPECT_EQ(term(*list, "worn")->parent, "loss");
}

TEST(TermsSkos, what_is_broken_is_told_with_its_line) {
  const auto list = read_terms_skos("@prefix a: <http://a/> .\na:x a:y ;;; [ .", RdfSyntax::turtle);
  ASSERT_FALSE(list);
  EXPECT_EQ(list.error().code, ErrorCode::invalid);
  EXPECT_THAT(list.error().detail, HasSubstr("line 2"));
  EXPECT_EQ(read_terms_skos("<rdf:RDF", RdfSyntax::rdf_xml).error().code, ErrorCode::invalid);
  EXPECT_EQ(read_terms_skos("\xff\xfe", RdfSyntax::turtle).error().code, ErrorCode::invalid);
  EXPECT_EQ(read_terms_skos("", RdfSyntax::turtle).error().title, "No terms");
  EXPECT_EQ(read_terms_skos("", RdfSyntax::rdf_xml).error().code, ErrorCode::invalid);
}

TEST(TermsSkos, entities_that_grow_are_refused_and_files_are_not_read) {
  std::string bomb =
      "<?xml version=\"1.0\"?><!DOCTYPE r [<!ENTITY a \"aaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaa\">";
  for (char name = 'b'; name < 'l'; ++name) {
    bomb += std::string("<!ENTITY ") + name + " \"";
    for (int i = 0; i < 10; ++i) bomb += std::string("&") + static_cast<char>(name - 1) + ";";
    bomb += "\">";
  }
  bomb +=
      R"(]><rdf:RDF xmlns:rdf="http://www.w3.org/1999/02/22-rdf-syntax-ns#" xmlns:skos="http://www.w3.org/2004/02/skos/core#">)"
      R"(<skos:Concept rdf:about="http://t.example/x"><skos:prefLabel>&k;</skos:prefLabel></skos:Concept></rdf:RDF>)";
  const auto grown = read_terms_skos(bomb, RdfSyntax::rdf_xml);
  ASSERT_FALSE(grown);
  EXPECT_EQ(grown.error().code, ErrorCode::invalid);

  const auto fetched = read_terms_skos(
      R"(<?xml version="1.0"?><!DOCTYPE r [<!ENTITY f SYSTEM "file:///etc/passwd">]>
<rdf:RDF xmlns:rdf="http://www.w3.org/1999/02/22-rdf-syntax-ns#" xmlns:skos="http://www.w3.org/2004/02/skos/core#">
<skos:Concept rdf:about="http://t.example/x"><skos:prefLabel>a&f;b</skos:prefLabel></skos:Concept></rdf:RDF>)",
      RdfSyntax::rdf_xml);
  ASSERT_FALSE(fetched);
  EXPECT_THAT(fetched.error().detail, HasSubstr("entity"));
}

TEST(TermsSkos, a_language_that_turtle_cannot_write_is_left_out) {
  const auto list = read_terms_skos(
      R"(<rdf:RDF xmlns:rdf="http://www.w3.org/1999/02/22-rdf-syntax-ns#" xmlns:skos="http://www.w3.org/2004/02/skos/core#">)"
      R"(<skos:Concept rdf:about="http://t.example/x"><skos:prefLabel xml:lang="6en">Loss</skos:prefLabel></skos:Concept></rdf:RDF>)",
      RdfSyntax::rdf_xml);
  ASSERT_TRUE(list);
  EXPECT_EQ(list->left_out, 1u);
  ASSERT_EQ(list->terms.size(), 1u);
  EXPECT_EQ(list->terms[0].label, "Loss");
  EXPECT_TRUE(list->terms[0].labels.empty());
  const auto written = terms_skos("Terms", list->terms);
  ASSERT_TRUE(written);
  EXPECT_TRUE(read_terms_skos(*written, RdfSyntax::turtle));
}

TEST(TermsSkos, a_circle_of_broader_terms_is_read_as_it_is) {
  const auto list = read_terms_skos(
      turtle("t:a a skos:Concept; skos:broader t:b . t:b skos:broader t:a ."), RdfSyntax::turtle);
  ASSERT_TRUE(list);
  EXPECT_EQ(term(*list, "a")->parent, "b");
  EXPECT_EQ(term(*list, "b")->parent, "a");
}

TEST(TermsSkos, missing_and_double_labels_are_no_obstacle) {
  const auto list = read_terms_skos(
      turtle(
          "t:a a skos:Concept . t:b a skos:Concept; skos:prefLabel \"Zwei\"@de, \"Beta\"@de ; skos:broader t:a, t:elsewhere ."),
      RdfSyntax::turtle);
  ASSERT_TRUE(list);
  EXPECT_EQ(term(*list, "a")->label, "");
  EXPECT_EQ(label_in(*term(*list, "a"), "de"), "a");
  EXPECT_EQ(term(*list, "b")->labels.at("de"), "Beta");
  EXPECT_EQ(term(*list, "b")->parent, "a");
  EXPECT_EQ(list->left_out, 2u);
}

TEST(TermsSkos, a_parent_that_is_only_named_is_told_by_its_uri) {
  const auto list =
      read_terms_skos(turtle("t:b a skos:Concept; skos:broader t:elsewhere ."), RdfSyntax::turtle);
  ASSERT_TRUE(list);
  ASSERT_EQ(list->terms.size(), 1u);
  EXPECT_EQ(list->terms[0].parent, "");
  EXPECT_EQ(list->terms[0].parent_uri, "https://t.example/elsewhere");
}

TEST(TermsSkos, codes_that_are_met_twice_get_numbers) {
  const auto list = read_terms_skos(
      turtle("t:a a skos:Concept; skos:notation \"1\" . t:b a skos:Concept; skos:notation \"1\" ."),
      RdfSyntax::turtle);
  ASSERT_TRUE(list);
  EXPECT_TRUE(term(*list, "1") && term(*list, "1-2"));
}

TEST(TermsSkos, a_huge_literal_is_read_or_refused_and_nothing_else) {
  const std::string text(5'000'000, 'x');
  const auto list = read_terms_skos(
      turtle("t:a a skos:Concept; skos:definition \"" + text + "\" ."), RdfSyntax::turtle);
  if (list) {
    EXPECT_EQ(list->terms[0].definition.size(), text.size());
  }
}

TEST(TermsSkos, deep_nesting_is_refused_or_read) {
  std::string deep = turtle("t:a skos:broader ");
  for (int i = 0; i < 200'000; ++i) deep += "[ skos:broader ";
  EXPECT_FALSE(read_terms_skos(deep, RdfSyntax::turtle));
  std::string xml =
      "<rdf:RDF xmlns:rdf=\"http://www.w3.org/1999/02/22-rdf-syntax-ns#\" xmlns:s=\"http://www.w3.org/2004/02/skos/core#\">";
  for (int i = 0; i < 100'000; ++i) xml += "<s:Concept><s:broader>";
  EXPECT_THAT(read_terms_skos(xml, RdfSyntax::rdf_xml).error().detail, HasSubstr("deep"));
}

TEST(XmlBounds, tags_are_told_from_what_looks_like_them) {
  std::string text =
      "<?xml version='1.0'?><!DOCTYPE a [<!ENTITY b 'plain > text'><!-- <!ENTITY c '&d;'> -->]><a b='>'>";
  for (int i = 0; i < 1000; ++i)
    text += "<c d=\"/\"></c><e f='>'/><!-- <g> --><![CDATA[<h>]]><?i <j>?>";
  EXPECT_TRUE(check_xml_bounds(text));
  for (const char* cut :
       {"<", "<!", "<!--", "<a '", "<!DOCTYPE a [", "<!ENTITY", "<![CDATA[", "</", "<?"})
    EXPECT_TRUE(check_xml_bounds(cut)) << cut;
  for (const char* entity : {"'&b;'", "'<b/>'", "SYSTEM 'b'", "'&#60;b/>'"})
    EXPECT_FALSE(check_xml_bounds("<!DOCTYPE a [<!ENTITY c " + std::string(entity) + ">]><a/>"))
        << entity;
}

TEST(TermsSkos, what_is_written_is_read_as_the_same_terms) {
  Term a, b;
  a.code = "loss & more";
  a.label = "Loss \"of\" matter\n";
  a.labels = {{"es", "Pérdida"}};
  a.definition = "A part that\\once was there.";
  b.code = "worn";
  b.label = "Worn";
  b.parent = a.code;
  b.uri = "https://terms.example/worn";
  const Term terms[] = {a, b};
  const auto text = terms_skos("Stone \"terms\"", terms);
  ASSERT_TRUE(text) << text.error().detail;
  EXPECT_THAT(*text, testing::Not(HasSubstr("relative.invalid"))) << *text;
  const auto read = read_terms_skos(*text, RdfSyntax::turtle);
  ASSERT_TRUE(read) << read.error().detail << *text;
  ASSERT_EQ(read->terms.size(), 2u);
  const Term* loss = term(*read, a.code);
  ASSERT_TRUE(loss);
  EXPECT_EQ(loss->label, "Loss \"of\" matter");
  EXPECT_EQ(loss->labels, a.labels);
  EXPECT_EQ(loss->definition, a.definition);
  EXPECT_EQ(loss->uri, "");
  EXPECT_EQ(term(*read, "worn")->parent, a.code);
  EXPECT_EQ(term(*read, "worn")->uri, b.uri);
}

TEST(TermsCsv, columns_stand_in_any_order_and_colours_get_one_form) {
  const auto list = read_terms_csv(
      "Parent;Label-ES;CODE;color;pattern\n;Pérdida;loss;#ABC;solid\nloss;;worn;;\n");
  ASSERT_TRUE(list) << list.error().detail;
  ASSERT_EQ(list->terms.size(), 2u);
  EXPECT_EQ(list->terms[0].color, "#aabbcc");
  EXPECT_EQ(list->terms[0].labels.at("es"), "Pérdida");
  EXPECT_EQ(list->terms[1].parent, "loss");
  EXPECT_EQ(list->terms[1].line, 3);
  EXPECT_EQ(list->columns,
            (std::set<std::string>{"parent", "label-es", "code", "color", "pattern"}));
}

TEST(TermsCsv, every_wrong_line_is_told) {
  const auto list = read_terms_csv("code,color,pattern\na,red,\n,#000,\nb,,zigzag\na1\nc,,\nc,,\n");
  ASSERT_TRUE(list);
  std::vector<std::pair<int, std::string>> mistakes;
  for (const TermMistake& mistake : list->mistakes)
    mistakes.emplace_back(mistake.line, mistake.column);
  EXPECT_THAT(mistakes,
              ElementsAre(std::pair(2, "color"), std::pair(3, "code"), std::pair(4, "pattern"),
                          std::pair(5, ""), std::pair(7, "code")));
  EXPECT_EQ(list->terms.size(), 1u);
  EXPECT_EQ(list->rows, 6u);
}

TEST(TermsCsv, a_first_row_without_codes_or_with_strangers_is_refused) {
  EXPECT_EQ(read_terms_csv("label\na\n").error().title, "Column missing");
  EXPECT_EQ(read_terms_csv("code,colour\na,\n").error().title, "Unknown column");
  EXPECT_EQ(read_terms_csv("code,Code\na,b\n").error().title, "Duplicate column");
  EXPECT_FALSE(read_terms_csv(""));
}

TEST(TermsCsv, what_is_written_is_read_as_the_same_terms) {
  Term a;
  a.code = "=a";
  a.label = "Two, \"three\"";
  a.labels = {{"es", "Dos"}, {"pt-br", "Três"}};
  a.color = "#aabbcc";
  a.pattern = "dots";
  const Term terms[] = {a};
  for (const char separator : {',', ';', '\t'}) {
    const auto read = read_terms_csv(terms_csv(terms, separator));
    ASSERT_TRUE(read);
    ASSERT_EQ(read->terms.size(), 1u);
    EXPECT_EQ(read->terms[0].code, a.code);
    EXPECT_EQ(read->terms[0].label, a.label);
    EXPECT_EQ(read->terms[0].labels, a.labels);
    EXPECT_EQ(read->terms[0].color, a.color);
    EXPECT_EQ(read->terms[0].pattern, a.pattern);
  }
}

TEST(SearchText, case_and_accents_make_no_difference) {
  EXPECT_EQ(search_text("DEPÓSITO"), "deposito");
  EXPECT_EQ(search_text("Straße"), "strasse");
  EXPECT_EQ(search_text("Ⅻ ﬁne"), "xii fine");
  EXPECT_EQ(search_text("\xff"), "\xff");
}

// --- A list of terms as a table

class List : public testing::Test {
 protected:
  List() {
    table.id = 7;
    const std::string languages[] = {"es"};
    table.columns = new_term_columns(languages);
    for (std::size_t i = 0; i < table.columns.size(); ++i) {
      table.columns[i].id = ColumnId(static_cast<std::int64_t>(i) + 1);
      if (table.columns[i].target == kOwnTable) table.columns[i].target = table.id;
    }
  }
  void add(std::int64_t key, const std::string& code, std::optional<std::int64_t> parent,
           const std::string& spanish = {}, const std::string& color = {}) {
    const auto columns = *term_columns(table);
    Record record;
    record.key = key;
    record.values[columns.code->id] = code;
    record.values[columns.label->id] = "The " + code;
    if (parent) record.values[columns.parent->id] = *parent;
    if (!spanish.empty()) record.values[columns.labels.at("es")->id] = spanish;
    if (!color.empty()) record.values[columns.color->id] = color;
    records.push_back(std::move(record));
  }
  std::vector<ListedTerm> listed() const { return list_terms(*term_columns(table), records); }
  static std::vector<std::pair<std::string, int>> tree(const std::vector<ListedTerm>& terms) {
    std::vector<std::pair<std::string, int>> out;
    for (const ListedTerm& each : terms) out.emplace_back(each.term.code, each.depth);
    return out;
  }
  Table table;
  std::vector<Record> records;
};

TEST_F(List, a_table_is_a_list_of_terms_by_its_columns) {
  EXPECT_TRUE(term_columns(table));
  Table other = table;
  other.columns[0].unique = false;
  EXPECT_FALSE(term_columns(other));
  other = table;
  for (Column& column : other.columns)
    if (column.slug == "parent") column.target = TableId(8);
  EXPECT_FALSE(term_columns(other));
}

TEST_F(List, terms_stand_before_those_below_them) {
  add(1, "worn", 3);
  add(2, "cracks", {});
  add(3, "loss", {});
  add(4, "hairline", 2);
  add(5, "lost-one", 99);
  EXPECT_THAT(tree(listed()),
              ElementsAre(std::pair("cracks", 0), std::pair("hairline", 1), std::pair("loss", 0),
                          std::pair("worn", 1), std::pair("lost-one", 0)));
}

TEST_F(List, terms_in_a_circle_are_listed_once) {
  add(1, "a", 2);
  add(2, "b", 1);
  add(3, "c", 3);
  EXPECT_EQ(listed().size(), 3u);
}

TEST_F(List, labels_fall_back_from_kinds_of_a_language_to_none) {
  add(1, "loss", {}, "Pérdida");
  const auto terms = listed();
  EXPECT_EQ(label_in(terms[0].term, "es"), "Pérdida");
  EXPECT_EQ(label_in(terms[0].term, "es-mx"), "Pérdida");
  EXPECT_EQ(label_in(terms[0].term, "de"), "The loss");
}

TEST_F(List, all_words_are_looked_for_in_all_languages) {
  add(1, "loss", {}, "Pérdida de piedra");
  add(2, "worn", 1, "Desgaste");
  const auto terms = listed();
  EXPECT_EQ(terms_with(terms, "perdida PIEDRA"), (std::vector<bool>{true, false}));
  EXPECT_EQ(terms_with(terms, "the"), (std::vector<bool>{true, true}));
  EXPECT_EQ(terms_with(terms, "perdida desgaste"), (std::vector<bool>{false, false}));
  EXPECT_EQ(terms_with(terms, " "), (std::vector<bool>{true, true}));
}

TEST_F(List, colours_and_patterns_come_from_the_terms_and_colours_go_down_in_shades) {
  add(1, "loss", {}, {}, "#804020");
  add(5, "worn", 1);
  add(6, "broken", 1);
  add(7, "pitted", 1, {}, "#ff0000");
  add(9, "other", {}, {}, "no colour");
  records[1].values[term_columns(table)->pattern->id] = "hatch";
  const Palette palette = terms_palette(listed());
  ASSERT_EQ(palette.points.size(), 5u);
  EXPECT_EQ(palette.mode, PaletteMode::categorical);
  EXPECT_EQ(palette.points[0].color, (Rgba{128, 64, 32, 255}));
  EXPECT_EQ(palette.points[0].label, "The loss");
  EXPECT_NE(palette.points[1].color, palette.points[0].color);
  EXPECT_NE(palette.points[1].color, palette.points[2].color);
  EXPECT_EQ(palette.points[3].color, (Rgba{255, 0, 0, 255}));
  EXPECT_EQ(palette.points[4].color, generated_color(9));
  EXPECT_EQ(palette.points[0].pattern, Pattern::solid);
  EXPECT_EQ(palette.points[1].pattern, Pattern::hatch);
  EXPECT_FALSE(takes_term_colors(palette));
  EXPECT_TRUE(takes_term_colors(terms_palette({})));
}

}  // namespace
}  // namespace strata
