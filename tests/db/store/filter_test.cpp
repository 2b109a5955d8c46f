// Filters of records: PostgreSQL's SQL compared with plain C++.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <optional>
#include <random>

#include "core/text/edtf.h"
#include "core/text/timestamp.h"
#include "expression/expression_parser.h"
#include "expression/operators.h"
#include "query/conditions/expression_evaluator.h"
#include "store/tables/records.h"
#include "store/tables/tables.h"
#include "support/test_cluster.h"

namespace strata::store {
namespace {

using nlohmann::json;
using Truth = std::optional<bool>;

Column column(const std::string& name, ColumnKind kind, std::optional<TableId> target = {}) {
  Column made;
  made.name = name;
  made.kind = kind;
  made.target = target;
  if (kind == ColumnKind::enumeration) made.choices = {"good", "poor", "it's lost"};
  return made;
}

Result<Expression> parsed(const std::string& text) {
  return query::parse_condition(text, "filter", query::Names::columns);
}

class Filter : public ::testing::Test {
 protected:
  Table make(const std::string& name, std::vector<Column> columns) {
    Table table;
    table.project_id = 1;
    table.name = name;
    table.columns = std::move(columns);
    auto made = store_->tables().create(table);
    EXPECT_TRUE(made) << made.error().detail;
    return made.value_or(Table{});
  }
  void write(const Table& table, const std::map<std::int64_t, std::map<std::string, json>>& rows) {
    WriteRecords request;
    for (const auto& [key, values] : rows) {
      RecordInput input{key, {}};
      for (const auto& [slug, value] : values)
        input.values[find_column(table.columns, slug)->id] = value;
      request.records.push_back(std::move(input));
    }
    auto change = store_->records().write(table.id, request, "ana");
    ASSERT_TRUE(change) << change.error().detail;
    ASSERT_TRUE(change->problems.empty()) << change->problems.front().problem.detail;
  }
  Result<std::vector<std::int64_t>> keys(const Table& table, const std::string& filter,
                                         std::optional<std::int64_t> at = {}) {
    auto condition = parsed(filter);
    if (!condition) return tl::unexpected(condition.error());
    RecordQuery query;
    query.limit = 10'000;
    query.at = at;
    query.filter = std::move(*condition);
    auto page = store_->records().page(table.id, Role::owner, query);
    if (!page) return tl::unexpected(page.error());
    EXPECT_EQ(page->total, static_cast<std::int64_t>(page->records.size()));
    std::vector<std::int64_t> found;
    for (const Record& record : page->records) found.push_back(record.key);
    return found;
  }

