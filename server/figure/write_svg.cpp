// Writes sheets as SVG, in millimeters. Groups have names, and text stays text, so users can edit
// the file. (cairo's SVG draws letters as shapes.)

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <fstream>

#include "core/text/base64.h"
#include "core/text/markup.h"
#include "core/text/number_text.h"
#include "figure/area_pattern.h"
#include "figure/pattern.h"
#include "figure/text.h"
#include "figure/writers.h"

namespace strata::figure {
namespace {

using Rings = std::vector<std::vector<glm::dvec2>>;

void write(std::ostream& out, const Path& path) {
  out << "<path d=\"";
  for (std::size_t i = 0; i < path.points.size(); ++i)
    out << (i == 0 ? "M" : "L") << short_number(path.points[i].x) << ' '
        << short_number(path.points[i].y);
  out << (path.closed ? "Z" : "") << "\" fill=\"" << (path.fill ? rgb_text(*path.fill) : "none")
      << '"';
  if (path.fill && (*path.fill)[3] < 255)
    out << " fill-opacity=\"" << short_number((*path.fill)[3] / 255.0) << '"';
  if (path.stroke_mm > 0)
    out << " stroke=\"#000\" stroke-width=\"" << short_number(path.stroke_mm) << '"';
  out << "/>\n";
}

void write(std::ostream& out, const Words& words) {
  out << "<text x=\"" << short_number(words.at.x) << "\" y=\"" << short_number(words.at.y)
      << "\" font-size=\"" << short_number(words.size_mm) << '"';
  if (words.angle != 0)
    out << " transform=\"rotate(" << short_number(-words.angle) << ' ' << short_number(words.at.x)
        << ' ' << short_number(words.at.y) << ")\"";
  if (words.bold) out << " font-weight=\"bold\"";
  if (words.anchor != Anchor::start)
    out << " text-anchor=\"" << (words.anchor == Anchor::middle ? "middle" : "end") << '"';
  if (words.halo)
    out << " paint-order=\"stroke\" stroke=\"#fff\" stroke-linejoin=\"round\" stroke-width=\""
        << short_number(words.size_mm * 0.3) << '"';
  out << '>' << escaped_markup(words.text) << "</text>\n";
}

// Thousandths of a millimeter keep the files of large drawings small.
std::string coordinates(const glm::dvec2& point) {
  std::array<char, 64> text{};
  const auto write = [&](char* at, double value) {
    const double rounded = std::round(value * 1000) / 1000;
    return std::to_chars(at, text.data() + text.size(), rounded + 0.0).ptr;
  };
  char* end = write(text.data(), point.x);
  *end++ = ' ';
  return {text.data(), write(end, point.y)};
}

void write_rings(std::ostream& out, const Rings& rings) {
  for (const auto& ring : rings) {
    for (std::size_t i = 0; i < ring.size(); ++i)
      out << (i == 0 ? "M" : i == 1 ? "L" : " ") << coordinates(ring[i]);
    out << 'Z';
  }
}

class GroupWriter {
 public:
  explicit GroupWriter(std::ostream& out) : out_(out) {}

  void write_group(const Group& group) {
    if (group.items.empty() && group.areas.empty() && group.marks.empty() && group.parts.empty())
      return;
    const std::size_t clip = group.clip ? clip_of(*group.clip) : 0;
    out_ << "<g id=\"" << escaped_markup(group.id) << '"';
    if (!group.name.empty())
      out_ << " inkscape:groupmode=\"layer\" inkscape:label=\"" << escaped_markup(group.name)
           << '"';
    if (clip != 0) out_ << " clip-path=\"url(#drawing-clip-" << clip << ")\"";
    if (group.opacity < 1) out_ << " opacity=\"" << short_number(group.opacity) << '"';
    out_ << ">\n";
    if (!group.name.empty()) out_ << "<title>" << escaped_markup(group.name) << "</title>\n";
    for (const Item& item : group.items)
      std::visit([&](const auto& each) { write(out_, each); }, item);
    for (const Area& area : group.areas) add(area);
    for (const Mark& mark : group.marks) add(mark);
    for (const Group& part : group.parts) write_group(part);
    out_ << "</g>\n";
  }

 private:
  // Returns the number of the clip path, from 1. Writes it before its first use.
  std::size_t clip_of(const Box& box) {
    const auto known = std::ranges::find_if(clips_, [&](const Box& each) {
      return each.corner == box.corner && each.size == box.size;
    });
    if (known != clips_.end()) return static_cast<std::size_t>(known - clips_.begin()) + 1;
    clips_.push_back(box);
    out_ << "<clipPath id=\"drawing-clip-" << clips_.size() << "\"><rect x=\""
         << short_number(box.corner.x) << "\" y=\"" << short_number(box.corner.y) << "\" width=\""
         << short_number(box.size.x) << "\" height=\"" << short_number(box.size.y)
         << "\"/></clipPath>\n";
    return clips_.size();
  }

