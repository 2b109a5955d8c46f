#include "figure/layout.h"

#include <algorithm>
#include <cmath>

#include "figure/drawing.h"
#include "figure/paper.h"
#include "figure/pattern.h"
#include "figure/scale_bar.h"
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
// Heights of the title and the scale below a view, with and without a scale bar.
constexpr double kCaptionGap = 1, kCaption = 12.5, kCaptionWithBar = 16.5;
constexpr double kSheetFrame = 0.5, kFramePadding = 3;  // of the frame around the sheet
constexpr double kLegendColumn = 56, kSwatchWidth = 6, kSwatchHeight = 3, kEntry = 4.2,
                 kTitleGap = 1.2;

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
  Path path = outline_of({corner, size});
  path.fill = ink;
  items.push_back(std::move(path));
}

// Draws opaque colors, as in the page's legend and in the drawing.
void add_swatch(std::vector<Item>& items, const Box& box, const LegendEntry& entry) {
  const Rgba ink{entry.color[0], entry.color[1], entry.color[2], 255};
  Path frame = outline_of(box, kThin);
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
            outline_of({{at.x + static_cast<double>(i) * step, at.y + 0.5}, {wide, kSwatchHeight}});
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

// Returns the title and the scale below a view, and its own scale bar and arrow.
std::vector<Group> caption_groups(const PlacedView& view, std::size_t number, bool has_bar) {
  constexpr double kArrow = 6, kArrowRoom = 12, kLineHeight = kText * kLine;
  const Box& box = view.place.box;
  const std::string suffix = "-" + std::to_string(number);
  std::vector<Group> groups;
  Group& words = groups.emplace_back(Group{"view" + suffix, {}});
  const double width = box.size.x - (view.north ? kArrowRoom : 0);
  glm::dvec2 at = box.corner + glm::dvec2(0, box.size.y + kCaptionGap);
  for (const std::string& line : fitted(view.title, kText, true, width, 1))
    words.items.push_back(Words{{at.x, at.y + kText}, line, kText, true});
  at.y += kLineHeight;
  if (!has_bar)
    words.items.push_back(Words{{at.x, at.y + kText}, scale_text(view.place.scale), kText});
  if (has_bar) {
    const double room = std::max(1.0, std::min(width, kScaleWidth) - 2 * kBarOverhang_mm);
    groups.push_back(bar_group("scale-bar" + suffix, scale_bar(view.place.scale, room),
                               view.place.scale, {at.x + 1, at.y + kBarHeight_mm}));
  }
  if (view.north)
    groups.push_back(arrow_group(
        "north" + suffix, *view.north,
        box.corner + box.size + glm::dvec2(-kArrowRoom / 2, kCaption / 2 + 0.2), kArrow));
  return groups;
}

// Returns the different scales of the views.
std::string scales_text(const std::vector<PlacedView>& views) {
  std::vector<std::string> scales;
  for (const PlacedView& view : views) {
    std::string scale = scale_text(view.place.scale);
    if (std::ranges::find(scales, scale) == scales.end()) scales.push_back(std::move(scale));
  }
  std::string text;
  for (const std::string& scale : scales) text += (text.empty() ? "" : ", ") + scale;
  return text;
}

}  // namespace

glm::dvec2 paper_mm(Paper paper, bool landscape) {
  const glm::dvec2 portrait = paper == Paper::a3   ? glm::dvec2(297, 420)
                              : paper == Paper::a4 ? glm::dvec2(210, 297)
                                                   : glm::dvec2(148, 210);
  return landscape ? glm::dvec2(portrait.y, portrait.x) : portrait;
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

  Group words{"caption", {}};
  double y = add_lines(words.items, title, {top_left.x, strip_top}, kTitle, true);
  y = add_lines(words.items, caption, {top_left.x, y + 0.6}, kText, false);
  add_lines(words.items, credit, {top_left.x, y + 0.8}, kSmall, false);
  sheet_.groups = {std::move(legend), std::move(words)};
  scale_box_ = {{top_left.x + space.strip_width - kScaleWidth, strip_top},
                {kScaleWidth, kScaleHeight}};
  if (!block_) return;
  Group sheet_frame{"sheet-frame", {}};
  sheet_frame.items.push_back(outline_of({glm::dvec2(margin), paper - 2 * margin}, kSheetFrame));
  sheet_.groups.push_back(std::move(sheet_frame));
}

