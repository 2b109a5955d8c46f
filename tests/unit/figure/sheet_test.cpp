// Sheets: the layout of their content, and their files.
#include <gtest/gtest.h>
#include <png.h>
#include <tiffio.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <fstream>
#include <numeric>
#include <sstream>

#include "figure/area_pattern.h"
#include "figure/files.h"
#include "figure/layer_areas.h"
#include "figure/layout.h"
#include "figure/scale_bar.h"
#include "figure/sheet_rows.h"
#include "figure/text.h"

namespace strata::figure {
namespace {

namespace fs = std::filesystem;

const Captions kCaptions{"Sherd 14 <rim> & handle", "Front, in raking light.",
                         "Museum of Everything, CC BY"};

std::vector<Legend> legends(int entries) {
  Legend classes{"Damage", {}, {}, {}, {}};
  for (int i = 0; i < entries; ++i)
    classes.entries.push_back({"Class " + std::to_string(i), Rgba{200, std::uint8_t(i), 30, 255},
                               static_cast<Pattern>(i % 4), 30.0 * i});
  classes.entries.push_back({"", Rgba{1, 2, 3, 255}});  // a class without a label
  Legend moisture{"Moisture [%]", {}, std::vector<Rgba>(64, Rgba{0, 0, 255, 255}), "0", "100"};
  return {classes, moisture};
}

Picture drawing_of(const SheetLayout& layout) {
  Picture picture{layout.drawing_width(), layout.drawing_height(), {}};
  picture.rgba.assign(std::size_t{4} * picture.width * picture.height, 255);
  for (std::size_t i = 0; i < picture.rgba.size(); i += 4) {  // red on the left, blue on the right
    const bool left = i / 4 % picture.width < static_cast<std::size_t>(picture.width) / 2;
    picture.rgba[i] = left ? 220 : 20;
    picture.rgba[i + 1] = 30;
    picture.rgba[i + 2] = left ? 20 : 220;
  }
  return picture;
}

// Returns the sheet with one view that fills the area of the drawing.
Sheet finish(const SheetLayout& layout, double scale, const std::optional<glm::dvec2>& north,
             const std::vector<Label>& labels) {
  const auto arranged = layout.arrange({{{1, 1}}}, scale);
  return layout.finish({{arranged.places.front(), "", north, labels}});
}

TitleBlock title_block(const std::string& text) {
  TitleBlock block;
  for (auto* field :
       {&block.organization, &block.project, &block.object, &block.title, &block.author,
        &block.checked_by, &block.date, &block.status, &block.scale, &block.number, &block.sheet})
    *field = {"Name of the field", text};
  return block;
}

// Returns the smallest box around the content of a group.
Box box_of(const Group& group) {
  glm::dvec2 low(1e9), high(-1e9);
  const auto add = [&](const glm::dvec2& point) {
    low = glm::min(low, point), high = glm::max(high, point);
  };
  for (const Item& item : group.items) {
    if (const auto* path = std::get_if<Path>(&item)) std::ranges::for_each(path->points, add);
    if (const auto* words = std::get_if<Words>(&item)) {
      const double width = width_mm(words->text, words->size_mm, words->bold);
      const double left = words->anchor == Anchor::start    ? 0
                          : words->anchor == Anchor::middle ? width / 2
                                                            : width;
      add(words->at - glm::dvec2(left, 0.75 * words->size_mm));
      add(words->at + glm::dvec2(width - left, 0.2 * words->size_mm));
    }
  }
  return {low, high - low};
}

template <class Kind>
std::vector<Kind> all(const Sheet& sheet) {
  std::vector<Kind> found;
  for (const Group& group : sheet.groups)
    for (const Item& item : group.items)
      if (const auto* each = std::get_if<Kind>(&item)) found.push_back(*each);
  return found;
}

TEST(SheetLayout, EverythingIsOnThePaperAndBesideTheDrawing) {
  for (const Paper paper : {Paper::a5, Paper::a4, Paper::a3})
    for (const bool landscape : {false, true})
      for (const int entries : {0, 5, 200}) {
        const glm::dvec2 size = paper_mm(paper, landscape);
        const SheetLayout layout(size, kCaptions,
                                 entries == 0 ? std::vector<Legend>{} : legends(entries), 300);
        const Sheet sheet = finish(layout, 20, glm::dvec2(0, -1), {});
        const glm::dvec2 end = sheet.drawing.corner + sheet.drawing.size;
        EXPECT_GT(sheet.drawing.size.x, size.x / 3);
        EXPECT_GT(sheet.drawing.size.y, size.y / 3);
        EXPECT_NEAR(layout.drawing_width() * 25.4 / 300, sheet.drawing.size.x, 1e-9);
        const auto inside = [&](const glm::dvec2& p) {
          return p.x >= 0 && p.y >= 0 && p.x <= size.x && p.y <= size.y;
        };
        EXPECT_TRUE(inside(sheet.drawing.corner) && inside(end));
        for (const Path& path : all<Path>(sheet))
          for (const glm::dvec2& point : path.points)
            EXPECT_TRUE(inside(point)) << point.x << " " << point.y;
        for (const Words& words : all<Words>(sheet)) {
          const double width = width_mm(words.text, words.size_mm, words.bold);
          const double left = words.at.x - (words.anchor == Anchor::start    ? 0
                                            : words.anchor == Anchor::middle ? width / 2
                                                                             : width);
          EXPECT_TRUE(inside({left, words.at.y}) && inside({left + width, words.at.y}))
              << words.text;
          const bool below = words.at.y - words.size_mm >= end.y, beside = left >= end.x;
          EXPECT_TRUE(below || beside) << words.text << " lies over the drawing";
        }
        const bool cut = std::ranges::any_of(
            all<Words>(sheet), [](const Words& words) { return words.text.starts_with("… + "); });
        EXPECT_EQ(cut, entries == 200) << "what has no room is counted";
      }
}

TEST(SheetLayout, NothingOverlapsTheTitleBlock) {
  for (const Paper paper : {Paper::a5, Paper::a4, Paper::a3})
    for (const bool landscape : {false, true})
      for (const int entries : {0, 5, 200})
        for (const std::string& text : {std::string("Text"), std::string(300, 'm'),
                                        std::string("many words ") + std::string(80, ' ') + "end",
                                        std::string("two\nlines")}) {
          SCOPED_TRACE(std::to_string(static_cast<int>(paper)) + (landscape ? " landscape " : " ") +
                       std::to_string(entries) + " " + text);
          const glm::dvec2 size = paper_mm(paper, landscape);
          Captions captions{"Not above the caption", std::string(1000, 'w'), kCaptions.credit};
          captions.block = title_block(text);
          const SheetLayout layout(size, captions,
                                   entries == 0 ? std::vector<Legend>{} : legends(entries), 300);
          const Sheet sheet = finish(layout, 20, glm::dvec2(0, -1), {});
          EXPECT_GT(sheet.drawing.size.x, size.x / 3);
          EXPECT_GT(sheet.drawing.size.y, size.y / 5);
          std::vector<std::pair<std::string, Box>> boxes{{"drawing", sheet.drawing}};
          Box frame;
          bool has_scale = false;
          for (const Group& group : sheet.groups) {
            if (group.id == "sheet-frame") frame = box_of(group);
            if (group.id == "frame" || group.id == "sheet-frame" || group.items.empty()) continue;
            boxes.emplace_back(group.id, box_of(group));
          }
          for (const Words& words : all<Words>(sheet)) {
            EXPECT_NE(words.text, "Not above the caption");
            has_scale |= words.text == "1 : 20" && words.size_mm < 2.7;
          }
          EXPECT_TRUE(has_scale);
          EXPECT_EQ(boxes.back().first, "title-block");
          const Box block = boxes.back().second;
          EXPECT_LT(glm::distance(block.corner + block.size, frame.corner + frame.size), 1e-9);
          for (std::size_t i = 0; i < boxes.size(); ++i) {
            const auto& [name, box] = boxes[i];
            const glm::dvec2 end = box.corner + box.size;
            EXPECT_TRUE(box.corner.x >= frame.corner.x - 1e-9 &&
                        box.corner.y >= frame.corner.y - 1e-9 &&
                        end.x <= frame.corner.x + frame.size.x + 1e-9 &&
                        end.y <= frame.corner.y + frame.size.y + 1e-9)
                << name << " leaves the frame";
            for (std::size_t j = 0; j < i; ++j) {
              const Box& other = boxes[j].second;
              const glm::dvec2 other_end = other.corner + other.size;
              EXPECT_TRUE(end.x <= other.corner.x || other_end.x <= box.corner.x ||
                          end.y <= other.corner.y || other_end.y <= box.corner.y)
                  << name << " overlaps " << boxes[j].first;
            }
          }
        }
}

TEST(SheetLayout, TextsOfTheTitleBlockStayInTheirFields) {
  for (const BlockShape shape : {BlockShape::wide, BlockShape::compact})
    for (const std::string& text : {std::string(300, 'm'), std::string(40, 'i'),
                                    std::string("A title of several words that needs two lines, "
                                                "or even three lines, or more than three lines")}) {
      const Group group = title_block_group(title_block(text), shape, {20, 30}, 128);
      Box cell;
      int texts = 0;
      for (const Item& item : group.items) {
        if (const auto* path = std::get_if<Path>(&item))
          cell = {path->points[0], path->points[2] - path->points[0]};
        const auto* words = std::get_if<Words>(&item);
        if (!words) continue;
        ++texts;
        const double right = words->at.x + width_mm(words->text, words->size_mm, words->bold);
        EXPECT_GT(words->at.x, cell.corner.x);
        EXPECT_LT(right, cell.corner.x + cell.size.x) << words->text;
        EXPECT_GT(words->at.y - words->size_mm, cell.corner.y - 0.3);
        EXPECT_LT(words->at.y, cell.corner.y + cell.size.y);
      }
      EXPECT_GE(texts, 22);
      const Box whole = box_of(group);
      EXPECT_NEAR(whole.size.y, block_height_mm(shape), 1e-9);
      EXPECT_NEAR(whole.size.x, 128, 1e-9);
    }
  EXPECT_EQ(fitted("short", 3, false, 100, 1), std::vector<std::string>{"short"});
  const auto cut = fitted("some words that are too long", 3, false, 20, 1);
  ASSERT_EQ(cut.size(), 1u);
  EXPECT_TRUE(cut[0].ends_with(" …"));
  EXPECT_LE(width_mm(cut[0], 3, false), 20);
  EXPECT_EQ(cut[0].find("…"), cut[0].rfind("…"));
}

TEST(SheetLayout, AListOfTheLegendStaysTogetherOrHasItsTitleInEachColumn) {
  for (const Paper paper : {Paper::a5, Paper::a4, Paper::a3})
    for (const bool landscape : {false, true})
      for (const int entries : {1, 3, 9, 14, 30}) {
        SCOPED_TRACE(std::to_string(entries) + (landscape ? " landscape" : " portrait"));
        std::vector<Legend> lists;
        for (int list = 0; list < 3; ++list) {
          lists.push_back({"List " + std::to_string(list), {}, {}, {}, {}});
          for (int i = 0; i < (list == 1 ? entries : 4); ++i)
            lists.back().entries.push_back(
                {std::to_string(list) + "-" + std::to_string(i), Rgba{200, 90, 30, 255}});
        }
        Captions captions = kCaptions;
        captions.continued = "(goes on)";
        const Sheet sheet = finish(SheetLayout(paper_mm(paper, landscape), captions, lists, 300),
                                   20, std::nullopt, {});
        const auto group = std::ranges::find(sheet.groups, "legend", &Group::id);
        ASSERT_NE(group, sheet.groups.end());
        std::string title;  // title above the next entry
        int counted = 0, titles = 0;
        std::set<std::string> shown;  // titles
        double column = 0, y = 0;
        for (const Item& item : group->items) {
          const auto* words = std::get_if<Words>(&item);
          if (!words) continue;
          if (words->text.starts_with("… + ")) {  // the number of entries that did not fit
            counted += std::stoi(words->text.substr(std::string_view("… + ").size()));
            continue;
          }
          if (words->bold) {
            EXPECT_EQ(words->text.ends_with(" (goes on)"), words->text.substr(0, 6) == title)
                << words->text;
            title = words->text.substr(0, 6);
            shown.insert(title);
            column = words->at.x;
            ++titles;
          } else {
            EXPECT_EQ(words->text[0], title[5]) << words->text << " below " << title;
            EXPECT_NEAR(words->at.x - column, 8, 1e-9)
                << words->text << " stands in a column without its title";
            EXPECT_GT(words->at.y, y);
            ++counted;
          }
          y = words->at.y;
        }
        EXPECT_EQ(counted + static_cast<int>(shown.size()), 3 + 8 + entries)
            << "titles are rows, too";
        EXPECT_TRUE(titles == 3 || entries > 9);
      }
}

TEST(SheetLayout, ASwatchIsTintedAndHasABorderAsTheDrawing) {
  Legend legend{"Damage", {}, {}, {}, {}};
  for (const Pattern pattern : {Pattern::hatch, Pattern::dots})
    for (const bool bare : {false, true}) {
      legend.entries = {{"Loss", Rgba{200, 0, 100, 255}, pattern, 45, bare}};
      const Sheet sheet = finish(SheetLayout(paper_mm(Paper::a4, false), kCaptions, {legend}, 300),
                                 20, std::nullopt, {});
      const auto group = std::ranges::find(sheet.groups, "legend", &Group::id);
      int tints = 0, inks = 0;
      glm::dvec2 low(1e9), high(-1e9);
      for (const Item& item : group->items)
        if (const auto* path = std::get_if<Path>(&item); path && path->fill) {
          for (const glm::dvec2& point : path->points)
            low = glm::min(low, point), high = glm::max(high, point);
          tints += *path->fill == Rgba{239, 179, 209, 255};  // 30 % of the color on white
          inks += *path->fill == Rgba{200, 0, 100, 255};
        }
      EXPECT_EQ(tints, bare ? 0 : 1);
      EXPECT_GT(inks, bare ? 2 : 6);  // lines or dots, and four sides
      EXPECT_TRUE(high.x - low.x <= 6 + 1e-9 && high.y - low.y <= 3 + 1e-9)
          << "nothing of it leaves the swatch";
    }
}

TEST(SheetLayout, LongWordsAreBrokenAndEnd) {
  const std::string endless(5000, 'x');
  const SheetLayout layout(paper_mm(Paper::a4, false), {endless, endless, endless}, {}, 150);
  for (const Words& words : all<Words>(finish(layout, 1, std::nullopt, {})))
    EXPECT_LE(width_mm(words.text, words.size_mm, words.bold), 190);
  EXPECT_EQ(wrapped("one two", 3, false, 1000, 1), std::vector<std::string>{"one two"});
  EXPECT_EQ(wrapped("one\ntwo", 3, false, 1000, 5), (std::vector<std::string>{"one", "two"}));
  EXPECT_EQ(wrapped("one\ntwo\nthree", 3, false, 1000, 2).back(), "two …");
  EXPECT_TRUE(wrapped("", 3, false, 10, 5).empty());
}

TEST(ScaleBar, IsRoundAndHasRoom) {
  for (const double scale : {0.1, 0.5, 1.0, 2.0, 2.5, 5.0, 20.0, 50.0, 300.0, 1e4, 1e6}) {
    const ScaleBar bar = scale_bar(scale, 50);
    EXPECT_LE(bar.length_mm, 50 + 1e-9) << scale;
    EXPECT_GE(bar.length_mm, 20 - 1e-9) << scale;
    const double metres = bar.step * bar.steps *
                          (bar.unit == "km"   ? 1000
                           : bar.unit == "m"  ? 1
                           : bar.unit == "cm" ? 0.01
                                              : 0.001);
    EXPECT_NEAR(metres * 1000 / scale, bar.length_mm, 1e-6) << scale;
  }
  const ScaleBar one = scale_bar(20, 50);  // one meter is 50 mm
  EXPECT_EQ(one.length_mm, 50);
  EXPECT_EQ(one.unit, "cm");
  EXPECT_EQ(one.step * one.steps, 100);
  EXPECT_EQ(scale_text(20), "1 : 20");
  EXPECT_EQ(scale_text(2.5), "1 : 2.5");
  EXPECT_EQ(scale_text(1e6), "1 : 1\u202f000\u202f000");
  EXPECT_EQ(scale_text(0.5), "2 : 1");
}

TEST(Labels, LieOverNoOtherAndWithinTheDrawing) {
  std::vector<LabelRequest> requests;
  for (int i = 0; i < 300; ++i)
    requests.push_back(
        {"Unit " + std::to_string(i), {{5.0 + i % 17 * 6, 3.0 + i % 23 * 4}, {60, 50}}});
  requests.push_back({"", {{10, 90}}});
  requests.push_back({"outside", {{-3, 10}, {119, 99}}});
  const auto labels = place_labels(requests, {120, 100});
  EXPECT_GT(labels.size(), 20u);
  EXPECT_LT(labels.size(), 300u);
  EXPECT_EQ(labels[0].text, "Unit 0");
  for (std::size_t i = 0; i < labels.size(); ++i) {
    const double half = width_mm(labels[i].text, kLabel_mm, false) / 2;
    EXPECT_TRUE(labels[i].at.x >= half && labels[i].at.x + half <= 120);
    EXPECT_NE(labels[i].text, "outside");
    for (std::size_t j = 0; j < i; ++j) {
      const double other = width_mm(labels[j].text, kLabel_mm, false) / 2;
      EXPECT_TRUE(std::abs(labels[i].at.y - labels[j].at.y) >= kLabel_mm ||
                  std::abs(labels[i].at.x - labels[j].at.x) >= half + other);
    }
  }
}

TEST(LegendOf, TellsClassesAndRamps) {
  Layer layer;
  layer.name = "Damage";
  Palette classes{PaletteMode::categorical,
                  0,
                  1,
                  {{1, {255, 0, 0, 255}, "Loss"}, {2.5, {0, 255, 0, 255}}},
                  "",
                  {}};
  const Legend legend = legend_of(layer, classes);
  EXPECT_EQ(legend.title, "Damage");
  ASSERT_EQ(legend.entries.size(), 2u);
  EXPECT_EQ(legend.entries[0].label, "Loss");
  EXPECT_EQ(legend.entries[1].label, "2.5");
  const std::set<double> there{2.5, 7};
  ASSERT_EQ(legend_of(layer, classes, &there).entries.size(), 1u)
      << "of classes that are not there nothing is told";
  layer.labels = {{"de", "Schäden"}, {"pt-BR", "Danos"}};
  EXPECT_EQ(legend_of(layer, classes, nullptr, "de-at").title, "Schäden");
  EXPECT_EQ(legend_of(layer, classes, nullptr, "pt-br").title, "Danos");
  EXPECT_EQ(legend_of(layer, classes, nullptr, "fr").title, "Damage") << "it has no name in it";
  layer.unit = "%";
  EXPECT_EQ(legend_of(layer, classes, nullptr, "de").title, "Schäden [%]");
  const Legend ramp = legend_of(
      layer,
      {PaletteMode::linear, 0, 40, {{0, {0, 0, 0, 255}}, {40, {255, 255, 255, 255}}}, "", {}});
  EXPECT_EQ(ramp.title, "Damage [%]");
  EXPECT_EQ(ramp.low + "…" + ramp.high, "0…40");
  EXPECT_LT(ramp.ramp.front()[0], 5);
  EXPECT_GT(ramp.ramp.back()[0], 250);
}

class Files : public ::testing::Test {
 protected:
  Files() { fs::create_directories(folder_); }
  ~Files() override { fs::remove_all(folder_); }

