#include "net/sheet.h"

#include "core/csv.h"

namespace strata::net {
Result<SheetFormat> sheet_format(const Request& request) {
  const auto asked = request.query.find("f");
  if (asked == request.query.end())
    return request.header("accept").find("text/csv") != std::string_view::npos ? SheetFormat::csv : SheetFormat::json;
  if (asked->second == "json") return SheetFormat::json;
  if (asked->second == "csv") return SheetFormat::csv;
  return fail(406, "Unknown format", "`f` is json or csv.", "f");
}

Result<char> csv_separator(const Request& request) {
  const std::string text = request.query_or("separator", "comma");
  if (text == "comma") return ',';
  if (text == "semicolon") return ';';
  if (text == "tab") return '\t';
  return fail(422, "Unknown separator", "`separator` is comma, semicolon or tab.", "separator");
}

Response csv_response(const Sheet& sheet, char separator) {
  std::string text(kUtf8Mark);
  std::vector<std::string> cells;
  for (const std::string& head : sheet.heads) cells.push_back(guard_formula(head));
  text += csv_line(cells, separator);
  for (const auto& row : sheet.rows) {
    cells.clear();
    for (const SheetCell& cell : row)
      if (const auto* number = std::get_if<double>(&cell))
        cells.push_back(csv_number(*number, separator));
      else if (const auto* words = std::get_if<std::string>(&cell))
        cells.push_back(guard_formula(*words));
      else
        cells.emplace_back();
    text += csv_line(cells, separator);
  }
  Response response = text_response(std::move(text), kCsvType);
  name_download(response, sheet.name + ".csv");
  return response;
}

void name_download(Response& response, const std::string& filename) {
  response.with("Content-Disposition", "attachment; filename*=UTF-8''" + percent_encode(filename));
}

}  // namespace strata::net
