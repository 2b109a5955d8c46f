#pragma once

#include <string>
#include <string_view>
#include <vector>

// Parses the Accept headers of a client (RFC 9110, 12.4 and 12.5). These are lists of values, each
// with a quality from 0 (refused) to 1.
namespace strata::net {

struct Accepted {
  std::string value;  // in lower case, without parameters: "gzip", "text/csv", "*/*"
  double quality = 1;
};
// Returns the entries of an Accept or Accept-Encoding header. A malformed quality becomes 0.
std::vector<Accepted> accepted_values(std::string_view header);

// Returns whether an Accept header accepts this content type. An absent header accepts all types.
// `application/json` also accepts `application/…+json`.
bool accepts_type(std::string_view accept, std::string_view content_type);

}  // namespace strata::net
