#pragma once

#include <cmath>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "support/surfaces.h"

// A flat sheet whose texels have a size of one unit, with or without seams between texels. Seams
// that are cut there move texels in the atlas, and change nothing on the surface.
namespace strata::test {

constexpr int kSheetWidth = 192, kSheetHeight = 128, kSheetResolution = 512;

struct SheetCuts {
  // Columns and rows of the seams, multiples of 8. The parts are moved apart in the atlas.
  std::vector<int> columns{}, rows{};
  // Degrees: turns the part to the right of the only column. Use it without rows.
  double turn = 0;
};

inline Surface cut_sheet(const SheetCuts& cuts = {}) {
  constexpr int kCell = 8, kMargin = 16, kGap = 24;
  mesh::TriangleMesh sheet;
  const int columns = kSheetWidth / kCell, rows = kSheetHeight / kCell;
  for (int y = 0; y <= rows; ++y)
    for (int x = 0; x <= columns; ++x) sheet.positions.push_back({x * kCell, y * kCell, 0});
  const auto gaps = [](const std::vector<int>& at, int cell) {
    int before = 0;
    for (const int cut : at) before += cell * kCell >= cut ? kGap : 0;
    return before;
  };
  mesh::Atlas atlas;
  const auto turned = [&](const glm::dvec2& at) {
    const double cut = cuts.columns.front(), turn = cuts.turn * std::numbers::pi / 180;
    const glm::dvec2 center((cut + kSheetWidth) / 2, kSheetHeight / 2.0), way = at - center;
    const double reach = std::ceil(glm::distance(center, glm::dvec2(cut, 0)));
    return glm::dvec2(cut + kMargin + kGap + reach, kMargin + reach) +
           glm::dvec2(way.x * std::cos(turn) - way.y * std::sin(turn),
                      way.x * std::sin(turn) + way.y * std::cos(turn));
  };
  const auto add = [&](int x, int y, std::initializer_list<std::pair<int, int>> corners) {
    const glm::dvec2 moved(kMargin + gaps(cuts.columns, x), kMargin + gaps(cuts.rows, y));
    const bool turns = cuts.turn != 0 && x * kCell >= cuts.columns.front();
    for (const auto& [dx, dy] : corners) {
      const auto corner = static_cast<std::uint32_t>((y + dy) * (columns + 1) + x + dx);
      sheet.triangles.push_back(corner);
      const glm::dvec2 at(sheet.positions[corner]);
      atlas.corner_uvs.push_back((turns ? turned(at) : at + moved) / double(kSheetResolution));
    }
  };
  for (int y = 0; y < rows; ++y)
    for (int x = 0; x < columns; ++x) {
      add(x, y, {{0, 0}, {1, 0}, {1, 1}});
      add(x, y, {{0, 0}, {1, 1}, {0, 1}});
    }
  Progress progress;
  Surface surface;
  surface.name = "sheet";
  surface.geometry = mesh::build_geometry(sheet, atlas);
  surface.map = *mesh::bake_surface_map(surface.geometry, kSheetResolution, progress);
  surface.graph = *mesh::build_texel_graph(surface.geometry, surface.map, progress);
  return surface;
}

// Returns the column and row of a texel of the sheet.
inline glm::ivec2 sheet_place(const Surface& sheet, std::uint32_t texel) {
  const glm::dvec3 at = sheet.geometry.origin +
                        glm::dvec3(sheet.map.position(texel / 64, static_cast<int>(texel % 64)));
  return {static_cast<int>(std::floor(at.x)), static_cast<int>(std::floor(at.y))};
}

}  // namespace strata::test
