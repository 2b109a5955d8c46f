#pragma once

#include <filesystem>

#include "app/records/sheet.h"
#include "net/http/http_types.h"

// Answers with tables for spreadsheets.
namespace strata::net {

inline constexpr const char* kCsvType = "text/csv; charset=utf-8";

enum class SheetFormat { json, csv, xlsx };
// Returns the format in `f`, otherwise the one that `Accept` names, otherwise JSON. 406 for other
// formats.
Result<SheetFormat> sheet_format(const Request& request);
// Returns the `separator` of CSV; 422 for a character that cannot be one.
Result<char> csv_separator(const Request& request);

// Returns CSV or XLSX as a download; writes the XLSX in `folder`.
Result<Response> sheet_response(const app::Sheet& sheet, SheetFormat format, char separator,
                                const std::filesystem::path& folder);

}  // namespace strata::net
