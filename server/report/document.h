#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace strata::report {

// The content of a document for reading and printing, without any layout. The writers (writers.h)
// decide fonts, sizes and page breaks. All texts are UTF-8. A line end is a line break. The writers
// show a tab as a space, replace invalid bytes by U+FFFD, and leave out the characters that XML
// does not allow (core/text/printable.h).

using Color = std::array<std::uint8_t, 3>;  // red, green and blue in sRGB

// A JPEG or PNG, as a file or as bytes. The writers read the pictures one after the other. They
// apply the Exif orientation, and they ignore color profiles.
using PictureSource =
    std::variant<std::filesystem::path, std::shared_ptr<const std::vector<std::uint8_t>>>;

struct Run {
  std::string text;
  bool bold = false, italic = false;
};

struct Heading {
  int level = 1;  // 1…3
  std::string text;
};

struct Paragraph {
  std::vector<Run> runs;
};

struct ListItem {  // with a bullet
  std::vector<Run> runs;
};

enum class Alignment { start, middle, end };

struct Column {
  std::string name;  // in the first row, which each page repeats
  // The share of the width of the text. The unit is arbitrary, but no column is narrower than 6 mm.
  double width = 1;
  Alignment alignment = Alignment::start;
};

struct CellPicture {
  PictureSource source;
  double width_mm = 0;  // reduced to the width of the column
  std::string alternative;
};

struct Cell {
  std::string text;
  std::optional<Color> swatch{};         // a filled rectangle before the text, for legends
  std::optional<CellPicture> picture{};  // above the text
};

inline constexpr std::size_t kMaxColumns = 20;

struct Table {
  std::vector<Column> columns;          // 1…kMaxColumns
  std::vector<std::vector<Cell>> rows;  // a row may have fewer cells than columns, but not more
  std::vector<Cell> total{};            // the last row, in bold; no row if empty
  std::string caption{};                // above the table; may be empty
};

// The width is kept exactly, so that a figure keeps its scale. A picture that is larger than
// kMaxPictureWidth_mm or kMaxPictureHeight_mm (page.h) is reduced, and the caption says so.
struct Picture {
  PictureSource source;
  double width_mm = 0;
  std::string alternative;  // describes the picture for readers who do not see it
  std::string caption;      // below the picture; may be empty
};

// The next block begins on a new page. Several page breaks have the effect of one.
struct PageBreak {};

using Block = std::variant<Heading, Paragraph, ListItem, Table, Picture, PageBreak>;

// The texts that the writers add, in the language of the document.
struct Wording {
  // Follows the caption of a reduced picture. The number replaces "{percent}".
  std::string reduced = "Reduced to {percent} % of its size.";
};

struct Logo {
  PictureSource source;
  double width_mm = 30;  // reduced to 45 mm × 20 mm
  std::string alternative;
};

struct Document {
  std::string title, subject, author;
  std::string language = "en";  // BCP 47, such as "de" or "es-MX"
  std::chrono::sys_seconds created{};
  std::optional<Logo> logo{};  // next to the title
  // The label and value of the rows below the title, such as "Object number" and "1927.14".
  std::vector<std::pair<std::string, std::string>> title_block{};
  std::string header{};  // on each page except the first one
  std::string footer{};  // on each page, next to its number
  std::vector<Block> blocks{};
  Wording wording{};
};

}  // namespace strata::report
