#include "figure/title_block.h"

#include "figure/text.h"

namespace strata::figure {
namespace {

constexpr double kLabel = 1.8, kText = 2.6, kTitle = 3.4;  // letter heights
constexpr double kRow = 7.5, kTitleRow = 11.5;             // heights
constexpr double kPadding = 1.2, kLabelBase = 2.5, kTextBase = 6.2, kTitleLine = 4.3;
constexpr double kBorder = 0.5, kThin = 0.18;  // line widths
constexpr int kMaxTitleLines = 2;

// A field, and its width as a share of the width of the block.
struct Cell {
  const TitleBlock::Field* field;
  double share;
  bool is_title = false;
};
using Row = std::vector<Cell>;

std::vector<Row> rows_of(const TitleBlock& block, BlockShape shape) {
  if (shape == BlockShape::wide)
    return {{{&block.organization, 0.36}, {&block.project, 0.28}, {&block.object, 0.36}},
            {{&block.title, 0.64, true}, {&block.status, 0.18}, {&block.number, 0.18}},
            {{&block.author, 0.28},
             {&block.checked_by, 0.28},
             {&block.date, 0.16},
             {&block.scale, 0.16},
             {&block.sheet, 0.12}}};
  return {{{&block.organization, 0.5}, {&block.project, 0.5}},
          {{&block.object, 0.7}, {&block.status, 0.3}},
          {{&block.title, 1, true}},
          {{&block.author, 0.38}, {&block.checked_by, 0.37}, {&block.date, 0.25}},
          {{&block.scale, 0.3}, {&block.number, 0.45}, {&block.sheet, 0.25}}};
}

double height_of(const Row& row) {
  for (const Cell& cell : row)
    if (cell.is_title) return kTitleRow;
  return kRow;
}

void add_cell(std::vector<Item>& items, const Cell& cell, const Box& box) {
  items.push_back(outline_of(box, kThin));
  const double left = box.corner.x + kPadding, width = box.size.x - 2 * kPadding;
  const auto label = fitted(cell.field->label, kLabel, false, width, 1);
  if (!label.empty())
    items.push_back(Words{{left, box.corner.y + kLabelBase}, label.front(), kLabel});
  const double size = cell.is_title ? kTitle : kText;
  const auto lines =
      fitted(cell.field->text, size, cell.is_title, width, cell.is_title ? kMaxTitleLines : 1);
  // A single line of a title is in the middle of the space below the label.
  double y = box.corner.y + kTextBase + (cell.is_title && lines.size() == 1 ? kTitleLine / 2 : 0);
  for (const std::string& line : lines) {
    items.push_back(Words{{left, y}, line, size, cell.is_title});
    y += kTitleLine;
  }
}

}  // namespace

double block_height_mm(BlockShape shape) {
  double height = 0;
  for (const Row& row : rows_of({}, shape)) height += height_of(row);
  return height;
}

Group title_block_group(const TitleBlock& block, BlockShape shape, const glm::dvec2& corner,
                        double width) {
  Group group{"title-block", {}};
  glm::dvec2 at = corner;
  for (const Row& row : rows_of(block, shape)) {
    at.x = corner.x;
    for (const Cell& cell : row) {
      const glm::dvec2 size(cell.share * width, height_of(row));
      add_cell(group.items, cell, {at, size});
      at.x += size.x;
    }
    at.y += height_of(row);
  }
  group.items.push_back(outline_of({corner, {width, at.y - corner.y}}, kBorder));
  return group;
}

}  // namespace strata::figure
