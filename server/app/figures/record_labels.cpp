#include "app/figures/record_labels.h"

#include <algorithm>
#include <map>
#include <optional>

#include "room/pictures.h"
#include "store/tables/records.h"

namespace strata::app {
namespace {

constexpr glm::dvec2 kLabelCell_mm{1.5, 1.5};
constexpr std::size_t kMaxPlaces = 64;  // tested positions per label
constexpr std::size_t kMaxLabels = 2000;

// The grid cells in which a key is visible. The cells farthest from other keys come first.
struct Area {
  std::size_t cells = 0;
  std::vector<std::pair<int, int>> places;  // distance to the border of the area, and the cell
};
std::map<std::uint32_t, Area> areas_of(const std::vector<std::optional<std::uint32_t>>& keys,
                                       int columns, int rows) {
  // Computes the chessboard distance in two passes over the grid. The area outside the grid is
  // treated as another key.
  std::vector<int> inside(keys.size(), 0);
  const auto at = [&](int x, int y) {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(columns) +
           static_cast<std::size_t>(x);
  };
  const auto pass = [&](int x, int y, int step) {
    int least = std::max(columns, rows);
    for (const auto& [dx, dy] : {std::pair{-step, 0}, {0, -step}, {-step, -step}, {step, -step}}) {
      const int nx = x + dx, ny = y + dy;
      const bool same =
          nx >= 0 && ny >= 0 && nx < columns && ny < rows && keys[at(nx, ny)] == keys[at(x, y)];
      least = std::min(least, same ? inside[at(nx, ny)] + 1 : 1);
    }
    return least;
  };
  for (int y = 0; y < rows; ++y)
    for (int x = 0; x < columns; ++x) inside[at(x, y)] = pass(x, y, 1);
  std::map<std::uint32_t, Area> areas;
  for (int y = rows - 1; y >= 0; --y)
    for (int x = columns - 1; x >= 0; --x) {
      const std::size_t cell = at(x, y);
      inside[cell] = std::min(inside[cell], pass(x, y, -1));
      if (!keys[cell]) continue;
      Area& area = areas[*keys[cell]];
      ++area.cells;
      area.places.emplace_back(inside[cell], static_cast<int>(cell));
    }
  return areas;
}

Result<std::map<std::uint32_t, std::string>> texts_of(store::Store& store,
                                                      const FigureRequest& request) {
  const Column& column = request.labels->column;
  const auto found = store.records().texts(*request.labels->layer.table, request.role, column.slug,
                                           "labels.column");
  if (!found) return tl::unexpected(found.error());
  std::map<std::uint32_t, std::string> texts;
  std::map<std::string, std::string> terms;  // labels of terms, by key
  if (column.kind == ColumnKind::term && column.target) {
    const auto labels =
        store.records().texts(*column.target, request.role, "label", "labels.column");
    if (!labels) return tl::unexpected(labels.error());
    for (const auto& [key, text] : *labels) terms[std::to_string(key)] = text;
  }
  for (const auto& [key, text] : *found) {
    const auto term = terms.find(text);
    std::string words = term == terms.end() ? text : term->second;
    if (!column.unit.empty()) words += " " + column.unit;
    texts[static_cast<std::uint32_t>(key)] = std::move(words);
  }
  return texts;
}

}  // namespace

Result<std::vector<figure::Label>> record_labels(store::Store& store, const FigureRequest& request,
                                                 const figure::Drawing& drawing,
                                                 const glm::dvec2& drawing_mm) {
  if (!request.labels) return std::vector<figure::Label>{};
  const int columns = std::max(1, static_cast<int>(drawing_mm.x / kLabelCell_mm.x));
  const int rows = std::max(1, static_cast<int>(drawing_mm.y / kLabelCell_mm.y));
  const glm::dvec2 cell_mm = drawing_mm / glm::dvec2(columns, rows);
  const auto keys = request.room->pictures().seen_keys(
      request.labels->layer.slug, figure::camera_of(drawing), columns, rows, request.shown.at);
  if (!keys) return tl::unexpected(keys.error());
  const auto texts = STRATA_TRY(texts_of(store, request));
  auto areas = areas_of(*keys, columns, rows);
  std::vector<std::pair<std::size_t, std::uint32_t>> by_size;
  for (const auto& [key, area] : areas)
    if (texts.contains(key)) by_size.emplace_back(area.cells, key);
  std::ranges::sort(by_size, std::greater());
  if (by_size.size() > kMaxLabels) by_size.resize(kMaxLabels);
  std::vector<figure::LabelRequest> requests;
  for (const auto& [size, key] : by_size) {
    auto& places = areas[key].places;
    const std::size_t tried = std::min(places.size(), kMaxPlaces);
    std::partial_sort(places.begin(), places.begin() + static_cast<std::ptrdiff_t>(tried),
                      places.end(), [](const auto& a, const auto& b) {
                        return a.first != b.first ? a.first > b.first : a.second < b.second;
                      });
    figure::LabelRequest label{texts.at(key), {}};
    for (std::size_t i = 0; i < tried; ++i)
      label.places.push_back(
          (glm::dvec2(places[i].second % columns, places[i].second / columns) + 0.5) * cell_mm);
    requests.push_back(std::move(label));
  }
  return figure::place_labels(requests, drawing_mm);
}

}  // namespace strata::app
