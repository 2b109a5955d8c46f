#pragma once

#include <filesystem>

#include "app/records/sheet.h"
#include "net/http/http_types.h"

// Tables that people take into a spreadsheet, as answers.
namespace strata::net {

inline constexpr const char* kCsvType = "text/csv; charset=utf-8";

enum class SheetFormat { json, csv, xlsx };
// `f`, or where that is absent what Accept names; JSON where neither says anything. 406 for what is
// none of them.
Result<SheetFormat> sheet_format(const Request& request);
// Of CSV: `separator`; 422 for what is none.
Result<char> csv_separator(const Request& request);

// CSV or XLSX, for a download; XLSX is written in `folder`.
Result<Response> sheet_response(const app::Sheet& sheet, SheetFormat format, char separator,
                                const std::filesystem::path& folder);

}  // namespace strata::net