SheetLayout::Arrangement SheetLayout::arrange(const std::vector<ViewSize>& views,
                                              std::optional<double> scale) const {
  if (views.size() == 1) {
    const ViewSize& view = views.front();
    constexpr double kMargin = 1.02, kSmallest_mm = 1;
    const glm::dvec2 room = glm::max(drawing_mm() - 2.0 * view.border_mm, kSmallest_mm),
                     needed = view.life_mm / room;
    const double chosen = view.scale ? *view.scale
                          : scale    ? *scale
                                     : fitting_scale(view.life_mm * (kMargin / 1000), room, 1);
    return {
        {{sheet_.drawing, 0, 0, width_, height_, chosen}}, chosen, std::max(needed.x, needed.y)};
  }
  const bool has_bars =
      std::ranges::any_of(views, [](const ViewSize& view) { return view.scale.has_value(); });
  const ViewGrid grid =
      arrange_views(views, sheet_.drawing, {kGap, has_bars ? kCaptionWithBar : kCaption}, scale);
  Arrangement arrangement{{}, grid.scale, grid.tightness};
  const double pixel_mm = sheet_.drawing.size.x / width_;
  for (std::size_t i = 0; i < views.size(); ++i) {
    const auto pixel = [&](double mm) { return static_cast<int>(std::floor(mm / pixel_mm)); };
    const glm::dvec2 corner = grid.boxes[i].corner - sheet_.drawing.corner;
    ViewPlace place;
    place.x = std::clamp(pixel(corner.x), 0, width_ - 1);
    place.y = std::clamp(pixel(corner.y), 0, height_ - 1);
    place.width = std::clamp(pixel(grid.boxes[i].size.x), 1, width_ - place.x);
    place.height = std::clamp(pixel(grid.boxes[i].size.y), 1, height_ - place.y);
    place.box = {sheet_.drawing.corner + glm::dvec2(place.x, place.y) * pixel_mm,
                 glm::dvec2(place.width, place.height) * pixel_mm};
    place.scale = views[i].scale.value_or(grid.scale);
    arrangement.places.push_back(place);
  }
  return arrangement;
}

Sheet SheetLayout::finish(const std::vector<PlacedView>& views) const {
  Sheet sheet = sheet_;
  Group names{"labels", {}}, frame{"frame", {}};
  for (const PlacedView& view : views) {
    for (const Label& label : view.labels)
      names.items.push_back(
          Words{view.place.box.corner + label.at + glm::dvec2(0, kLabel_mm * 0.36), label.text,
                kLabel_mm, false, Anchor::middle, true});
    frame.items.push_back(outline_of(view.place.box, kFrame));
  }
  sheet.groups.insert(sheet.groups.begin(), {std::move(names), std::move(frame)});
  const bool is_common = std::ranges::all_of(
      views, [&](const PlacedView& view) { return view.place.scale == views.front().place.scale; });
  const glm::dvec2 end = scale_box_.corner + scale_box_.size;
  constexpr double kArrowRoom = 18, kArrow = 11;
  if (is_common) {
    const double scale = views.front().place.scale;
    const ScaleBar bar = scale_bar(scale, kScaleWidth - kArrowRoom - 2 * kBarOverhang_mm);
    sheet.groups.push_back(
        bar_group("scale-bar", bar, scale, {end.x - kBarOverhang_mm - bar.length_mm, end.y - 1}));
  }
  if (views.size() == 1 && views.front().north)
    sheet.groups.push_back(arrow_group(
        "north", *views.front().north,
        {scale_box_.corner.x + kArrowRoom / 2, scale_box_.corner.y + kScaleHeight / 2}, kArrow));
  if (views.size() > 1)
    for (std::size_t i = 0; i < views.size(); ++i)
      for (Group& group : caption_groups(views[i], i + 1, !is_common))
        sheet.groups.push_back(std::move(group));
  if (block_) {
    TitleBlock block = *block_;
    block.scale.text = scales_text(views);
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
