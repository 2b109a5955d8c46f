// The language of formulas over layers, and the texels for which conditions are true.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <sstream>

#include "expression/expression_parser.h"
#include "query/conditions/evaluation_plan.h"
#include "query/conditions/expression_evaluator.h"

namespace strata::query {
namespace {

constexpr int kSide = 256;

// Four of five texels are surface. The others are gutter.
mesh::SurfaceMap full_map() {
  mesh::SurfaceMap map;
  map.resolution = kSide;
  map.blocks_per_side = kSide / kBlockSize;
  const auto blocks = static_cast<std::uint32_t>(map.blocks_per_side * map.blocks_per_side);
  for (std::uint32_t block = 0; block < blocks; ++block) {
    map.slot_of_block.push_back(block);
    map.block_of_slot.push_back(block);
    std::uint64_t surface = 0;
    for (int i = 0; i < 64; ++i)
      if ((block + static_cast<unsigned>(i)) % 5 != 0) surface |= std::uint64_t{1} << i;
    map.surface_mask.push_back(surface);
    map.packed_position.insert(map.packed_position.end(), 64, mesh::kNoPosition);
  }
  return map;
}

using Value = std::optional<double>;

struct TestLayer {
  LayerView view;
  std::function<Value(int x, int y)> at;
};

TestLayer layer(const std::string& slug, ValueType type, int resolution,
                std::function<Value(int, int)> at) {
  TestLayer made;
  made.at = std::move(at);
  made.view.layer.slug = slug;
  made.view.layer.type = type;
  made.view.layer.resolution = resolution;
  for (int ty = 0; ty < resolution / kTileSize; ++ty)
    for (int tx = 0; tx < resolution / kTileSize; ++tx) {
      auto tile = std::make_shared<TileData>(type);
      for (int i = 0; i < kTexelsPerTile; ++i)
        if (const Value value =
                made.at(tx * kTileSize + i % kTileSize, ty * kTileSize + i / kTileSize)) {
          const float number = static_cast<float>(*value);
          tile->write(i, type == ValueType::f32 ? std::bit_cast<std::uint32_t>(number)
                                                : *encode_value(type, *value));
        }
      made.view.snapshot.tiles[{static_cast<std::uint16_t>(tx), static_cast<std::uint16_t>(ty)}] =
          tile;
    }
  return made;
}

const TestLayer& wet() {  // two of three texels have a value
  static const TestLayer made = layer("wet", ValueType::f32, kSide, [](int x, int y) -> Value {
    if ((x + y) % 3 == 0) return {};
    return x % 16 == 7 ? std::numeric_limits<float>::infinity() : (x - y) / 16.0;
  });
  return made;
}
const TestLayer& crack() {
  static const TestLayer made =
      layer("roof-crack", ValueType::i8, kSide,
            [](int x, int y) -> Value { return x * y % 2 == 0 ? Value(y % 7 - 3) : Value(); });
  return made;
}
const TestLayer& coarse() {
  static const TestLayer made = layer("3d", ValueType::u8, kSide / 2, [](int x, int y) -> Value {
    return x % 4 == 0 ? Value() : Value((x + 2 * y) % 9);
  });
  return made;
}
const TestLayer& fine() {
  static const TestLayer made = layer("fine", ValueType::u16, kSide * 2, [](int x, int y) -> Value {
    return Value((3 * x + y) % 1000);
  });
  return made;
}

std::vector<LayerView> views() { return {wet().view, crack().view, coarse().view, fine().view}; }

// The values of the layers at a texel. A value is missing if it is not finite.
struct At {
  Value wet, crack, coarse;
  double fine;
};
At at(int x, int y) {
  Value w = wet().at(x, y);
  if (w && !std::isfinite(*w)) w.reset();
  return {w, crack().at(x, y), coarse().at(x / 2, y / 2), *fine().at(2 * x + 1, 2 * y + 1)};
}

void expect_selected(const std::string& text,
                     const std::function<bool(int x, int y, const At&)>& expected) {
  SCOPED_TRACE(text);
  const mesh::SurfaceMap map = full_map();
  const auto condition = parse_condition(text, "where");
  ASSERT_TRUE(condition) << condition.error().detail;
  for (const int threads : {1, 3}) {
    const auto selection = select_where({*condition}, views(), map, "where", threads);
    ASSERT_TRUE(selection) << selection.error().detail;
    int selected = 0, wrong = 0;
    for (std::uint32_t slot = 0; slot < map.block_of_slot.size(); ++slot)
      for (int i = 0; i < 64; ++i) {
        const int x = static_cast<int>(slot) % map.blocks_per_side * 8 + i % 8,
                  y = static_cast<int>(slot) / map.blocks_per_side * 8 + i / 8;
        const bool surface = (map.surface_mask[slot] >> i) & 1u,
                   is = ((*selection)[slot] >> i) & 1u;
        selected += is;
        wrong += is != (surface && expected(x, y, at(x, y)));
      }
    EXPECT_EQ(wrong, 0);
    if (text != "false") {
      EXPECT_GT(selected, 0);
    }
  }
}

TEST(Expression, a_condition_selects_the_surface_texels_where_it_holds) {
  using Case = std::pair<const char*, std::function<bool(int, int, const At&)>>;
  const std::vector<Case> cases{
      {"true", [](int, int, const At&) { return true; }},
      {"false", [](int, int, const At&) { return false; }},
      {"wet > 0.25", [](int, int, const At& a) { return a.wet && *a.wet > 0.25; }},
      {"WET >= -2e-1 AND wet<=1",
       [](int, int, const At& a) { return a.wet && *a.wet >= -0.2 && *a.wet <= 1; }},
      {"roof-crack = 2 or roof-crack == -1",
       [](int, int, const At& a) { return a.crack && (*a.crack == 2 || *a.crack == -1); }},
      {"roof-crack <> 2 and roof-crack != 1",
       [](int, int, const At& a) { return a.crack && *a.crack != 2 && *a.crack != 1; }},
      {"valid(wet)", [](int x, int y, const At&) { return wet().at(x, y).has_value(); }},
      {"not valid(roof-crack)", [](int, int, const At& a) { return !a.crack; }},
      {"wet - roof-crack < 1",
       [](int, int, const At& a) { return a.wet && a.crack && *a.wet - *a.crack < 1; }},
      {"1 + 2 * wet - wet / 2 - 1 > 3",
       [](int, int, const At& a) { return a.wet && 1 + 2 * *a.wet - *a.wet / 2 - 1 > 3; }},
      {"-(wet) > 1", [](int, int, const At& a) { return a.wet && -*a.wet > 1; }},
      {"2 - -wet > 3", [](int, int, const At& a) { return a.wet && 2 + *a.wet > 3; }},
      {"\"3d\" >= 5", [](int, int, const At& a) { return a.coarse && *a.coarse >= 5; }},
      {"fine < 500", [](int, int, const At& a) { return a.fine < 500; }},
      {"abs(wet) < 1 and max(fine, \"3d\", 4) > 100 and min(fine, 5) = 5",
       [](int, int, const At& a) {
         return a.wet && std::abs(*a.wet) < 1 && a.coarse && a.fine > 100;
       }},
      {"if(valid(roof-crack), roof-crack, 9) > 2",
       [](int, int, const At& a) { return !a.crack || *a.crack > 2; }},
      {"wet between -1 and 0.5 + 1",
       [](int, int, const At& a) { return a.wet && *a.wet >= -1 && *a.wet <= 1.5; }},
      {"wet NOT BETWEEN 0 AND 1 and true",
       [](int, int, const At& a) { return a.wet && (*a.wet < 0 || *a.wet > 1); }},
      {"roof-crack in (2, -1, 1 + 2)",
       [](int, int, const At& a) {
         return a.crack && (*a.crack == 2 || *a.crack == -1 || *a.crack == 3);
       }},
      {"roof-crack not in (0) or false",
       [](int, int, const At& a) { return a.crack && *a.crack != 0; }},
      {"roof-crack IS NULL", [](int, int, const At& a) { return !a.crack; }},
      {"wet + roof-crack is not null", [](int, int, const At& a) { return a.wet && a.crack; }},
      {"sqrt(wet) is not null and sqrt(wet) > 1",
       [](int, int, const At& a) { return a.wet && *a.wet > 1; }},
      {"fine % 7 = 3 and fine div 100 = 4",
       [](int, int, const At& a) {
         return static_cast<int>(a.fine) % 7 == 3 && static_cast<int>(a.fine) / 100 == 4;
       }},
      {"-7 % 4 = -3 and -7 div 4 = -1 and wet > 0",
       [](int, int, const At& a) { return a.wet && *a.wet > 0; }},
      {"wet ^ 2 > 4", [](int, int, const At& a) { return a.wet && *a.wet * *a.wet > 4; }},
      {"-2 ^ 2 = 4 and 2 ^ -1 = 0.5 and 3 * 2 ^ 2 = 12", [](int, int, const At&) { return true; }},
      {"case when wet > 1 then 10 when wet > 0 then 5 else 0 end >= 5",
       [](int, int, const At& a) { return a.wet && *a.wet > 0; }},
      {"reclass(wet, 0, 0, 5, 1, 10) >= 5",
       [](int, int, const At& a) { return a.wet && *a.wet >= 0; }},
      {"reclass(wet * 2, 1, 2, 7) = 7 and reclass(3, 0, 3, 8, 9, 9) = 8",
       [](int, int, const At& a) { return a.wet && *a.wet >= 1; }},
      {"case when valid(wet) then 1 end is null",
       [](int x, int y, const At&) { return !wet().at(x, y); }},
      {"floor(wet) = 1 or ceil(wet) = 1 or round(wet) = 1",
       [](int, int, const At& a) {
         return a.wet &&
                (std::floor(*a.wet) == 1 || std::ceil(*a.wet) == 1 || std::round(*a.wet) == 1);
       }},
      {"abs(sin(wet) ^ 2 + cos(wet) ^ 2 - 1) < 1e-9",
       [](int, int, const At& a) { return a.wet.has_value(); }},
      {"abs(tan(atan(wet)) - wet) < 1e-6 and abs(degrees(acos(0)) - 90) + abs(radians(180) - 2 * asin(1)) < 1e-9",
       [](int, int, const At& a) { return a.wet.has_value(); }},
      {"abs(exp(ln(fine)) - fine) < 1e-6 and log10(1000) = 3",
       [](int, int, const At& a) { return a.fine > 0; }},
  };
  for (const auto& [text, expected] : cases) expect_selected(text, expected);
}

TEST(Expression, layers_of_every_type_and_resolution_read_alike) {
  const mesh::SurfaceMap map = full_map();
  for (const auto type : {ValueType::u8, ValueType::i8, ValueType::u16, ValueType::i16,
                          ValueType::u32, ValueType::i32, ValueType::f16, ValueType::f32}) {
    SCOPED_TRACE(name(type));
    const double low = lowest_value(type) < 0 ? -60 : 0;
    const auto value = [&](int x, int y) -> Value {
      return (x + 2 * y) % 5 == 0 ? Value() : Value((7 * x + y) % 120 + low);
    };
    // The same content at the resolution of the map and at half of that, where one texel covers
    // four.
    const auto own = layer("own", type, kSide, [&](int x, int y) { return value(x / 2, y / 2); }),
               half = layer("half", type, kSide / 2, value);
    const auto selection = [&](const char* text) {
      return *select_where({*parse_condition(text, "")}, {own.view, half.view}, map, "where");
    };
    EXPECT_EQ(selection("own > 20"), selection("half > 20"));
    EXPECT_EQ(selection("valid(own)"), selection("valid(half)"));
    const auto equal = selection("own = half");
    EXPECT_EQ(equal, selection("valid(own)"));
    EXPECT_GT(std::popcount(equal.front()), 10);
  }
}

TEST(Expression, what_is_not_known_is_not_selected_nor_is_its_contrary) {
  expect_selected("not wet > 0.25",
                  [](int, int, const At& a) { return a.wet && !(*a.wet > 0.25); });
  expect_selected("wet > 0 or roof-crack > 0", [](int, int, const At& a) {
    return (a.wet && *a.wet > 0) || (a.crack && *a.crack > 0);
  });
  expect_selected("not (wet > 0 and roof-crack > 0)", [](int, int, const At& a) {
    return (a.wet && !(*a.wet > 0)) || (a.crack && !(*a.crack > 0));
  });
  expect_selected("not (wet > 0 or roof-crack > 0)", [](int, int, const At& a) {
    return a.wet && !(*a.wet > 0) && a.crack && !(*a.crack > 0);
  });
  expect_selected("1 / roof-crack > 0 or 1 / roof-crack <= 0",
                  [](int, int, const At& a) { return a.crack && *a.crack != 0; });
  expect_selected("if(wet > 0, 1, 2) > 0", [](int, int, const At& a) { return a.wet.has_value(); });
  expect_selected("if(true, fine, wet) >= 0", [](int, int, const At&) { return true; });
}

TEST(Expression, null_is_unknown_wherever_it_is_used) {
  const auto map = full_map();
  for (const char* text : {"null > 1", "null = null", "wet + null > 0", "not (null is null)",
                           "max(null, wet) > -99"}) {
    const auto selection = select_where({*parse_condition(text, "")}, views(), map, "where");
    for (const auto bits : *selection) ASSERT_EQ(bits, 0u) << text;
  }
}

TEST(Expression, or_binds_loosest_and_a_sign_most_tightly) {
  EXPECT_EQ(*parse_condition("not a is null and b in (1, 2) or c not between 1 and 3", ""),
            *parse_condition(
                "((not (a is null)) and (b = 1 or b = 2)) or (not (c >= 1 and c <= 3))", ""));
  EXPECT_EQ(*parse_number("a * b ^ -c % d", ""), *parse_number("(a * (b ^ (-c))) % d", ""));
  EXPECT_EQ(*parse_condition("a > 1 or b > 2 and not c > 3", ""),
            *parse_condition("(a > 1) or ((b > 2) and (not (c > 3)))", ""));
  EXPECT_EQ(*parse_number("a + b * -c - d / e", ""),
            *parse_number("(a + (b * (-c))) - (d / e)", ""));
  EXPECT_EQ(parse_number("a-b", "")->name, "a-b");
  EXPECT_EQ(parse_number("a -b", "")->op, Expression::Op::subtract);
  EXPECT_THAT(layers_of(*parse_condition("b > a or valid(c) and b = 1", "")),
              testing::ElementsAre("b", "a", "c"));
}

TEST(Expression, a_long_row_of_alternatives_is_not_deep) {
  std::string text = "a = 0";
  for (int i = 1; i < 200; ++i) text += " or a = " + std::to_string(i);
  const auto parsed = parse_condition(text, "where");
  ASSERT_TRUE(parsed) << parsed.error().detail;
  EXPECT_EQ(parsed->parts.size(), 200u);
}

// The record of the key k of `roof-crack`.
struct Finding {
  double width;
  bool wet;
};
std::optional<Finding> finding(double key) {
  if (key < 0) return {};
  return Finding{key * 2 - 1, key == 2};
}

// Returns "a, b, …": every `step`th number, multiplied by `unit`.
std::string numbers_between(int low, int high, int step, double unit = 1) {
  std::ostringstream text;
  for (int n = low; n <= high; n += step) text << (n == low ? "" : ",") << n * unit;
  return text.str();
}

TEST(Expression, a_list_selects_as_its_comparisons_do_for_every_type) {
  const auto is_listed = [](Value v, double step) { return v && std::fmod(*v + 30, step) == 0; };
  const std::string eighths = numbers_between(-128, 128, 1, 0.125),
                    thirds = numbers_between(-30, 999, 3);
  expect_selected("wet in (" + eighths + ")",
                  [&](int, int, const At& a) { return is_listed(a.wet, 0.125); });
  expect_selected("wet not in (1, 2, 3)", [&](int, int, const At& a) {
    return a.wet && *a.wet != 1 && *a.wet != 2 && *a.wet != 3;
  });
  expect_selected("fine in (" + thirds + ")",
                  [&](int, int, const At& a) { return is_listed(a.fine, 3); });
  expect_selected("\"3d\" in (" + thirds + ")",
                  [&](int, int, const At& a) { return is_listed(a.coarse, 3); });
  expect_selected("\"3d\" not in (" + thirds + ")",
                  [&](int, int, const At& a) { return a.coarse && !is_listed(a.coarse, 3); });
  expect_selected("\"roof-crack\" + 0 in (" + thirds + ")",
                  [&](int, int, const At& a) { return is_listed(a.crack, 3); });
  expect_selected("abs(wet) in (" + thirds + ") or \"3d\" in (1, 2, 8)",
                  [&](int, int, const At& a) {
                    return (a.wet && is_listed(std::abs(*a.wet), 3)) ||
                           (a.coarse && (*a.coarse == 1 || *a.coarse == 2 || *a.coarse == 8));
                  });
  expect_selected("wet <> 1 and wet <> 2 and 3 <> wet and wet <> -0.0", [](int, int, const At& a) {
    return a.wet && *a.wet != 1 && *a.wet != 2 && *a.wet != 3 && *a.wet != 0;
  });
  expect_selected("wet in (1, \"3d\", null, 2, 3, 4)", [](int, int, const At& a) {
    return a.wet && (*a.wet == 1 || *a.wet == 2 || *a.wet == 3 || *a.wet == 4 ||
                     (a.coarse && *a.wet == *a.coarse));
  });
  expect_selected("wet not in (1, 2, 3, null) or wet = 5",
                  [](int, int, const At& a) { return a.wet == 5; });
}

TEST(Expression, a_condition_over_one_layer_of_bytes_is_what_its_parts_are) {
  expect_selected(
      "not (\"roof-crack\" between -1 and 1 and \"roof-crack\" <> 0) or \"roof-crack\" is null",
      [](int, int, const At& a) { return !a.crack || *a.crack == 0 || std::abs(*a.crack) > 1; });
  expect_selected("case when valid(\"3d\") then \"3d\" ^ 2 else 11 end > 10",
                  [](int, int, const At& a) { return !a.coarse || *a.coarse * *a.coarse > 10; });
}

TEST(Expression, the_steps_at_a_texel_do_not_grow_with_a_list) {
  const auto steps = [](const std::string& text) {
    const auto condition = parse_condition(text, "where");
    EXPECT_TRUE(condition) << condition.error().detail;
    return steps_of(plan_evaluation(*condition, views(), "where")->root);
  };
  const std::string few = numbers_between(1, 5, 1), many = numbers_between(1, 900, 1);
  EXPECT_EQ(steps("wet in (" + many + ")"), steps("wet in (" + few + ")"));
  EXPECT_EQ(steps("wet not in (" + many + ")"), steps("wet not in (" + few + ")"));
  std::string chain = "wet = 0", nested = "wet = 0", contrary = "wet <> 0";
  for (int i = 1; i < 200; ++i) {
    chain += " or wet = " + std::to_string(i);
    nested = i < 60 ? "(" + nested + " or wet = " + std::to_string(i) + ")" : nested;
    contrary += " and wet <> " + std::to_string(i);
  }
  EXPECT_EQ(steps(chain), steps("wet in (1, 2, 3)"));
  EXPECT_EQ(steps(nested), steps("wet in (1, 2, 3)"));
  EXPECT_EQ(steps(contrary), steps("wet <> 1 and wet <> 2 and wet <> 3"));
}

TEST(NumberSet, finds_what_it_was_given_and_nothing_else) {
  std::vector<double> numbers{-0.0, 1e300, -1e-300};
  for (int i = 0; i < 1900; ++i) numbers.push_back(i * 1024.0);
  const NumberSet set(numbers);
  EXPECT_EQ(set.size(), 1902u);
  for (const double number : numbers) EXPECT_TRUE(set.contains(number)) << number;
  EXPECT_TRUE(set.contains(0.0));
  for (int i = 0; i < 1900; ++i) EXPECT_FALSE(set.contains(i * 1024.0 + 1)) << i;
  EXPECT_FALSE(NumberSet({}).contains(0));
}

TEST(Expression, a_computed_layer_holds_what_the_formula_is_at_each_texel) {
  const auto map = full_map();
  using Case = std::pair<const char*, std::function<Value(const At&)>>;
  const std::vector<Case> cases{
      {"wet * 2 + roof-crack",
       [](const At& a) { return a.wet && a.crack ? Value(*a.wet * 2 + *a.crack) : Value(); }},
      {"if(valid(roof-crack), 1, fine)", [](const At& a) { return Value(a.crack ? 1 : a.fine); }},
      {"1 / roof-crack",
       [](const At& a) { return a.crack && *a.crack != 0 ? Value(1 / *a.crack) : Value(); }},
      // No texel is painted where a condition is false or unknown.
      {"wet > 0.5 and not valid(roof-crack)",
       [](const At& a) { return a.wet && *a.wet > 0.5 && !a.crack ? Value(1) : Value(); }},
      {"not (wet > 0.5)", [](const At& a) { return a.wet && *a.wet <= 0.5 ? Value(1) : Value(); }},
  };
  for (const auto& [text, expected] : cases)
    for (const ValueType type : {ValueType::f32, ValueType::i32}) {
      SCOPED_TRACE(std::string(text) + " " + std::string(name(type)));
      const auto number = parse_number(text, "");
      const auto tiles = compute_tiles({number ? *number : *parse_condition(text, "")}, views(),
                                       map, {}, type, "", 3);
      ASSERT_TRUE(tiles) << tiles.error().detail;
      int wrong = 0, valid = 0;
      for (std::uint32_t slot = 0; slot < map.block_of_slot.size(); ++slot)
        for (int i = 0; i < 64; ++i) {
          const int x = static_cast<int>(slot) % map.blocks_per_side * 8 + i % 8,
                    y = static_cast<int>(slot) / map.blocks_per_side * 8 + i / 8;
          const bool surface = (map.surface_mask[slot] >> i) & 1u;
          const auto tile = tiles->find({static_cast<std::uint16_t>(x / kTileSize),
                                         static_cast<std::uint16_t>(y / kTileSize)});
          const int texel = y % kTileSize * kTileSize + x % kTileSize;
          const bool is = tile != tiles->end() && tile->second->valid.test(texel);
          Value expected_value = surface ? expected(at(x, y)) : Value();
          if (expected_value)
            expected_value = type == ValueType::f32
                                 ? static_cast<double>(static_cast<float>(*expected_value))
                                 : std::round(*expected_value);
          valid += is;
          wrong += is != expected_value.has_value() ||
                   (is && decode_value(type, tile->second->bits(texel)) != *expected_value);
        }
      EXPECT_EQ(wrong, 0);
      EXPECT_GT(valid, 1000);
    }
  const auto refused =
      compute_tiles({*parse_number("fine + 1", "")}, views(), map, {}, ValueType::u8, "");
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().field, "type");
}

TEST(Expression, parts_over_records_are_looked_up_by_key) {
  const auto map = full_map();
  using Case = std::pair<const char*, std::function<bool(int, int, const At&)>>;
  const std::vector<Case> cases{
      {"roof-crack.width > 0", [](int, int, const At& a) { return a.crack && *a.crack > 0; }},
      {"roof-crack.width + wet > 1",
       [](int, int, const At& a) {
         return a.crack && *a.crack >= 0 && a.wet && *a.crack * 2 - 1 + *a.wet > 1;
       }},
      {"not roof-crack.wet and wet > 0",
       [](int, int, const At& a) {
         return a.crack && *a.crack >= 0 && *a.crack != 2 && a.wet && *a.wet > 0;
       }},
      // Other keys have unknown values.
      {"roof-crack.width is null", [](int, int, const At&) { return false; }},
  };
  for (const auto& [text, expected] : cases) {
    SCOPED_TRACE(text);
    const auto split = split_records(*parse_condition(text, ""), "");
    ASSERT_TRUE(split);
    BoundExpression bound{split->expression, {}};
    for (const RecordPart& part : split->parts) {
      EXPECT_EQ(part.layer, "roof-crack");
      std::vector<KeyNumber> numbers;
      for (const std::uint32_t key : {0u, 1u, 2u, 3u}) {
        const Finding found = *finding(key);
        const bool is_width =
            layers_of(part.expression).empty() && part.expression.op == Expression::Op::column;
        const auto text_of_part = [&] { return part.expression; }();
        if (is_width)
          numbers.push_back({key, found.width});
        else if (text_of_part.op == Expression::Op::greater)
          numbers.push_back({key, found.width > 0 ? 1.0 : 0.0});
        else if (text_of_part.op == Expression::Op::negation &&
                 text_of_part.parts[0].op == Expression::Op::holds)
          numbers.push_back({key, found.wet ? 0.0 : 1.0});
        else
          numbers.push_back({key, 0.0});  // "width is null" is never true for a record
      }
      bound.records.emplace_back(numbers);
    }
    const auto selection = select_where(bound, views(), map, "");
    ASSERT_TRUE(selection);
    int wrong = 0, selected = 0;
    for (std::uint32_t slot = 0; slot < map.block_of_slot.size(); ++slot)
      for (int i = 0; i < 64; ++i) {
        const int x = static_cast<int>(slot) % map.blocks_per_side * 8 + i % 8,
                  y = static_cast<int>(slot) / map.blocks_per_side * 8 + i / 8;
        const bool surface = (map.surface_mask[slot] >> i) & 1u,
                   is = ((*selection)[slot] >> i) & 1u;
        selected += is;
        wrong += is != (surface && expected(x, y, at(x, y)));
      }
    EXPECT_EQ(wrong, 0);
    if (std::string_view(text).find("null") == std::string_view::npos) {
      EXPECT_GT(selected, 0);
    }
  }
}

TEST(Expression, the_largest_parts_that_read_one_record_are_answered_once_a_record) {
  const auto split = [](const char* text) {
    return *split_records(*parse_condition(text, ""), "");
  };
  EXPECT_EQ(split("a.b = 'x' and a.c > 1 and wet > 0").parts.size(), 2u);
  // `and` joins all three conditions.
  EXPECT_EQ(split("(a.b = 'x' and a.c > 1) and wet > 0").parts.size(), 2u);
  EXPECT_EQ(split("not (a.b = 'x' or a.c > 1) and wet > 0").parts.size(), 1u);
  EXPECT_EQ(split("a.c + 1 > a.d * 2").parts.size(), 1u);
  EXPECT_EQ(split("a.c > b.c").parts.size(), 2u);
  // The part occurs once, although the layer is named twice.
  EXPECT_EQ(split("a.c > wet or a.c < 0 - wet").parts.size(), 1u);
  EXPECT_EQ(split("wet > 1").parts.size(), 0u);
  EXPECT_EQ(split("a.material.code = 'x'").parts[0].expression.parts[0].path,
            (std::vector<std::string>{"material", "code"}));
  for (const char* text : {"t_before('1560', '1570') and wet > 1", "casei(a.b) = casei(b.b)"})
    EXPECT_FALSE(split_records(*parse_condition(text, ""), "")) << text;
}

TEST(Expression, numbers_of_records_are_found_by_any_key) {
  const RecordNumbers numbers({{4294967295u, 3}, {7, 1}, {70000, 2}, {65535, 4}});
  EXPECT_EQ(numbers.of(7), 1);
  EXPECT_EQ(numbers.of(70000), 2);
  EXPECT_EQ(numbers.of(4294967295u), 3);
  EXPECT_EQ(numbers.of(65535), 4);
  for (const std::uint32_t key : {0u, 8u, 65536u, 70001u})
    EXPECT_TRUE(std::isnan(numbers.of(key))) << key;
  EXPECT_TRUE(std::isnan(RecordNumbers().of(0)));
}

TEST(Expression, a_word_is_a_function_only_before_a_bracket) {
  EXPECT_EQ(parse_number("date + 1", "", Names::columns)->parts[0].path,
            std::vector<std::string>{"date"});
  EXPECT_EQ(parse_number("min", "")->name, "min");
  EXPECT_EQ(parse_condition("wet", "", Names::columns)->op, Expression::Op::holds);
}

struct Bad {
  std::string text, says;
};

class BadExpression : public testing::TestWithParam<Bad> {};

TEST_P(BadExpression, is_refused_with_the_reason_and_the_place) {
  const auto parsed = parse_condition(GetParam().text, "edit.where");
  ASSERT_FALSE(parsed);
  EXPECT_EQ(parsed.error().code, ErrorCode::invalid);
  EXPECT_EQ(parsed.error().field, "edit.where");
  EXPECT_THAT(parsed.error().detail, testing::HasSubstr(GetParam().says));
}

std::string repeated(const std::string& text, int times) {
  std::string all;
  for (int i = 0; i < times; ++i) all += text;
  return all;
}

INSTANTIATE_TEST_SUITE_P(
    All, BadExpression,
    testing::Values(
        Bad{"", "the end"}, Bad{"   ", "the end"}, Bad{"wet", "Expected a condition"},
        Bad{"1 + 2", "Expected a condition"}, Bad{"wet >", "instead of 'the end' (at character 6)"},
        Bad{"wet > 1 wet", "'wet' was not expected here (at character 9)"},
        Bad{"(wet > 1", "Expected ')'"}, Bad{"wet > 1)", "')' was not expected"},
        Bad{"wet > (1 > 2)", "Expected a number"}, Bad{"true > 1", "Expected a number"},
        Bad{"not wet", "Expected a condition"}, Bad{"wet and true", "Expected a condition"},
        Bad{"1 < wet < 2", "two sides"},
        Bad{"root(wet) > 1",
            "no function 'root'. Available are valid, if, reclass, min, max, abs, sqrt"},
        Bad{"2 ^ 3 ^ 4 > 1", "Write parentheses"}, Bad{"wet in ()", "instead of ')'"},
        Bad{"wet in (1", "Expected ')'"}, Bad{"wet between 1", "Expected 'and'"},
        Bad{"wet is 1", "Expected 'null'"}, Bad{"wet not 1", "'between', 'in' or 'like'"},
        Bad{"case wet end > 1", "Expected 'when'"},
        Bad{"case when wet > 1 then 2 > 1", "Expected a number"},
        Bad{"case when wet > 1 then 2", "Expected 'end'"},
        Bad{"reclass(wet, 1) > 0", "limit and the value"},
        Bad{"reclass(wet, 1, 2) > 0", "Expected ','"},
        Bad{"reclass(wet > 1, 1, 2, 3) > 0", "Expected a number"},
        Bad{"(wet > 1) in (1)", "Expected a number"}, Bad{"valid(1)", "name of a layer"},
        Bad{"valid(wet", "Expected ')'"}, Bad{"valid wet", "'wet' was not expected"},
        Bad{"min(1) > 0", "at least two"}, Bad{"if(wet > 1, 2) > 0", "Expected ','"},
        Bad{"if(wet, 1, 2) > 0", "Expected a condition"}, Bad{"and > 1", "instead of 'and'"},
        Bad{"valid(and)", "double quotes"}, Bad{"wet > 1 ; drop", "no meaning"},
        Bad{"wet > '1'",
            "compared with a column of texts only, not with a number (at character 7)"},
        Bad{"a.b = 'x", "closing quote is missing"},
        Bad{"a.b = 'x' + 1", "Expected a number here, not a text"}, Bad{"a.", "name of a column"},
        Bad{"a.1 = 2", "was not expected"}, Bad{"a.b like 1", "in single quotes"},
        Bad{"1 like 'x'", "texts only"}, Bad{"a.b like 'x\\'", "must follow"},
        Bad{"casei(1) = 'x'", "Expected a text or a column"},
        Bad{"date(1) = a.b", "in single quotes"}, Bad{"a.b > date('spring')", "is not a date"},
        Bad{"t_before(a.b, interval('2', '1'))", "is no"}, Bad{"t_before(a.b)", "Expected ','"},
        Bad{"a_contains(a, (1))", "column of keys"}, Bad{"a_contains(a.b, 1)", "Expected '('"},
        Bad{"valid(a.b)", "is not null"}, Bad{"a.b = 'w\xff'", "not encoded as UTF-8"},
        Bad{"a.k = '\xc3\xa4\xc3\xb6' and ? = 1", "(at character 16)"},
        Bad{repeated("if(", 14) + "wet between 0 and 1" + repeated(", 1, 0) between 0 and 1", 14),
            "too many parts"},
        Bad{"wet > 1.2.3", "A number ends here"}, Bad{"3d > 1", "double quotes"},
        Bad{"wet > 1e999", "too large"}, Bad{"\"wet > 1", "double quote is missing"},
        Bad{"\"\" > 1", "name is missing"}, Bad{"wet > 1 or", "the end"},
        Bad{"wet ! 1", "no meaning"}, Bad{"w\xc3\xa4nde > 1", "no meaning"},
        Bad{repeated("(", 2000) + "true", "nested too deeply"},
        Bad{repeated("not ", 1000) + "true", "nested too deeply"},
        Bad{repeated("-", 4000) + "1 > 0", "nested too deeply"},
        Bad{"0 < 1" + repeated("+1", 100), "nested too deeply"},
        Bad{"wet > 1" + repeated(" ", 5000), "at most 4096"}));

TEST(Expression, a_layer_that_is_not_there_is_named) {
  const auto condition = parse_condition("wet > 0 and salt > 1", "where");
  ASSERT_TRUE(condition);
  const auto selection = select_where({*condition}, views(), full_map(), "where");
  ASSERT_FALSE(selection);
  EXPECT_EQ(selection.error().code, ErrorCode::invalid);
  EXPECT_THAT(selection.error().detail, testing::HasSubstr("'salt'"));
}

TEST(Expression, a_number_is_wanted_where_a_layer_is_computed) {
  EXPECT_TRUE(parse_number("if(wet > 0.3 and valid(cracks), 1, 0)", ""));
  EXPECT_FALSE(parse_number("wet > 0.3", ""));
}

}  // namespace
}  // namespace strata::query