  const std::string dsn_ = test::fresh_database();
  std::unique_ptr<Store> store_ = test::open_store(dsn_);
};

// A row of the table below, for the filter in plain C++.
struct Row {
  std::optional<std::string> name, state, day, moment, period;
  std::optional<double> depth, count;
  Truth wet;
  std::optional<std::int64_t> material;
  std::optional<std::vector<std::int64_t>> above;
};

struct Days {
  double first, last;
};
Days days(const std::string& text) {
  const auto period = *parse_edtf(text);
  constexpr double kOpen = std::numeric_limits<double>::infinity();
  return {period.first_day ? static_cast<double>(*period.first_day) : -kOpen,
          period.last_day ? static_cast<double>(*period.last_day) : kOpen};
}

template <class T, class Test>
Truth test_of(const std::optional<T>& value, Test test) {
  return value ? Truth(test(*value)) : Truth();
}

TEST_F(Filter, every_kind_of_column_is_filtered_as_plain_code_would) {
  const Table materials =
      make("Materials", {column("Code", ColumnKind::text), column("Since", ColumnKind::date)});
  write(materials,
        {{1, {{"code", "LIME"}, {"since", "1900-01-01"}}}, {2, {{"code", "gypsum"}}}, {3, {}}});
  const Table table =
      make("Units", {column("Name", ColumnKind::text), column("State", ColumnKind::enumeration),
                     column("Day", ColumnKind::date), column("Moment", ColumnKind::timestamp),
                     column("Period", ColumnKind::period), column("Depth", ColumnKind::numeric),
                     column("Count", ColumnKind::integer), column("Wet", ColumnKind::boolean),
                     column("Material", ColumnKind::term, materials.id),
                     column("Above", ColumnKind::relation, materials.id)});
  std::mt19937 random(7);
  const auto one_of = [&]<class T>(const std::vector<T>& all) {
    return all[random() % all.size()];
  };
  std::map<std::int64_t, Row> rows;
  std::map<std::int64_t, std::map<std::string, json>> values_by_key;
  for (std::int64_t key = 10; key < 310; ++key) {
    Row row;
    const auto maybe = [&](auto& member, auto value) {
      if (random() % 5 != 0) member = value;
    };
    maybe(row.name, one_of(std::vector<std::string>{"Crack 1", "crack 2", "Größe", "grosse", "100%",
                                                    "a\\b", "it's", "Café", "cafe"}));
    maybe(row.state, one_of(std::vector<std::string>{"good", "poor", "it's lost"}));
    maybe(row.day, one_of(std::vector<std::string>{"2024-02-29", "1999-12-31", "2024-03-01"}));
    maybe(row.moment,
          one_of(std::vector<std::string>{"2024-02-29T12:00:00Z", "2024-02-29T12:00:00.001Z",
                                          "1999-01-01T00:00:00Z"}));
    maybe(row.period, one_of(std::vector<std::string>{"1560", "1560~/1580", "-0043", "15XX",
                                                      "1570/..", "../1400"}));
    maybe(row.depth, static_cast<double>(static_cast<int>(random() % 21)) / 4 - 2);
    maybe(row.count, static_cast<double>(random() % 7));
    maybe(row.wet, random() % 2 == 0);
    maybe(row.material, static_cast<std::int64_t>(1 + random() % 3));
    maybe(row.above,
          one_of(std::vector<std::vector<std::int64_t>>{{1}, {1, 2}, {2, 3}, {1, 2, 3}}));
    auto& values = values_by_key[key];
    if (row.name) values["name"] = *row.name;
    if (row.state) values["state"] = *row.state;
    if (row.day) values["day"] = *row.day;
    if (row.moment) values["moment"] = *row.moment;
    if (row.period) values["period"] = *row.period;
    if (row.depth) values["depth"] = *row.depth;
    if (row.count) values["count"] = static_cast<std::int64_t>(*row.count);
    if (row.wet) values["wet"] = *row.wet;
    if (row.material) values["material"] = *row.material;
    if (row.above) values["above"] = *row.above;
    rows[key] = std::move(row);
  }
  write(table, values_by_key);

  using Case = std::pair<const char*, std::function<Truth(const Row&)>>;
  const auto code = [](const Row& r) -> std::optional<std::string> {
    if (!r.material || *r.material == 3) return {};
    return *r.material == 1 ? "LIME" : "gypsum";
  };
  const auto has = [](const std::vector<std::int64_t>& all, std::int64_t key) {
    return std::find(all.begin(), all.end(), key) != all.end();
  };
  const std::vector<Case> cases{
      {"name = 'crack 2'",
       [](const Row& r) { return test_of(r.name, [](auto& n) { return n == "crack 2"; }); }},
      {"'it''s' = name",
       [](const Row& r) { return test_of(r.name, [](auto& n) { return n == "it's"; }); }},
      {"name <> 'Größe'",
       [](const Row& r) { return test_of(r.name, [](auto& n) { return n != "Größe"; }); }},
      {"name like 'crack%'",
       [](const Row& r) { return test_of(r.name, [](auto& n) { return n == "crack 2"; }); }},
      {"casei(name) like casei('CRACK%')",
       [](const Row& r) {
         return test_of(r.name, [](auto& n) { return n == "crack 2" || n == "Crack 1"; });
       }},
      {"name like '%\\%'",
       [](const Row& r) { return test_of(r.name, [](auto& n) { return n == "100%"; }); }},
      {"name like 'a\\\\_'",
       [](const Row& r) { return test_of(r.name, [](auto& n) { return n == "a\\b"; }); }},
      {"name not like 'crack__'",
       [](const Row& r) { return test_of(r.name, [](auto& n) { return n != "crack 2"; }); }},
      {"accenti(name) = accenti('cafe')",
       [](const Row& r) { return test_of(r.name, [](auto& n) { return n == "cafe"; }); }},
      {"casei(accenti(name)) in (casei('CAFE'), 'grosse')",
       [](const Row& r) {
         return test_of(r.name,
                        [](auto& n) { return n == "cafe" || n == "Café" || n == "grosse"; });
       }},
      {"name is null", [](const Row& r) { return !r.name.has_value(); }},
      {"state = 'it''s lost' or wet",
       [](const Row& r) {
         const Truth lost = test_of(r.state, [](auto& s) { return s == "it's lost"; });
         if (lost == true || r.wet == true) return Truth(true);
         return lost && r.wet ? Truth(false) : Truth();
       }},
      {"state in ('good', 'poor')",
       [](const Row& r) { return test_of(r.state, [](auto& s) { return s != "it's lost"; }); }},
      {"wet = false", [](const Row& r) { return test_of(r.wet, [](bool w) { return !w; }); }},
      {"wet <> false", [](const Row& r) { return r.wet; }},
      {"not wet", [](const Row& r) { return test_of(r.wet, [](bool w) { return !w; }); }},
      {"depth between -1 and 1.25",
       [](const Row& r) {
         return test_of(r.depth, [](double d) { return d >= -1 && d <= 1.25; });
       }},
      {"depth * 2 + count > 4",
       [](const Row& r) {
         return r.depth && r.count ? Truth(*r.depth * 2 + *r.count > 4) : Truth();
       }},
      {"1 / depth > 0",
       [](const Row& r) { return r.depth && *r.depth != 0 ? Truth(1 / *r.depth > 0) : Truth(); }},
      {"sqrt(depth) <= 1",
       [](const Row& r) { return r.depth && *r.depth >= 0 ? Truth(*r.depth <= 1) : Truth(); }},
      {"key < 100 and count in (1, 3)",
       [](const Row& r) { return test_of(r.count, [](double c) { return c == 1 || c == 3; }); }},
      {"if(wet, depth, count) = 2",
       [](const Row& r) {
         if (!r.wet) return Truth();
         return test_of(*r.wet ? r.depth : r.count, [](double d) { return d == 2; });
       }},
      {"day = date('2024-02-29')",
       [](const Row& r) { return test_of(r.day, [](auto& d) { return d == "2024-02-29"; }); }},
      {"day > '1999-12-31'",
       [](const Row& r) { return test_of(r.day, [](auto& d) { return d > "1999-12-31"; }); }},
      {"day between '1999-12-31' and '2024-02-29'",
       [](const Row& r) { return test_of(r.day, [](auto& d) { return d <= "2024-02-29"; }); }},
      {"t_during(day, '2024')",
       [](const Row& r) { return test_of(r.day, [](auto& d) { return d.starts_with("2024"); }); }},
      {"t_during(day, interval('2024-03-01', '..'))",
       [](const Row& r) { return test_of(r.day, [](auto& d) { return d == "2024-03-01"; }); }},
      {"moment > timestamp('2024-02-29T13:00:00+01:00')",
       [](const Row& r) {
         return test_of(r.moment, [](auto& m) { return m == "2024-02-29T12:00:00.001Z"; });
       }},
      {"t_during(moment, day)",
       [](const Row& r) {
         return r.moment && r.day ? Truth(r.moment->substr(0, 10) == *r.day) : Truth();
       }},
      {"t_before(period, '1560')",
       [](const Row& r) {
         return test_of(r.period, [](auto& p) { return days(p).last < days("1560").first; });
       }},
      {"period < '1560' or false",
       [](const Row& r) {
         return test_of(r.period, [](auto& p) { return days(p).last < days("1560").first; });
       }},
      {"t_after('1500', period)",
       [](const Row& r) {
         return test_of(r.period, [](auto& p) { return days("1500").first > days(p).last; });
       }},
      {"t_intersects(period, interval('1575', '1590'))",
       [](const Row& r) {
         return test_of(r.period, [](auto& p) {
           return days(p).first <= days("1590").last && days(p).last >= days("1575").first;
         });
       }},
      {"t_disjoint(period, '15XX')",
       [](const Row& r) {
         return test_of(r.period, [](auto& p) {
           return days(p).first > days("15XX").last || days(p).last < days("15XX").first;
         });
       }},
      {"t_contains(period, '1572-05')",
       [](const Row& r) {
         return test_of(r.period, [](auto& p) {
           return days(p).first <= days("1572-05").first && days(p).last >= days("1572-05").last;
         });
       }},
      {"t_equals(period, '1560/1580')",
       [](const Row& r) { return test_of(r.period, [](auto& p) { return p == "1560~/1580"; }); }},
      {"material = 2",
       [](const Row& r) { return test_of(r.material, [](auto m) { return m == 2; }); }},
      {"material.code = 'gypsum'",
       [&](const Row& r) { return test_of(code(r), [](auto& c) { return c == "gypsum"; }); }},
      {"material.since < '1950' and count >= 0",
       [&](const Row& r) {
         if (r.material && *r.material == 1) return test_of(r.count, [](double) { return true; });
         return Truth();
       }},
      {"a_contains(above, (2, 1))",
       [&](const Row& r) {
         return test_of(r.above, [&](auto& a) { return has(a, 1) && has(a, 2); });
       }},
      {"a_overlaps(above, (3, 9))",
       [&](const Row& r) { return test_of(r.above, [&](auto& a) { return has(a, 3); }); }},
      {"a_containedby(above, (1, 2))",
       [&](const Row& r) { return test_of(r.above, [&](auto& a) { return !has(a, 3); }); }},
      {"a_equals(above, (3, 2))",
       [&](const Row& r) {
         return test_of(r.above, [&](auto& a) { return a == std::vector<std::int64_t>{2, 3}; });
       }},
  };
  for (const auto& [text, expected] : cases)
    for (const bool negated : {false, true}) {
      const std::string filter = negated ? "not (" + std::string(text) + ")" : text;
      SCOPED_TRACE(filter);
      const auto found = keys(table, filter);
      ASSERT_TRUE(found) << found.error().detail;
      std::vector<std::int64_t> expected_keys;
      for (const auto& [key, row] : rows) {
        if (std::string_view(text).starts_with("key <") && key >= 100) {
          if (negated) expected_keys.push_back(key);
          continue;
        }
        if (const Truth truth = expected(row); truth && *truth != negated)
          expected_keys.push_back(key);
      }
      EXPECT_EQ(*found, expected_keys);
      if (!negated) {
        EXPECT_FALSE(expected_keys.empty());
      }
    }

  // A filter at an earlier time returns the result for the rows of that time.
  const auto then = store_->tables().find(to_string(table.id), Role::owner)->sequence;
  const auto before = keys(table, "depth > 1 and t_during(period, '15XX')");
  WriteRecords clear;
  for (const auto& [key, row] : rows)
    clear.records.push_back({key, {{find_column(table.columns, "depth")->id, nullptr}}});
  ASSERT_TRUE(store_->records().write(table.id, clear, "ana"));
  EXPECT_TRUE(keys(table, "depth > 1 and t_during(period, '15XX')")->empty());
  EXPECT_EQ(*keys(table, "depth > 1 and t_during(period, '15XX')", then), *before);
}

// Random formulas over numbers. PostgreSQL's result for a record must equal the result for texels
// with the same numbers.
class RandomFormula {
 public:
  explicit RandomFormula(std::mt19937& random) : random_(random) {}

