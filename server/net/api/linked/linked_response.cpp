#include "net/api/linked/linked_response.h"

#include <optional>

#include "net/api/linked/linked_page.h"
#include "net/http/accept.h"
#include "net/http/origin.h"
#include "net/transport/server_options.h"

namespace strata::net {
namespace {

enum class LinkedFormat { jsonld, turtle, html };

std::optional<LinkedFormat> format_of_type(const std::string& type) {
  if (type == "text/turtle") return LinkedFormat::turtle;
  if (type == "text/html") return LinkedFormat::html;
  if (type == "application/ld+json" || type == "application/json" || type == "application/*" ||
      type == "*/*")
    return LinkedFormat::jsonld;
  return std::nullopt;
}

Result<LinkedFormat> linked_format(const Request& request) {
  if (const auto asked = request.query.find("f"); asked != request.query.end()) {
    if (asked->second == "jsonld") return LinkedFormat::jsonld;
    if (asked->second == "turtle") return LinkedFormat::turtle;
    if (asked->second == "html") return LinkedFormat::html;
    return fail(ErrorCode::not_acceptable, "Unknown format", "`f` must be jsonld, turtle or html.",
                "f");
  }
  if (request.header("accept").empty()) return LinkedFormat::jsonld;
  std::optional<LinkedFormat> best;
  double quality = 0;
  for (const Accepted& accepted : accepted_values(request.header("accept")))
    if (const auto format = format_of_type(accepted.value); format && accepted.quality > quality) {
      best = format;
      quality = accepted.quality;
    }
  if (best) return *best;
  return fail(ErrorCode::not_acceptable, "Unknown format",
              "Accept application/ld+json, text/turtle or text/html.", "Accept");
}

}  // namespace

Result<Response> linked_response(const RouteContext& context, const Request& request,
                                 nlohmann::json document, const LinkedContext& terms,
                                 const std::string& page) {
  const auto format = STRATA_TRY(linked_format(request));
  const std::string address = own_origin(request, context.options.allowed_origins) + request.path;
  Response response;
  switch (format) {
    case LinkedFormat::turtle:
      response =
          text_response(STRATA_TRY(linked_turtle(document, terms)), "text/turtle; charset=utf-8");
      break;
    case LinkedFormat::html:
      response = text_response(linked_page(document, address, page), "text/html; charset=utf-8");
      break;
    case LinkedFormat::jsonld: {
      document["@context"] = context_of(terms);
      std::string type = "application/ld+json";
      if (!terms.published.empty()) type += "; profile=\"" + std::string(terms.published) + "\"";
      response = text_response(
          document.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace), type);
      break;
    }
  }
  response.with("Vary", "Accept");
  response.with("Link", "<" + address +
                            "?f=jsonld>; rel=\"alternate\"; type=\"application/ld+json\", <" +
                            address + "?f=turtle>; rel=\"alternate\"; type=\"text/turtle\"");
  return response;
}

}  // namespace strata::net
