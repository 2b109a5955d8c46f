// Writes sheets as SVG, in millimeters. Groups have names, and text stays text, so users can edit
// the file. (cairo's SVG draws letters as shapes.)

#include <fstream>

#include "core/text/base64.h"
#include "core/text/number_text.h"
#include "figure/text.h"
#include "figure/writers.h"

namespace strata::figure {
namespace {

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) switch (c) {
      case '&': out += "&amp;"; break;
      case '<': out += "&lt;"; break;
      case '>': out += "&gt;"; break;
      case '"': out += "&quot;"; break;
      default: out += c;
    }
  return out;
}

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
  if (words.bold) out << " font-weight=\"bold\"";
  if (words.anchor != Anchor::start)
    out << " text-anchor=\"" << (words.anchor == Anchor::middle ? "middle" : "end") << '"';
  if (words.halo)
    out << " paint-order=\"stroke\" stroke=\"#fff\" stroke-linejoin=\"round\" stroke-width=\""
        << short_number(words.size_mm * 0.3) << '"';
  out << '>' << escaped(words.text) << "</text>\n";
}

}  // namespace

Result<void> write_svg(const Sheet& sheet, const Picture& drawing, const Document& document,
                       const std::filesystem::path& path, Progress& progress) {
  progress.report(0.1, "Packing the drawing");
  const std::string jpeg = to_base64(drawing_jpeg(drawing));
  if (progress.cancelled()) return cancelled_problem();
  progress.report(0.7, "Writing the file");
  std::ofstream out(path, std::ios::binary);
  const std::string width = short_number(sheet.size.x), height = short_number(sheet.size.y);
  out << "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<svg xmlns=\"http://www.w3.org/2000/svg\" width=\""
      << width << "mm\" height=\"" << height << "mm\" viewBox=\"0 0 " << width << ' ' << height
      << "\" font-family=\"" << kTypeface << ", sans-serif\">\n<title>" << escaped(document.title)
      << "</title>\n<desc>" << escaped(document.author) << "</desc>\n<rect width=\"" << width
      << "\" height=\"" << height << "\" fill=\"#fff\"/>\n";
  out << "<image id=\"drawing\" x=\"" << short_number(sheet.drawing.corner.x) << "\" y=\""
      << short_number(sheet.drawing.corner.y) << "\" width=\"" << short_number(sheet.drawing.size.x)
      << "\" height=\"" << short_number(sheet.drawing.size.y)
      << "\" preserveAspectRatio=\"none\" href=\"data:image/jpeg;base64," << jpeg << "\"/>\n";
  for (const Group& group : sheet.groups) {
    if (group.items.empty()) continue;
    out << "<g id=\"" << group.id << "\">\n";
    for (const Item& item : group.items)
      std::visit([&](const auto& each) { write(out, each); }, item);
    out << "</g>\n";
  }
  out << "</svg>\n";
  out.close();
  if (!out) return unwritable();
  return {};
}

}  // namespace strata::figure
