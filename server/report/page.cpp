#include "report/page.h"

#include <algorithm>
#include <boost/algorithm/string/replace.hpp>

namespace strata::report {

std::vector<double> column_widths_mm(const Table& table) {
  std::vector<double> widths(table.columns.size(), 0);  // 0: not known yet
  double left_mm = kTextWidth_mm;
  for (bool changes = true; changes;) {
    changes = false;
    double sum = 0;
    for (std::size_t i = 0; i < widths.size(); ++i)
      if (widths[i] == 0) sum += table.columns[i].width;
    const double share_mm = left_mm / sum;
    for (std::size_t i = 0; i < widths.size(); ++i)
      if (widths[i] == 0 && table.columns[i].width * share_mm < kLeastColumn_mm) {
        widths[i] = kLeastColumn_mm;
        left_mm -= kLeastColumn_mm;
        changes = true;
      }
    if (!changes)
      for (std::size_t i = 0; i < widths.size(); ++i)
        if (widths[i] == 0) widths[i] = table.columns[i].width * share_mm;
  }
  return widths;
}

bool has_head(const Table& table) {
  return std::ranges::any_of(table.columns,
                             [](const Column& column) { return !column.name.empty(); });
}

bool has_rules(const Table& table) {
  const auto all_pictures = [](const std::vector<Cell>& row) {
    return !row.empty() &&
           std::ranges::all_of(row, [](const Cell& cell) { return cell.picture.has_value(); });
  };
  return has_head(table) || !table.total.empty() || table.rows.empty() ||
         !std::ranges::all_of(table.rows, all_pictures);
}

ShownSize shown_size(double width_mm, int width, int height, double most_width_mm,
                     double most_height_mm) {
  const double height_mm = width_mm * height / width;
  const double scale = std::min({1.0, most_width_mm / width_mm, most_height_mm / height_mm});
  return {width_mm * scale, height_mm * scale, scale};
}

std::string caption_of(const Picture& picture, const ShownSize& size, const Wording& wording) {
  if (size.scale == 1) return picture.caption;
  const std::string percent = std::to_string(std::max(1, static_cast<int>(size.scale * 100)));
  const std::string note =
      boost::algorithm::replace_all_copy(wording.reduced, "{percent}", percent);
  return picture.caption.empty() ? note : picture.caption + " " + note;
}

}  // namespace strata::report
