#include "net/serialization/sheet_response.h"

#include "app/records/workbook.h"

namespace strata::net {

Result<SheetFormat> sheet_format(const Request& request) {
  const auto format = request.query.find("f");
  if (format == request.query.end()) {
    const std::string_view accepted = request.header("accept");
    if (accepted.find("text/csv") != std::string_view::npos) return SheetFormat::csv;
    return accepted.find(app::kXlsxType) != std::string_view::npos ? SheetFormat::xlsx
                                                                   : SheetFormat::json;
  }
  if (format->second == "json") return SheetFormat::json;
  if (format->second == "csv") return SheetFormat::csv;
  if (format->second == "xlsx") return SheetFormat::xlsx;
  return fail(ErrorCode::not_acceptable, "Unknown format", "`f` must be json, csv or xlsx.", "f");
}

Result<char> csv_separator(const Request& request) {
  const std::string text = request.query_or("separator", "comma");
  if (text == "comma") return ',';
  if (text == "semicolon") return ';';
  if (text == "tab") return '\t';
  return fail(ErrorCode::invalid, "Unknown separator",
              "`separator` must be comma, semicolon or tab.", "separator");
}

Result<Response> sheet_response(const app::Sheet& sheet, SheetFormat format, char separator,
                                const std::filesystem::path& folder) {
  if (format == SheetFormat::xlsx)
    return file_response(STRATA_TRY(app::write_workbook(sheet, folder)));
  Response response = text_response(app::csv_text(sheet, separator), kCsvType);
  name_download(response, sheet.name + ".csv");
  return response;
}

}  // namespace strata::net