  void add(const Area& area) {
    if (area.rings.empty()) return;
    const std::string color = rgb_text(area.color), opacity = short_number(area.color[3] / 255.0);
    if (area.pattern == Pattern::solid) {
      out_ << "<path fill-rule=\"evenodd\" fill=\"" << color << '"';
      if (area.color[3] < 255)
        out_ << " fill-opacity=\"" << opacity << '"';
      else
        out_ << " stroke=\"" << color << "\" stroke-width=\"" << short_number(kTrap_mm)
             << "\" stroke-linejoin=\"round\"";
      out_ << " d=\"";
      write_rings(out_, area.rings);
      out_ << "\"/>\n";
      return;
    }
    // The area clips its pattern, and the outer half of its border.
    const std::string id = "area-" + std::to_string(++areas_);
    out_ << "<clipPath id=\"" << id << "-clip\"><path id=\"" << id
         << "\" clip-rule=\"evenodd\" d=\"";
    write_rings(out_, area.rings);
    out_ << "\"/></clipPath>\n<g clip-path=\"url(#" << id << "-clip)\"";
    if (area.color[3] < 255) out_ << " opacity=\"" << opacity << '"';
    out_ << ">\n";
    const AreaPattern pattern = pattern_of(area);
    if (area.pattern != Pattern::outline)
      out_ << "<use href=\"#" << id << "\" fill-rule=\"evenodd\" fill=\"" << color
           << "\" fill-opacity=\"" << short_number(kGround) << "\"/>\n";
    if (!pattern.lines.empty()) {
      out_ << "<path fill=\"none\" stroke=\"" << color << "\" stroke-width=\""
           << short_number(pattern.width_mm) << "\" d=\"";
      for (const auto& [from, to] : pattern.lines)
        out_ << 'M' << coordinates(from) << 'L' << coordinates(to);
      out_ << "\"/>\n";
    }
    if (!pattern.dots.empty()) {
      // A line without length and with round ends is a dot.
      out_ << "<path fill=\"none\" stroke=\"" << color
           << "\" stroke-linecap=\"round\" stroke-width=\"" << short_number(2 * pattern.radius_mm)
           << "\" d=\"";
      for (const glm::dvec2& dot : pattern.dots) out_ << 'M' << coordinates(dot) << "h0";
      out_ << "\"/>\n";
    }
    out_ << "<use href=\"#" << id << "\" fill=\"none\" stroke=\"" << color
         << "\" stroke-linejoin=\"round\" stroke-width=\"" << short_number(2 * kBorder)
         << "\"/>\n</g>\n";
  }

  void add(const Mark& mark) {
    for (const bool is_casing : {true, false}) {
      out_ << "<path fill=\"none\" stroke-linecap=\"round\" stroke-linejoin=\"round\" stroke=\""
           << (is_casing ? "#fff" : rgb_text(mark.color)) << "\" stroke-width=\""
           << short_number(mark.width_mm + (is_casing ? 2 * mark.casing_mm : 0)) << '"';
      if (mark.color[3] < 255)
        out_ << " stroke-opacity=\"" << short_number(mark.color[3] / 255.0) << '"';
      out_ << " d=\"";
      for (std::size_t i = 0; i < mark.points.size(); ++i)
        out_ << (i == 0 ? 'M' : 'L') << coordinates(mark.points[i]);
      out_ << (mark.points.size() == 1 ? "h0\"/>\n" : "\"/>\n");
    }
  }

  std::ostream& out_;
  int areas_ = 0;  // ids of clip paths
  std::vector<Box> clips_;
};

}  // namespace

Result<void> write_svg(const Sheet& sheet, const Picture& drawing, const Document& document,
                       const std::filesystem::path& path, Progress& progress) {
  progress.report(0.1, "Packing the drawing");
  const std::string jpeg = to_base64(drawing_jpeg(drawing));
  if (progress.cancelled()) return cancelled_problem();
  progress.report(0.7, "Writing the file");
  std::ofstream out(path, std::ios::binary);
  const std::string width = short_number(sheet.size.x), height = short_number(sheet.size.y);
  out << "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<svg xmlns=\"http://www.w3.org/2000/svg\" "
         "xmlns:inkscape=\"http://www.inkscape.org/namespaces/inkscape\" width=\""
      << width << "mm\" height=\"" << height << "mm\" viewBox=\"0 0 " << width << ' ' << height
      << "\" font-family=\"" << kTypeface << ", sans-serif\">\n<title>"
      << escaped_markup(document.title) << "</title>\n<desc>" << escaped_markup(document.author)
      << "</desc>\n<rect width=\"" << width << "\" height=\"" << height << "\" fill=\"#fff\"/>\n";
  out << "<image id=\"drawing\" x=\"" << short_number(sheet.drawing.corner.x) << "\" y=\""
      << short_number(sheet.drawing.corner.y) << "\" width=\"" << short_number(sheet.drawing.size.x)
      << "\" height=\"" << short_number(sheet.drawing.size.y)
      << "\" preserveAspectRatio=\"none\" href=\"data:image/jpeg;base64," << jpeg << "\"/>\n";
  GroupWriter writer(out);
  for (const Group& group : sheet.groups) writer.write_group(group);
  out << "</svg>\n";
  out.close();
  if (!out) return unwritable();
  return {};
}

}  // namespace strata::figure
