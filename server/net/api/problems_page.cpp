#include "net/api/problems_page.h"

#include "core/text/markup.h"
#include "protocol/problem.h"

namespace strata::net {
namespace {

constexpr std::string_view kBegin =
    "<!doctype html><html lang=\"en\"><head><meta charset=\"utf-8\">"
    "<meta name=\"viewport\" content=\"width=device-width\">"
    "<link rel=\"icon\" href=\"/favicon.svg\" type=\"image/svg+xml\">"
    "<title>Problems of the Strata API</title>"
    "<link rel=\"stylesheet\" href=\"/problems.css\"></head><body><main>";

}  // namespace

std::string problems_html() {
  std::string page = std::string(kBegin) +
                     "<h1>Problems of the Strata API</h1><p>Every error is an "
                     "<code>application/problem+json</code> (RFC 9457). Its <code>type</code> is "
                     "one of these values. Programs must use it, because the texts of "
                     "<code>title</code> and <code>detail</code> may change.</p><table><thead><tr>"
                     "<th scope=\"col\">Type</th><th scope=\"col\">Status</th>"
                     "<th scope=\"col\">Meaning</th><th scope=\"col\">What to do</th>"
                     "</tr></thead><tbody>";
  for (const protocol::ProblemKind& kind : protocol::problem_kinds()) {
    const std::string code(name(kind.code));
    page += "<tr id=\"" + code + "\"><td><code>" + protocol::problem_type(kind.code) +
            "</code></td><td>" + std::to_string(kind.status) + "</td><td>" +
            escaped_markup(kind.meaning) + "</td><td>" + escaped_markup(kind.remedy) + "</td></tr>";
  }
  return page + "</tbody></table></main></body></html>";
}

}  // namespace strata::net