  std::string number(int depth) {
    if (depth == 0) return one_of({"a", "b", "c", "2", "0.5", "3", "0", "null"});
    std::string x = number(depth - 1), y = number(depth - 1);
    switch (random_() % 8) {
      case 0: return "(" + x + one_of({" + ", " - ", " * ", " / ", " div "}) + y + ")";
      case 1:
        return one_of({"abs", "floor", "ceil", "round", "sqrt", "atan", "sin", "ln", "log10",
                       "degrees", "acos"}) +
               ("(" + x + ")");
      case 2: return one_of({"min", "max"}) + ("(" + x + ", " + y + ", " + number(0) + ")");
      case 3: return "if(" + condition(depth - 1) + ", " + x + ", " + y + ")";
      case 4: return "(-" + x + ")";
      case 5: return "case when " + condition(depth - 1) + " then " + x + " end";
      case 6: return "(" + number(0) + " % " + number(0) + ")";
      default: return x;
    }
  }
  std::string condition(int depth) {
    if (depth == 0) return one_of({"a > b", "b <= 1", "c is null", "a = c", "true", "not b > 2"});
    switch (random_() % 6) {
      case 0:
        return "(" + condition(depth - 1) + one_of({" and ", " or "}) + condition(depth - 1) + ")";
      case 1: return "not (" + condition(depth - 1) + ")";
      case 2: return number(depth - 1) + " is not null";
      case 3: return "(" + number(depth - 1) + " between " + number(0) + " and " + number(0) + ")";
      case 4: return "(" + number(depth - 1) + " in (" + number(0) + ", 1, 2))";
      default:
        return "(" + number(depth - 1) + one_of({" < ", " >= ", " <> "}) + number(depth - 1) + ")";
    }
  }

