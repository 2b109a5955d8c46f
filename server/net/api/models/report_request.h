#pragma once

#include "app/reports/report.h"
#include "net/api/route_help.h"

namespace strata::net {

// Reads a condition report from the request body. Refuses (422) a section that appears twice, a
// logo that is not base64 or too large, and what figure_request refuses, at the fields of this
// request. Returns 404 for a layer or view that does not exist.
Result<app::ReportRequest> read_report_request(const RouteContext& context, const Request& request);

}  // namespace strata::net