  fs::path write(Format format, int dpi) {
    const SheetLayout layout(paper_mm(Paper::a5, true), kCaptions, legends(3), dpi);
    const fs::path file = folder_ / ("sheet" + std::string(extension(format)));
    const auto written = write_figure(
        finish(layout, 2, glm::dvec2(0.6, -0.8), {{{50, 40}, "Ünit 7 — Ψ"}}), drawing_of(layout),
        dpi, format, {kCaptions.title, kCaptions.credit}, file, progress_);
    EXPECT_TRUE(written) << (written ? "" : written.error().detail);
    return file;
  }
  static std::string text_of(const fs::path& file) {
    std::ostringstream text;
    text << std::ifstream(file, std::ios::binary).rdbuf();
    return text.str();
  }

  const fs::path folder_ =
      fs::temp_directory_path() / ("strata-figure-test-" + std::to_string(::getpid()));
  Progress progress_;
};

TEST_F(Files, PngHasItsResolutionAndTheDrawingPixelByPixel) {
  const std::string bytes = text_of(write(Format::png, 200));
  const auto picture =
      decode_picture({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
  ASSERT_TRUE(picture);
  EXPECT_EQ(picture->width, 1654);  // 210 mm
  EXPECT_EQ(picture->height, 1165);
  // The chunk states 7874 pixels per meter.
  EXPECT_NE(bytes.find(std::string("pHYs\0\0\x1e\xc2\0\0\x1e\xc2\x01", 13)), std::string::npos);
  const auto at = [&](double x_mm, double y_mm) {
    return &picture->rgba[4 * (std::size_t(y_mm / 25.4 * 200) * picture->width +
                               std::size_t(x_mm / 25.4 * 200))];
  };
  EXPECT_EQ(at(20, 60)[0], 220);
  EXPECT_EQ(at(20, 60)[2], 20);
  EXPECT_EQ(at(120, 60)[2], 220);
  EXPECT_EQ(at(5, 5)[0], 255);  // the margin
}

TEST_F(Files, TiffHasItsResolutionAndTheSamePixels) {
  const std::string png = text_of(write(Format::png, 150));
  const auto same = decode_picture({reinterpret_cast<const std::uint8_t*>(png.data()), png.size()});
  ASSERT_TRUE(same);
  TIFF* tiff = TIFFOpen(write(Format::tiff, 150).c_str(), "r");
  ASSERT_NE(tiff, nullptr);
  std::uint32_t width = 0, height = 0;
  float resolution = 0;
  std::uint16_t unit = 0;
  TIFFGetField(tiff, TIFFTAG_IMAGEWIDTH, &width);
  TIFFGetField(tiff, TIFFTAG_IMAGELENGTH, &height);
  TIFFGetField(tiff, TIFFTAG_XRESOLUTION, &resolution);
  TIFFGetField(tiff, TIFFTAG_RESOLUTIONUNIT, &unit);
  EXPECT_EQ(resolution, 150);
  EXPECT_EQ(unit, RESUNIT_INCH);
  ASSERT_EQ(width, static_cast<std::uint32_t>(same->width));
  ASSERT_EQ(height, static_cast<std::uint32_t>(same->height));
  std::vector<std::uint32_t> pixels(std::size_t{width} * height);
  ASSERT_EQ(TIFFReadRGBAImageOriented(tiff, width, height, pixels.data(), ORIENTATION_TOPLEFT), 1);
  TIFFClose(tiff);
  EXPECT_EQ(std::memcmp(pixels.data(), same->rgba.data(), 4 * pixels.size()), 0);
}

TEST_F(Files, SvgHasWordsAndNamedGroups) {
  const std::string text = text_of(write(Format::svg, 100));
  for (const char* part : {"width=\"210mm\"", "id=\"legend\"", "id=\"scale-bar\"", "id=\"north\"",
                           "id=\"labels\"", ">Ünit 7 — Ψ</text>", ">1 : 2</text>",
                           "Sherd 14 &lt;rim&gt; &amp; handle", "data:image/jpeg;base64,/9j/"})
    EXPECT_NE(text.find(part), std::string::npos) << part;
  EXPECT_EQ(text.find("<rim>"), std::string::npos);
}

TEST_F(Files, CharactersThatFilesDoNotHaveAreLeftOut) {
  const std::string odd = "W\x01st \uFFFEwall\uFFFF";
  const SheetLayout layout(paper_mm(Paper::a5, true), {odd, odd, odd}, {}, 100);
  for (const Format format : {Format::png, Format::tiff, Format::svg, Format::pdf}) {
    const auto written = write_figure(finish(layout, 2, {}, {}), drawing_of(layout), 100, format,
                                      {odd, odd}, folder_ / extension(format), progress_);
    EXPECT_TRUE(written) << extension(format) << ": " << written.error().detail;
  }
  const std::string svg = text_of(folder_ / ".svg");
  EXPECT_NE(svg.find("<title>Wst wall</title>"), std::string::npos);
  EXPECT_NE(svg.find(">Wst wall</text>"), std::string::npos);
  EXPECT_EQ(svg.find('\x01'), std::string::npos);
}

TEST_F(Files, PdfIsOnePageOfThePapersSizeWithTheJpegInIt) {
  const std::string text = text_of(write(Format::pdf, 100));
  EXPECT_TRUE(text.starts_with("%PDF-"));
  EXPECT_NE(text.find("/DCTDecode"), std::string::npos);
  EXPECT_NE(text.find("/MediaBox [ 0 0 595.275"), std::string::npos);  // 210 mm in points
}

TEST_F(Files, CancelledWritesEnd) {
  progress_.cancel();
  const SheetLayout layout(paper_mm(Paper::a5, true), kCaptions, {}, 100);
  for (const Format format : {Format::png, Format::tiff, Format::svg, Format::pdf}) {
    const auto written = write_figure(finish(layout, 2, {}, {}), drawing_of(layout), 100, format,
                                      {}, folder_ / "none", progress_);
    ASSERT_FALSE(written);
    EXPECT_EQ(written.error().code, ErrorCode::cancelled);
  }
}

TEST_F(Files, ADiskThatTakesNothingIsSaid) {
  const SheetLayout layout(paper_mm(Paper::a5, true), kCaptions, {}, 100);
  for (const Format format : {Format::png, Format::tiff, Format::svg, Format::pdf})
    for (const fs::path& file : {fs::path("/dev/full"), folder_ / "no" / "folder"}) {
      if (format == Format::tiff && file == "/dev/full") continue;  // libtiff needs to seek
      const auto written = write_figure(finish(layout, 2, {}, {}), drawing_of(layout), 100, format,
                                        {}, file, progress_);
      ASSERT_FALSE(written) << file << " " << static_cast<int>(format);
      EXPECT_EQ(written.error().code, ErrorCode::storage_full);
    }
}

TEST_F(Files, AFullDiskIsAnError) {
  const SheetLayout layout(paper_mm(Paper::a5, true), kCaptions, {}, 100);
  const fs::path file = folder_ / "full.pdf";
  fs::create_symlink("/dev/full", file);  // accepts no bytes
  const auto written = write_figure(finish(layout, 2, std::nullopt, {}), drawing_of(layout), 100,
                                    Format::pdf, {}, file, progress_);
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().code, ErrorCode::storage_full) << written.error().detail;
}

// Four squares of 20 mm with a hole of 10 mm, one for each pattern.
Sheet squares() {
  Sheet sheet;
  sheet.size = {100, 40};
  sheet.drawing = {{0, 0}, {100, 40}};
  Group group;
  group.id = "areas-damage";
  group.name = "Damage <1>";
  const auto square = [](double left, double top, double side) {
    return std::vector<glm::dvec2>{
        {left, top}, {left + side, top}, {left + side, top + side}, {left, top + side}};
  };
  for (int i = 0; i < 4; ++i) {
    Group& part = group.parts.emplace_back();
    part.id = "areas-damage-" + std::to_string(i);
    part.name = "Class " + std::to_string(i);
    part.areas.push_back({{square(2 + 25 * i, 10, 20), square(7 + 25 * i, 15, 10)},
                          {200, 0, 0, 255},
                          static_cast<Pattern>(i),
                          45,
                          1.778});
  }
  sheet.groups.push_back(std::move(group));
  return sheet;
}

TEST(Areas, AreDrawnWithTheirHolesAndPatterns) {
  const Sheet sheet = squares();
  const Picture white{1, 1, {255, 255, 255, 255}};
  Progress progress;
  std::array<double, 4> ink{};  // share of the ink in the area of each square
  int row = 0;
  constexpr int kDpi = 254;  // ten pixels per millimeter
  ASSERT_TRUE(sheet_rows(sheet, white, kDpi, progress, [&](std::span<const std::uint8_t> rgb) {
    for (std::size_t x = 0; x < rgb.size() / 3; ++x) {
      const double missing = (255 - rgb[3 * x + 1]) / 255.0;
      const auto square = std::min<std::size_t>(3, x / 250);
      ink[square] += missing / (20 * 20 - 10 * 10) / 100;
      const double in_x = static_cast<double>(x) / 10 - 2 - 25 * static_cast<double>(square),
                   in_y = row / 10.0 - 10;
      const bool in_hole = in_x > 5.2 && in_y > 5.2 && in_x < 14.8 && in_y < 14.8;
      const bool outside = in_x < -0.2 || in_y < -0.2 || in_x > 20.2 || in_y > 20.2;
      if (in_hole || outside) {
        EXPECT_EQ(missing, 0) << square << " " << in_x << " " << in_y;
      }
    }
    ++row;
    return true;
  }));
  EXPECT_NEAR(ink[0], 1, 0.02);
  constexpr double kTwice = 2 * 0.508;  // the width of the border inside the area, on two sides
  const double border =
      (20 * 20 - std::pow(20 - kTwice, 2) + std::pow(10 + kTwice, 2) - 10 * 10) / 300;
  EXPECT_NEAR(ink[3], border, 0.03);
  EXPECT_NEAR(ink[1], border + (1 - border) * (0.4 + 0.6 * 0.3), 0.03);
  const double dots = 3.14159 * 0.32 * 0.32;
  EXPECT_NEAR(ink[2], border + (1 - border) * (dots + (1 - dots) * 0.3), 0.03);
}

// A class with many small pieces that are far from each other must not fill the box around them.
TEST(Areas, APatternCoversOnlyItsPieces) {
  for (const Pattern pattern : {Pattern::hatch, Pattern::dots})
    for (const double angle : {0.0, 30.0, 90.0}) {
      Area area{{}, {200, 0, 0, 255}, pattern, angle, 2};
      for (int i = 0; i < 20; ++i) {
        const double x = 100.0 * i, y = i % 2 == 0 ? 0 : 2000;
        area.rings.push_back({{x, y}, {x + 10, y}, {x + 10, y + 10}, {x, y + 10}});
      }
      const AreaPattern found = pattern_of(area);
      const double margin = 2;
      const auto is_near = [&](const glm::dvec2& point) {
        return std::ranges::any_of(area.rings, [&](const auto& ring) {
          return point.x > ring[0].x - margin && point.y > ring[0].y - margin &&
                 point.x < ring[2].x + margin && point.y < ring[2].y + margin;
        });
      };
      for (const auto& [from, to] : found.lines) EXPECT_TRUE(is_near((from + to) / 2.0));
      for (const glm::dvec2& dot : found.dots) EXPECT_TRUE(is_near(dot)) << dot.x << " " << dot.y;
      const std::size_t count = found.lines.size() + found.dots.size();
      EXPECT_GE(count, 20u * (pattern == Pattern::hatch ? 5 : 25));
      EXPECT_LE(count, 20u * (pattern == Pattern::hatch ? 9 : 45));
    }
}

// An area that continues beyond the drawing has no border at its edge.
TEST(Areas, EndAtTheEdgeOfTheDrawing) {
  Sheet sheet;
  sheet.size = {40, 40};
  sheet.drawing = {{10, 10}, {20, 20}};
  Group group;
  group.id = "areas-damage";
  group.clip = sheet.drawing;
  group.areas.push_back(
      {{{{5, 5}, {35, 5}, {35, 35}, {5, 35}}}, {200, 0, 0, 255}, Pattern::outline, 45, 2});
  sheet.groups.push_back(std::move(group));
  const Picture white{1, 1, {255, 255, 255, 255}};
  Progress progress;
  ASSERT_TRUE(sheet_rows(sheet, white, 127, progress, [&](std::span<const std::uint8_t> rgb) {
    EXPECT_TRUE(std::ranges::all_of(rgb, [](std::uint8_t each) { return each == 255; }));
    return true;
  }));
}

TEST(Areas, HaveDifferentIdsForLargeNumbers) {
  LayerVectors layer;
  layer.id = "units";
  for (const double key : {1234567.0, 1234568.0, 0.5})
    layer.areas.push_back({"", key, {}, Pattern::solid, 45, 1, {}});
  const Group group = area_group(layer, {});
  ASSERT_EQ(group.parts.size(), 3u);
  EXPECT_EQ(group.parts[0].id, "areas-units-1234567");
  EXPECT_EQ(group.parts[1].id, "areas-units-1234568");
  EXPECT_EQ(group.parts[2].id, "areas-units-0.5");
}

TEST(Areas, AreNamedGroupsInSvg) {
  const fs::path path = fs::temp_directory_path() / "strata_areas_test.svg";
  Progress progress;
  ASSERT_TRUE(write_figure(squares(), Picture{1, 1, {255, 255, 255, 255}}, 300, Format::svg, {},
                           path, progress));
  std::ifstream file(path);
  std::stringstream text;
  text << file.rdbuf();
  fs::remove(path);
  const std::string svg = text.str();
  for (const char* expected :
       {"<g id=\"areas-damage\" inkscape:groupmode=\"layer\" inkscape:label=\"Damage &lt;1&gt;\">",
        "<title>Class 3</title>", "fill-rule=\"evenodd\" fill=\"#c80000\"",
        "M2 10L22 10 22 30 2 30ZM7 15L17 15 17 25 7 25Z", "clip-path=\"url(#area-1-clip)\""})
    EXPECT_NE(svg.find(expected), std::string::npos) << expected;
}

}  // namespace
}  // namespace strata::figure