 private:
  std::string one_of(std::initializer_list<const char*> all) {
    return all.begin()[random_() % all.size()];
  }
  std::mt19937& random_;
};

TEST_F(Filter, the_database_and_the_texels_reckon_alike) {
  const Table table =
      make("Numbers", {column("a", ColumnKind::numeric), column("b", ColumnKind::integer),
                       column("c", ColumnKind::numeric)});
  std::mt19937 random(11);
  std::map<std::int64_t, std::map<std::string, json>> rows;
  std::vector<query::LayerView> layers;
  std::map<std::string, std::shared_ptr<TileData>> tiles;
  for (const char* slug : {"a", "b", "c"}) {
    tiles[slug] = std::make_shared<TileData>(ValueType::f32);
    query::LayerView view;
    view.layer.slug = slug;
    view.layer.type = ValueType::f32;
    view.layer.resolution = kTileSize;
    layers.push_back(view);
  }
  // Record k has the numbers of texel k of the first block.
  for (int texel = 0; texel < 64; ++texel)
    for (auto& [slug, tile] : tiles) {
      if (random() % 5 == 0) continue;
      const int number = static_cast<int>(random() % 17) - 8;
      const float value = slug == "b" ? static_cast<float>(number) : static_cast<float>(number) / 4;
      tile->write(texel / 8 * kTileSize + texel % 8, std::bit_cast<std::uint32_t>(value));
      if (slug == "b")
        rows[texel][slug] = number;
      else
        rows[texel][slug] = value;
    }
  for (int texel = 0; texel < 64; ++texel) rows[texel];
  for (auto& view : layers) view.snapshot.tiles[{0, 0}] = tiles[view.layer.slug];
  write(table, rows);
  mesh::SurfaceMap map;
  map.resolution = kTileSize;
  map.blocks_per_side = kTileSize / kBlockSize;
  map.slot_of_block.assign(
      static_cast<std::size_t>(map.blocks_per_side) * static_cast<std::size_t>(map.blocks_per_side),
      mesh::kNoSlot);
  map.slot_of_block[0] = 0;
  map.block_of_slot = {0};
  map.surface_mask = {~std::uint64_t{0}};

  int held = 0;
  const auto expect_alike = [&](const std::string& text) {
    SCOPED_TRACE(text);
    auto condition = query::parse_condition(text, "");
    ASSERT_TRUE(condition) << condition.error().detail;
    const auto texels = query::select_where({*condition}, layers, map, "");
    ASSERT_TRUE(texels);
    const auto found = keys(table, text);
    ASSERT_TRUE(found) << found.error().detail;
    std::uint64_t records = 0;
    for (const auto key : *found) records |= std::uint64_t{1} << key;
    EXPECT_EQ(records, texels->front());
    held += std::popcount(records);
  };
  // Tests every row of the table of operators, so each operator works in both implementations.
  for (const Operator& row : operators()) {
    const std::string name(row.name);
    std::string value;
    if (row.form == Operator::Form::number_function)
      value = name + (row.max_operands == 1 ? "(a)" : "(a, c, b)");
    else if (row.apply)
      value = row.max_operands == 1 ? name + "a" : "a " + name + " c";
    else if (row.compare)
      value = "if(a " + name + " c, 1, 2)";
    else
      continue;
    for (const char* test : {" is not null", " > 0.3", " <= -0.6"})
      expect_alike("(" + value + ")" + test);
  }
  EXPECT_GT(held, 500);

  RandomFormula formula(random);
  held = 0;
  for (int round = 0; round < 400; ++round) expect_alike(formula.condition(1 + round % 4));
  EXPECT_GT(held, 4000);
}

struct Bad {
  std::string text, says;
  std::size_t offset;
};

TEST_F(Filter, what_the_columns_do_not_fit_is_refused_at_its_character) {
  const Table other = make("Terms", {column("Code", ColumnKind::text)});
  const Table table =
      make("Units", {column("Name", ColumnKind::text), column("Depth", ColumnKind::numeric),
                     column("Wet", ColumnKind::boolean), column("State", ColumnKind::enumeration),
                     column("Day", ColumnKind::date), column("Term", ColumnKind::term, other.id),
                     column("Above", ColumnKind::relation, other.id)});
  const std::vector<Bad> cases{
      {"dept > 1", "no column 'dept'. It has key, name, depth", 0},
      {"wet and dept > 1", "no column 'dept'", 8},
      {"depth = 'x'", "'depth' holds numbers, not texts", 0},
      {"name = 1", "numbers, not texts", 7},
      {"name > 'a' and name + 1 > 2", "'name' holds texts, not numbers", 15},
      {"state = 'god'", "not a choice of state. Its choices are good, poor", 8},
      {"day > 'yesterday'", "is not a date", 6},
      {"depth and wet", "'depth' holds numbers, not true or false", 0},
      {"wet > 1", "'wet' holds true or false", 0},
      {"name.code = 'x'", "does not contain a key", 0},
      {"term.kode = 'x'", "no column 'kode'", 0},
      {"term = 'x'", "as in term.code", 0},
      {"above = 3", "use a_contains", 0},
      {"a_contains(name, (1))", "not keys of records", 11},
      {"a_contains(above, (1.5))", "whole number", 19},
      {"t_before(name, '1560')", "not times", 9},
      {"depth like '1%'", "'depth' holds numbers, not texts", 0},
      {"exp(depth * 1000 + 9000) > 1", "", 0}};
  write(table, {{1, {{"depth", 1}}}});
  for (const Bad& bad : cases) {
    SCOPED_TRACE(bad.text);
    const auto found = keys(table, bad.text);
    ASSERT_FALSE(found);
    EXPECT_EQ(found.error().code, ErrorCode::invalid) << found.error().detail;
    EXPECT_EQ(found.error().field, "filter");
    if (bad.says.empty()) {
      EXPECT_EQ(found.error().title, "Number out of range");
      continue;
    }
    EXPECT_THAT(found.error().detail, testing::HasSubstr(bad.says));
    EXPECT_EQ(found.error().offset, bad.offset) << found.error().detail;
  }
  EXPECT_TRUE(keys(table, "depth = 1")->size() == 1);  // the connection still works
}

TEST_F(Filter, a_mistake_in_a_name_or_choice_is_corrected) {
  const Table other = make("Terms", {column("Code", ColumnKind::text)});
  const Table table =
      make("Units",
           {column("Depth", ColumnKind::numeric), column("2nd depth", ColumnKind::numeric),
            column("State", ColumnKind::enumeration), column("Term", ColumnKind::term, other.id)});
  struct Mistake {
    std::string text;
    std::string_view reason;
    std::size_t offset, length;
    std::vector<std::string> suggestions;
  };
  for (const Mistake& each : std::vector<Mistake>{
           {"dept > 1", mistake::kUnknownColumn, 0, 4, {"depth"}},
           {"term.kode = 'x'", mistake::kUnknownColumn, 0, 9, {"term.code"}},
           {"trem.code = 'x'", mistake::kUnknownColumn, 0, 9, {"term.code"}},
           {"\"2nd depht\" > 1", mistake::kUnknownColumn, 0, 11, {"\"2nd-depth\""}},
           {"temperature > 1", mistake::kUnknownColumn, 0, 11, {}},
           {"state = 'god'", mistake::kUnknownChoice, 8, 5, {"'good'"}},
           {"depth = 'x'", mistake::kWrongType, 0, 5, {}}}) {
    SCOPED_TRACE(each.text);
    const auto found = keys(table, each.text);
    ASSERT_FALSE(found);
    const Error& problem = found.error();
    EXPECT_EQ(problem.reason, each.reason) << problem.detail;
    EXPECT_EQ(problem.offset, each.offset);
    EXPECT_EQ(problem.length, each.length);
    EXPECT_EQ(problem.suggestions, each.suggestions);
    if (each.suggestions.empty()) continue;
    std::string corrected = each.text;
    corrected.replace(each.offset, each.length, each.suggestions.front());
    EXPECT_TRUE(keys(table, corrected)) << corrected;
  }
}

TEST_F(Filter, what_looks_like_sql_is_a_text_like_any_other) {
  const Table table = make("Units", {column("Name", ColumnKind::text)});
  const std::vector<std::string> names{
      "x' OR '1'='1", "'; DROP TABLE records.t1; --", "$1", "\\", "%", "{}", "E'\\047'"};
  std::map<std::int64_t, std::map<std::string, json>> rows;
  for (std::size_t i = 0; i < names.size(); ++i)
    rows[static_cast<std::int64_t>(i + 1)] = {{"name", names[i]}};
  write(table, rows);
  for (std::size_t i = 0; i < names.size(); ++i) {
    std::string quoted;
    for (const char c : names[i]) quoted += c == '\'' ? "''" : std::string(1, c);
    const auto found = keys(table, "name = '" + quoted + "'");
    ASSERT_TRUE(found) << found.error().detail;
    EXPECT_EQ(*found, std::vector<std::int64_t>{static_cast<std::int64_t>(i + 1)});
  }
  EXPECT_FALSE(keys(table, "name = 'x' OR '1'='1"));
  EXPECT_FALSE(keys(table, "name = 'x'; DROP TABLE records.t1"));
  EXPECT_FALSE(keys(table, "name = \"x\"\"; DROP\""));
}

}  // namespace
}  // namespace strata::store
