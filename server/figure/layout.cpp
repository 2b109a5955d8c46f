#include "figure/layout.h"

#include <algorithm>
#include <cmath>

#include "core/text/number_text.h"
#include "figure/paper.h"
#include "figure/pattern.h"
#include "figure/text.h"

namespace strata::figure {
namespace {

constexpr double kGap = 4;
constexpr double kTitle = 4.2, kText = 2.8, kSmall = 2.2;  // letter heights
// Line height, relative to the letter height.
constexpr double kLine = 1.45;
constexpr double kFrame = 0.2, kThin = 0.12;  // line widths
constexpr int kMaxTitleLines = 2, kMaxCaptionLines = 8, kMaxCreditLines = 3;
constexpr double kScaleWidth = 80, kScaleHeight = 16, kMinTextWidth = 40;
constexpr double kSheetFrame = 0.5, kFramePadding = 3;  // of the frame around the sheet
constexpr double kLegendColumn = 56, kSwatchWidth = 6, kSwatchHeight = 3, kEntry = 4.2,
                 kTitleGap = 1.2;

Path rectangle(const glm::dvec2& corner, const glm::dvec2& size) {
  return {{corner, corner + glm::dvec2(size.x, 0), corner + size, corner + glm::dvec2(0, size.y)}};
}

// Returns the part of a line within a box, or nothing if the line misses the box.
std::optional<std::pair<glm::dvec2, glm::dvec2>> clipped(const glm::dvec2& through,
                                                         const glm::dvec2& along, const Box& box) {
  double from = -1e9, to = 1e9;
  for (int axis = 0; axis < 2; ++axis) {
    const double low = box.corner[axis] - through[axis], high = low + box.size[axis];
    if (std::abs(along[axis]) < 1e-12) {
      if (low > 0 || high < 0) return std::nullopt;
      continue;
    }
    from = std::max(from, std::min(low / along[axis], high / along[axis]));
    to = std::min(to, std::max(low / along[axis], high / along[axis]));
  }
  if (from >= to) return std::nullopt;
  return std::pair(through + from * along, through + to * along);
}

constexpr double kHatchStroke = kHatchShare * kSpacing, kDotRadius = kDotShare * kSpacing;

Rgba on_paper(const Rgba& ink, double share) {
  const auto mixed = [&](int channel) {
    return static_cast<std::uint8_t>(
        std::lround(255 + (ink[static_cast<std::size_t>(channel)] - 255) * share));
  };
  return {mixed(0), mixed(1), mixed(2), 255};
}

void add_filled(std::vector<Item>& items, const glm::dvec2& corner, const glm::dvec2& size,
                const Rgba& ink) {
  Path path = rectangle(corner, size);
  path.fill = ink;
  items.push_back(std::move(path));
}

// Draws opaque colors, as in the page's legend and in the drawing.
void add_swatch(std::vector<Item>& items, const Box& box, const LegendEntry& entry) {
  const Rgba ink{entry.color[0], entry.color[1], entry.color[2], 255};
  Path frame = rectangle(box.corner, box.size);
  frame.stroke_mm = kThin;
  if (entry.pattern == Pattern::solid) frame.fill = ink;
  const bool has_lines = entry.pattern == Pattern::hatch || entry.pattern == Pattern::dots;
  if (has_lines && !entry.bare) add_filled(items, box.corner, box.size, on_paper(ink, kGround));
  const glm::dvec2 middle = box.corner + box.size / 2.0;
  const glm::dvec2 along = direction(entry.angle), across(-along.y, along.x);
  // Keeps the corners of the lines inside the box.
  const Box within{box.corner + kHatchStroke / 2, box.size - kHatchStroke};
  if (entry.pattern == Pattern::hatch)
    for (int i = -8; i <= 8; ++i)
      if (const auto line = clipped(middle + (i * kSpacing) * across, along, within)) {
        const glm::dvec2 half = across * (kHatchStroke / 2);
        items.push_back(
            Path{{line->first - half, line->second - half, line->second + half, line->first + half},
                 true,
                 ink});
      }
  if (entry.pattern == Pattern::dots)
    for (int i = -2; i <= 2; ++i) {
      Path dot{{}, true, ink};
      const glm::dvec2 at = middle + glm::dvec2(i * kSpacing, 0);
      if (std::abs(at.x - middle.x) + kDotRadius > box.size.x / 2) continue;
      for (int corner = 0; corner < 12; ++corner)
        dot.points.push_back(at + kDotRadius * direction(30.0 * corner));
      items.push_back(std::move(dot));
    }
  if (entry.pattern == Pattern::solid || entry.bare) {
    items.push_back(std::move(frame));
    return;
  }
  const glm::dvec2 lying(box.size.x, kBorder), standing(kBorder, box.size.y);
  add_filled(items, box.corner, lying, ink);
  add_filled(items, box.corner + glm::dvec2(0, box.size.y - kBorder), lying, ink);
  add_filled(items, box.corner, standing, ink);
  add_filled(items, box.corner + glm::dvec2(box.size.x - kBorder, 0), standing, ink);
}

// The content of one line of a legend.
struct Row {
  enum class Kind { title, entry, ramp, more } kind;
  std::string text;
  const LegendEntry* entry = nullptr;
  const Legend* legend = nullptr;
  double height() const {
    return kind == Kind::ramp ? 2 * kEntry : kind == Kind::title ? kEntry + kTitleGap : kEntry;
  }
};

std::string first_line(const std::string& text, bool bold, double width) {
  const auto lines = wrapped(text, kText, bold, width, 1);
  return lines.empty() ? std::string() : lines[0];
}

using List = std::vector<Row>;  // the rows of one layer, title first

std::vector<List> lists_of(const std::vector<Legend>& legends, double width) {
  std::vector<List> lists;
  for (const Legend& legend : legends) {
    List list{{Row::Kind::title, first_line(legend.title, true, width)}};
    if (!legend.ramp.empty()) list.push_back({Row::Kind::ramp, {}, nullptr, &legend});
    for (const LegendEntry& entry : legend.entries)
      list.push_back(
          {Row::Kind::entry, first_line(entry.label, false, width - kSwatchWidth - 2), &entry});
    lists.push_back(std::move(list));
  }
  return lists;
}

struct PlacedRow {
  Row row;
  int column;
  double y;
};

// Places lists column by column. A list that does not fit below the previous ones begins a new
// column. If `may_break` is true, lists may be split, and each part repeats the title. Returns
// nothing if the lists do not fit.
std::optional<std::vector<PlacedRow>> place_lists(const std::vector<List>& lists, int columns,
                                                  double height, bool may_break,
                                                  const std::string& continued) {
  constexpr double kRounding = 1e-9;
  std::vector<PlacedRow> placed;
  int column = 0;
  double y = 0;
  const auto put = [&](const Row& row) {
    placed.push_back({row, column, y});
    y += row.height();
  };
  const auto has_room = [&](double needed) { return y + needed <= height + kRounding; };
  for (const List& list : lists) {
    double total = 0;
    for (const Row& row : list) total += row.height();
    const double first = list[0].height() + (list.size() > 1 ? list[1].height() : 0);
    const bool stays_whole = total <= height + kRounding && column + 1 < columns;
    if (y > 0 && !has_room(stays_whole || !may_break ? total : first)) {
      ++column;
      y = 0;
    }
    if (column >= columns || !has_room(may_break ? first : total)) return std::nullopt;
    for (const Row& row : list) {
      if (!has_room(row.height())) {
        if (++column >= columns) return std::nullopt;
        y = 0;
        Row title = list[0];
        if (!continued.empty()) title.text += " " + continued;
        put(title);
        if (!has_room(row.height())) return std::nullopt;
      }
      put(row);
    }
  }
  return placed;
}

// Places all rows that fit, and a row with the number of omitted rows.
std::vector<PlacedRow> place_most(const std::vector<List>& lists, int columns, double height,
                                  const std::string& continued) {
  std::size_t all = 0;
  for (const List& list : lists) all += list.size();
  const auto place = [&](std::size_t count) {
    std::vector<List> shortened;
    std::size_t left = count;
    for (const List& list : lists) {
      if (left == 0) break;
      shortened.emplace_back(
          list.begin(), list.begin() + static_cast<std::ptrdiff_t>(std::min(left, list.size())));
      left -= shortened.back().size();
    }
    if (count < all) {
      const Row more{Row::Kind::more, "… + " + std::to_string(all - count)};
      if (shortened.empty()) shortened.emplace_back();
      shortened.back().push_back(more);
    }
    return place_lists(shortened, columns, height, true, continued);
  };
  std::size_t fits = 0, too_many = all + 1;
  while (fits + 1 < too_many) {
    const std::size_t middle = (fits + too_many) / 2;
    (place(middle) ? fits : too_many) = middle;
  }
  return place(fits).value_or(std::vector<PlacedRow>());
}

struct PlacedLegend {
  double height = 0;
  std::vector<PlacedRow> rows;
};

// Places the legend with the smallest height at which no list is split. If that height exceeds
// `whole`, splits lists, so the columns have similar heights.
PlacedLegend place_legend(const std::vector<List>& lists, int columns, double whole, double most,
                          const std::string& continued) {
  for (const bool may_break : {false, true})
    for (double height = kEntry + kTitleGap; height <= (may_break ? most : whole) + 1e-9;
         height += kEntry / 2)
      if (auto rows = place_lists(lists, columns, height, may_break, continued))
        return {height, std::move(*rows)};
  return {most, place_most(lists, columns, most, continued)};
}

void add_row(std::vector<Item>& items, const Row& row, const glm::dvec2& at, double width) {
  const double base = at.y + kEntry - 1.1;
  switch (row.kind) {
    case Row::Kind::title:
      items.push_back(Words{{at.x, base + kTitleGap}, row.text, kText, true});
      return;
    case Row::Kind::more: items.push_back(Words{{at.x, base}, row.text, kText}); return;
    case Row::Kind::entry:
      add_swatch(items, {{at.x, at.y + 0.5}, {kSwatchWidth, kSwatchHeight}}, *row.entry);
      items.push_back(Words{{at.x + kSwatchWidth + 2, base}, row.text, kText});
      return;
    case Row::Kind::ramp: {
      const double length = std::min(width, kLegendColumn - 6),
                   step = length / static_cast<double>(row.legend->ramp.size());
      for (std::size_t i = 0; i < row.legend->ramp.size(); ++i) {
        const Rgba& color = row.legend->ramp[i];
        // Slightly wider bars leave no visible gaps.
        const double wide = i + 1 < row.legend->ramp.size() ? step * 1.2 : step;
        Path bar =
            rectangle({at.x + static_cast<double>(i) * step, at.y + 0.5}, {wide, kSwatchHeight});
        bar.fill = Rgba{color[0], color[1], color[2], 255};
        items.push_back(std::move(bar));
      }
      items.push_back(Words{{at.x, base + kEntry}, row.legend->low, kText});
      items.push_back(
          Words{{at.x + length, base + kEntry}, row.legend->high, kText, false, Anchor::end});
    }
  }
}

std::vector<Item> legend_items(const PlacedLegend& legend, const Box& box, int columns) {
  std::vector<Item> items;
  const double width = box.size.x / columns;
  for (const PlacedRow& placed : legend.rows)
    add_row(items, placed.row, box.corner + glm::dvec2(placed.column * width, placed.y), width - 2);
  return items;
}

double add_lines(std::vector<Item>& items, const std::vector<std::string>& lines,
                 const glm::dvec2& top, double size, bool bold) {
  double y = top.y;
  for (const std::string& line : lines) {
    items.push_back(Words{{top.x, y + size}, line, size, bold});
    y += size * kLine;
  }
  return y;
}

double height_of(const std::vector<std::string>& lines, double size) {
  return static_cast<double>(lines.size()) * size * kLine;
}

// The parts of a sheet that do not depend on its texts.
struct Space {
  Box content;             // of the drawing, the legend and the strip below them
  double strip_width = 0;  // of the caption and the scale bar
  double least_strip = 0;  // height
  Box block;               // empty without a title block
  BlockShape block_shape = BlockShape::wide;
};
// A title block is in the bottom right corner of the frame. It is next to the strip if the paper is
// wide enough for both. Otherwise, it is below the strip and as wide as the frame.
Space space_for(const glm::dvec2& paper, double margin, bool has_block) {
  Space space;
  space.content = {glm::dvec2(margin), paper - 2 * margin};
  space.strip_width = space.content.size.x;
  if (!has_block) return space;
  const Box frame = space.content;
  const glm::dvec2 end = frame.corner + frame.size;
  space.content = {frame.corner + kFramePadding, frame.size - 2 * kFramePadding};
  const double beside = kCompactBlock_mm + kGap;
  const bool is_beside = space.content.size.x >= kMinTextWidth + kGap + kScaleWidth + beside;
  space.block_shape =
      is_beside || frame.size.x < kWideBlock_mm ? BlockShape::compact : BlockShape::wide;
  const double height = block_height_mm(space.block_shape),
               width = is_beside ? kCompactBlock_mm : frame.size.x;
  space.block = {end - glm::dvec2(width, height), {width, height}};
  space.strip_width = space.content.size.x;
  if (is_beside) {
    space.strip_width += kFramePadding - beside;
    space.least_strip = height - kFramePadding;
  } else {
    space.content.size.y += kFramePadding - height - kGap;
  }
  return space;
}

Group bar_group(const ScaleBar& bar, double scale, const glm::dvec2& right_bottom) {
  Group group{"scale-bar", {}};
  constexpr double kBar = 2;
  const glm::dvec2 left(right_bottom.x - bar.length_mm, right_bottom.y - kBar - kSmall - 1);
  const double step_mm = bar.length_mm / bar.steps;
  for (int i = 0; i < bar.steps; ++i) {
    Path step = rectangle(left + glm::dvec2(i * step_mm, 0), {step_mm, kBar});
    step.fill = i % 2 == 0 ? Rgba{0, 0, 0, 255} : Rgba{255, 255, 255, 255};
    step.stroke_mm = kThin;
    group.items.push_back(std::move(step));
  }
  for (int i = 0; i <= bar.steps; ++i) {
    std::string text = short_number(i * bar.step);
    if (i == bar.steps) text += " " + bar.unit;
    group.items.push_back(Words{
        {left.x + i * step_mm, right_bottom.y}, std::move(text), kSmall, false, Anchor::middle});
  }
  group.items.push_back(Words{
      {left.x + bar.length_mm / 2, left.y - 1.4}, scale_text(scale), kText, true, Anchor::middle});
  return group;
}

Group arrow_group(const glm::dvec2& north, const glm::dvec2& middle) {
  constexpr double kLength = 11, kHalfWidth = 2.2;
  const glm::dvec2 tip = middle + north * (kLength / 2), tail = middle - north * (kLength / 2);
  const glm::dvec2 side(-north.y * kHalfWidth, north.x * kHalfWidth), notch = tail + north * 2.2;
  Path dark{{tip, tail + side, notch}, true, Rgba{0, 0, 0, 255}, kThin};
  Path light{{tip, tail - side, notch}, true, Rgba{255, 255, 255, 255}, kThin};
  const glm::dvec2 letter = tip + north * 2.2 + glm::dvec2(0, kText * 0.36);
  return {"north", {dark, light, Words{letter, "N", kText, true, Anchor::middle}}};
}

}  // namespace

glm::dvec2 paper_mm(Paper paper, bool landscape) {
  const glm::dvec2 portrait = paper == Paper::a3   ? glm::dvec2(297, 420)
                              : paper == Paper::a4 ? glm::dvec2(210, 297)
                                                   : glm::dvec2(148, 210);
  return landscape ? glm::dvec2(portrait.y, portrait.x) : portrait;
}

std::string scale_text(double scale) {
  // Groups the digits of large whole numbers by three. short_number has only six digits.
  const auto number = [](double value) {
    if (value < 10'000 || value != std::floor(value)) return short_number(value);
    std::string digits = std::to_string(static_cast<std::int64_t>(value));
    for (auto at = static_cast<std::ptrdiff_t>(digits.size()) - 3; at > 0; at -= 3)
      digits.insert(static_cast<std::size_t>(at), "\u202f");
    return digits;
  };
  return scale >= 1 ? "1 : " + number(scale) : number(1 / scale) + " : 1";
}

ScaleBar scale_bar(double scale, double widest_mm) {
  // The length of the bar is 1, 2 or 5 times a power of ten, in millimeters in the world. The
  // longest bar that fits is used.
  const double most = widest_mm * scale;
  const double decade = std::pow(10, std::floor(std::log10(most)));
  const int digit = most >= 5 * decade ? 5 : most >= 2 * decade ? 2 : 1;
  const double length = digit * decade;
  ScaleBar bar;
  bar.length_mm = length / scale;
  bar.steps = digit == 1 ? 4 : digit == 2 ? 4 : 5;
  const bool km = length >= 2e6, m = length >= 2e3, cm = length >= 20;
  bar.unit = km ? "km" : m ? "m" : cm ? "cm" : "mm";
  bar.step = length / bar.steps / (km ? 1e6 : m ? 1e3 : cm ? 10 : 1);
  return bar;
}

SheetLayout::SheetLayout(glm::dvec2 paper, const Captions& captions,
                         const std::vector<Legend>& legends, int dpi, double margin) {
  sheet_.size = paper;
  block_ = captions.block;
  const Space space = space_for(paper, margin, block_.has_value());
  block_box_ = space.block;
  block_shape_ = space.block_shape;
  const double width = space.content.size.x;
  const glm::dvec2 &top_left = space.content.corner, bottom_right = top_left + space.content.size;
  const double text_width = std::max(kMinTextWidth, space.strip_width - kScaleWidth - kGap);
  const auto title =
      wrapped(block_ ? std::string() : captions.title, kTitle, true, text_width, kMaxTitleLines);
  const auto caption = wrapped(captions.caption, kText, false, text_width, kMaxCaptionLines);
  const auto credit = wrapped(captions.credit, kSmall, false, text_width, kMaxCreditLines);
  const double text_height =
      height_of(title, kTitle) + height_of(caption, kText) + height_of(credit, kSmall) + 2;
  const double strip = std::max({text_height, kScaleHeight, space.least_strip});
  const double strip_top = bottom_right.y - strip;

  Box area{top_left, {width, strip_top - kGap - top_left.y}};
  const bool aside = paper.x > paper.y;  // the legend is at the right of the drawing
  const int columns = aside ? 1 : std::max(1, static_cast<int>(width / kLegendColumn));
  const auto lists = lists_of(legends, aside ? kLegendColumn - 2 : width / columns - 4);
  Group legend{"legend", {}};
  if (!lists.empty() && aside) {
    area.size.x -= kLegendColumn + kGap;
    const auto placed = place_legend(lists, columns, area.size.y, area.size.y, captions.continued);
    legend.items = legend_items(
        placed, {{bottom_right.x - kLegendColumn, top_left.y}, {kLegendColumn, area.size.y}},
        columns);
  } else if (!lists.empty()) {
    const auto placed =
        place_legend(lists, columns, area.size.y / 4, area.size.y / 3, captions.continued);
    area.size.y -= placed.height + kGap;
    legend.items = legend_items(
        placed, {{top_left.x, strip_top - kGap - placed.height}, {width, placed.height}}, columns);
  }

  // The drawing starts and ends at whole pixels, so it has the exact scale in all file formats.
  const auto in_pixels = [&](double mm) { return mm / kInch_mm * dpi; };
  const auto in_mm = [&](double pixels) { return pixels * kInch_mm / dpi; };
  width_ = std::max(1, static_cast<int>(in_pixels(area.size.x)));
  height_ = std::max(1, static_cast<int>(in_pixels(area.size.y)));
  sheet_.drawing = {
      {in_mm(std::round(in_pixels(area.corner.x))), in_mm(std::round(in_pixels(area.corner.y)))},
      {in_mm(width_), in_mm(height_)}};

  Group frame{"frame", {}};
  Path border = rectangle(sheet_.drawing.corner, sheet_.drawing.size);
  border.stroke_mm = kFrame;
  frame.items.push_back(std::move(border));
  Group words{"caption", {}};
  double y = add_lines(words.items, title, {top_left.x, strip_top}, kTitle, true);
  y = add_lines(words.items, caption, {top_left.x, y + 0.6}, kText, false);
  add_lines(words.items, credit, {top_left.x, y + 0.8}, kSmall, false);
  sheet_.groups = {std::move(frame), std::move(legend), std::move(words)};
  scale_box_ = {{top_left.x + space.strip_width - kScaleWidth, strip_top},
                {kScaleWidth, kScaleHeight}};
  if (!block_) return;
  Group sheet_frame{"sheet-frame", {}};
  Path around = rectangle(glm::dvec2(margin), paper - 2 * margin);
  around.stroke_mm = kSheetFrame;
  sheet_frame.items.push_back(std::move(around));
  sheet_.groups.push_back(std::move(sheet_frame));
}

Sheet SheetLayout::finish(double scale, const std::optional<glm::dvec2>& north,
                          const std::vector<Label>& labels) const {
  Sheet sheet = sheet_;
  Group names{"labels", {}};
  for (const Label& label : labels)
    names.items.push_back(Words{sheet.drawing.corner + label.at + glm::dvec2(0, kLabel_mm * 0.36),
                                label.text, kLabel_mm, false, Anchor::middle, true});
  sheet.groups.insert(sheet.groups.begin(), std::move(names));
  const glm::dvec2 end = scale_box_.corner + scale_box_.size;
  constexpr double kArrowRoom = 18, kBarOverhang = 6;  // overhang of the last number
  const double widest = kScaleWidth - kArrowRoom - 2 * kBarOverhang;
  sheet.groups.push_back(
      bar_group(scale_bar(scale, widest), scale, {end.x - kBarOverhang, end.y - 1}));
  if (north)
    sheet.groups.push_back(arrow_group(
        *north, {scale_box_.corner.x + kArrowRoom / 2, scale_box_.corner.y + kScaleHeight / 2}));
  if (block_) {
    TitleBlock block = *block_;
    block.scale.text = scale_text(scale);
    sheet.groups.push_back(
        title_block_group(block, block_shape_, block_box_.corner, block_box_.size.x));
  }
  return sheet;
}

std::vector<Label> place_labels(const std::vector<LabelRequest>& requests,
                                const glm::dvec2& drawing_mm) {
  std::vector<Label> placed;
  std::vector<Box> taken;
  for (const LabelRequest& request : requests) {
    if (request.text.empty()) continue;
    const glm::dvec2 size(width_mm(request.text, kLabel_mm, false) + 1, kLabel_mm * 1.4);
    for (const glm::dvec2& place : request.places) {
      const Box box{place - size / 2.0, size};
      const glm::dvec2 end = box.corner + box.size;
      if (box.corner.x < 0 || box.corner.y < 0 || end.x > drawing_mm.x || end.y > drawing_mm.y)
        continue;
      const bool is_free = std::ranges::none_of(taken, [&](const Box& other) {
        const glm::dvec2 other_end = other.corner + other.size;
        return box.corner.x < other_end.x && other.corner.x < end.x && box.corner.y < other_end.y &&
               other.corner.y < end.y;
      });
      if (!is_free) continue;
      placed.push_back({place, request.text});
      taken.push_back(box);
      break;
    }
  }
  return placed;
}

}  // namespace strata::figure
