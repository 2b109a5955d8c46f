// DXF files: names of layers, colors of marks, and the direction of y.
#include "figure/write_dxf.h"

#include <gtest/gtest.h>

#include <fstream>
#include <set>
#include <sstream>

namespace strata::figure {
namespace {

namespace fs = std::filesystem;

using Pair = std::pair<int, std::string>;

std::vector<Pair> written(const DxfDrawing& drawing) {
  const fs::path path = fs::temp_directory_path() / "strata_dxf_test.dxf";
  EXPECT_TRUE(write_dxf(drawing, path, Progress()));
  std::ifstream file(path);
  std::vector<Pair> pairs;
  std::string code, value;
  while (std::getline(file, code) && std::getline(file, value))
    pairs.emplace_back(std::stoi(code), value);
  fs::remove(path);
  return pairs;
}

// The pairs of each entity or table entry of this type.
std::vector<std::vector<Pair>> all(const std::vector<Pair>& pairs, const std::string& type) {
  std::vector<std::vector<Pair>> found;
  bool is_inside = false;
  for (const Pair& pair : pairs) {
    if (pair.first == 0) is_inside = pair.second == type;
    if (is_inside && pair.first == 0) found.emplace_back();
    if (is_inside) found.back().push_back(pair);
  }
  return found;
}
std::vector<std::string> values(const std::vector<Pair>& pairs, int code) {
  std::vector<std::string> found;
  for (const Pair& pair : pairs)
    if (pair.first == code) found.push_back(pair.second);
  return found;
}

// Paper of 100 × 50 mm at 1 : 2, whose top left is at (1000, 500) on the object.
DxfDrawing drawing() {
  DxfDrawing drawing;
  drawing.area = {{10, 20}, {100, 50}};
  drawing.scale = 2;
  drawing.top_left = {1000, 500};
  return drawing;
}

ClassArea square(const std::string& name, double value) {
  ClassArea area;
  area.name = name;
  area.value = value;
  area.color = {10, 20, 30, 255};
  area.polygons = {{{{{10, 20}, {20, 20}, {20, 25}, {10, 25}}}}};
  return area;
}

TEST(Dxf, YPointsUp) {
  DxfDrawing wanted = drawing();
  wanted.areas = {{"damage", "Damage", 1, {square("Loss", 1)}, {}}};
  wanted.labels = {{{5, 10}, "A"}};
  const auto pairs = written(wanted);
  const auto lines = all(pairs, "LWPOLYLINE");
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_EQ(values(lines[0], 10), (std::vector<std::string>{"1000", "1020", "1020", "1000"}));
  EXPECT_EQ(values(lines[0], 20), (std::vector<std::string>{"500", "500", "490", "490"}));
  EXPECT_EQ(values(lines[0], 1040), (std::vector<std::string>{"1", "200"}));
  const auto text = all(pairs, "TEXT");
  ASSERT_EQ(text.size(), 1u);
  EXPECT_EQ(values(text[0], 11).at(0), "1010");
  EXPECT_EQ(values(text[0], 21).at(0), "480");
}

TEST(Dxf, TheHeaderStatesTheExtentAndTheNextHandle) {
  DxfDrawing wanted = drawing();
  wanted.areas = {{"damage", "Damage", 1, {square("Loss", 1)}, {}}};
  const auto pairs = written(wanted);
  unsigned long highest = 0, next = 0;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const auto& [code, value] = pairs[i];
    if (code == 9 && value == "$HANDSEED") next = std::stoul(pairs[i + 1].second, nullptr, 16);
    if (code == 9 && value == "$EXTMIN") {
      EXPECT_EQ(pairs[i + 2].second, "490");
    }
    if (code == 9 && value == "$EXTMAX") {
      EXPECT_EQ(pairs[i + 1].second, "1020");
    }
    const bool is_handle = (code == 5 || code == 105) && pairs[i - 1].second != "$HANDSEED";
    if (is_handle) highest = std::max(highest, std::stoul(value, nullptr, 16));
  }
  EXPECT_GT(highest, 0x30u);
  EXPECT_GT(next, highest);
}

// AutoCAD opens only files in which all of these handles exist.
TEST(Dxf, AllReferencesExist) {
  DxfDrawing wanted = drawing();
  wanted.areas = {{"damage", "Damage", 1, {square("Loss", 1)}, {}}};
  const auto pairs = written(wanted);
  std::multiset<std::string> handles{"0"};
  for (std::size_t i = 0; i < pairs.size(); ++i)
    if ((pairs[i].first == 5 || pairs[i].first == 105) && pairs[i - 1].second != "$HANDSEED")
      handles.insert(pairs[i].second);
  for (const std::string& handle : handles) EXPECT_EQ(handles.count(handle), 1u) << handle;
  for (const auto& [code, value] : pairs)
    if (code == 330 || code == 340 || code == 350 || code == 390) {
      EXPECT_TRUE(handles.contains(value)) << code << " " << value;
    }
  for (const auto& layer : all(pairs, "LAYER")) EXPECT_EQ(values(layer, 390).size(), 1u);
  for (const auto& block : all(pairs, "BLOCK_RECORD")) EXPECT_EQ(values(block, 340).size(), 1u);
  EXPECT_EQ(all(pairs, "LAYOUT").size(), 2u);
  const auto viewports = all(pairs, "VPORT");
  ASSERT_EQ(viewports.size(), 1u);
  EXPECT_EQ(values(viewports[0], 12).at(0), "1010");  // the middle of the square
  EXPECT_EQ(values(viewports[0], 22).at(0), "495");
}

TEST(Dxf, EachMarkHasItsColorOpacityAndName) {
  DxfDrawing wanted = drawing();
  LayerVectors layer{"cracks", "Cracks", 0.5, {}, {}};
  layer.marks = {{7, "North", {255, 0, 0, 255}, {{10, 20}, {30, 20}}},
                 {8, "South", {0, 0, 255, 255}, {{15, 30}}}};
  wanted.marks = {layer};
  const auto pairs = written(wanted);
  const auto lines = all(pairs, "LWPOLYLINE"), points = all(pairs, "POINT");
  ASSERT_EQ(lines.size(), 1u);
  ASSERT_EQ(points.size(), 1u);
  EXPECT_EQ(values(lines[0], 420), (std::vector<std::string>{"16711680"}));
  EXPECT_EQ(values(points[0], 420), (std::vector<std::string>{"255"}));
  EXPECT_EQ(values(points[0], 440), (std::vector<std::string>{"33554560"}));  // 128 of 255
  EXPECT_EQ(values(points[0], 10), (std::vector<std::string>{"1010"}));
  EXPECT_EQ(values(points[0], 20), (std::vector<std::string>{"480"}));
  EXPECT_EQ(values(points[0], 1000),
            (std::vector<std::string>{"layer", "Cracks", "class", "South", "value"}));
}

TEST(Dxf, NamesOfLayersAreUniqueRegardlessOfCase) {
  DxfDrawing wanted = drawing();
  LayerVectors layer{"damage", "Schäden", 1, {}, {}};
  std::string longest;
  for (int i = 0; i < 100; ++i) longest += "損";
  for (const std::string& name : {std::string("Öl"), std::string("öl"), longest + "a",
                                  longest + "b", std::string("Öl 2"), std::string("ÖL")})
    layer.areas.push_back(square(name, static_cast<double>(layer.areas.size())));
  wanted.areas = {layer};
  std::vector<std::string> names;
  for (const auto& entry : all(written(wanted), "LAYER")) names.push_back(values(entry, 2).at(0));
  ASSERT_EQ(names.size(), 7u);
  EXPECT_EQ(names[1], "Schäden - Öl");
  EXPECT_EQ(names[2], "Schäden - öl 2");
  EXPECT_EQ(names[5], "Schäden - Öl 2 2");
  EXPECT_EQ(names[6], "Schäden - ÖL 3");
  EXPECT_LE(names[3].size(), 200u);
  EXPECT_TRUE(names[3].ends_with("損")) << names[3];
  EXPECT_EQ(names[4], names[3] + " 2");
}

}  // namespace
}  // namespace strata::figure
