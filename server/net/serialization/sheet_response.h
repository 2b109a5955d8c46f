#pragma once

#include <filesystem>

#include "app/records/sheet.h"
#include "net/http/http_types.h"

// Responses with tables for spreadsheets.
namespace strata::net {

inline constexpr const char* kCsvType = "text/csv; charset=utf-8";

enum class SheetFormat { json, csv, xlsx };
// Returns the format in the query parameter `f` or, if it is absent, the format in `Accept`. The
// default is JSON. Returns 406 for unsupported formats.
Result<SheetFormat> sheet_format(const Request& request);
// Returns the query parameter `separator` for CSV. Returns 422 for an unsuitable character.
Result<char> csv_separator(const Request& request);

// Returns CSV or XLSX as a download. Writes the XLSX to a file in `folder`.
Result<Response> sheet_response(const app::Sheet& sheet, SheetFormat format, char separator,
                                const std::filesystem::path& folder);

}  // namespace strata::net
