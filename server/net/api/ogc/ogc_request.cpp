#include "net/api/ogc/ogc_request.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "core/text/percent.h"
#include "core/text/timestamp.h"
#include "domain/scene/model.h"
#include "net/api/ogc/ogc_page.h"
#include "net/api/route_help.h"
#include "net/http/accept.h"
#include "net/http/origin.h"
#include "net/serialization/map_query.h"
#include "net/transport/server_options.h"

namespace strata::net {
namespace {

constexpr std::string_view kEpsg = "http://www.opengis.net/def/crs/EPSG/0/";

enum class DocumentFormat { json, html };
Result<DocumentFormat> document_format(const Request& request) {
  const auto format = request.query.find("f");
  if (format == request.query.end()) {
    // A browser names text/html. Programs accept anything, or name JSON.
    for (const Accepted& accepted : accepted_values(request.header("accept")))
      if (accepted.value == "text/html" && accepted.quality > 0) return DocumentFormat::html;
    return DocumentFormat::json;
  }
  STRATA_TRY(check_format(request, {"json", "html"}));
  return format->second == "html" ? DocumentFormat::html : DocumentFormat::json;
}

// Returns the numbers of a list that is separated by commas, or nothing for other text.
std::optional<std::vector<double>> numbers_of(const std::string& text) {
  std::vector<double> numbers;
  for (const char *at = text.data(), *end = at + text.size();; ++at) {
    double number = 0;
    const auto [next, error] = std::from_chars(at, end, number);
    if (error != std::errc() || !std::isfinite(number)) return std::nullopt;
    numbers.push_back(number);
    at = next;
    if (at == end) return numbers;
    if (*at != ',') return std::nullopt;
  }
}

}  // namespace

std::string ogc_base(const RouteContext& context, const Request& request) {
  return own_origin(request, context.options.allowed_origins) + "/ogc";
}

std::string with_query(std::string address, std::string_view part) {
  if (!part.empty())
    address.append(address.find('?') == std::string::npos ? "?" : "&").append(part);
  return address;
}

std::string along_query(const Request& request) {
  const auto along = request.query.find("along");
  return along == request.query.end() ? std::string() : "along=" + percent_encode(along->second);
}

Result<void> check_format(const Request& request, const std::vector<std::string_view>& known) {
  const auto format = request.query.find("f");
  if (format == request.query.end() || std::ranges::count(known, format->second) > 0) return {};
  std::string names;
  for (const std::string_view name : known) names.append(names.empty() ? "" : ", ").append(name);
  return fail(ErrorCode::malformed, "Unknown format", "`f` must be one of: " + names + ".", "f");
}

nlohmann::json ogc_link(std::string href, std::string_view relation, std::string_view type,
                        std::string_view title) {
  return {{"href", std::move(href)}, {"rel", relation}, {"type", type}, {"title", title}};
}

Result<Response> ogc_document(const RouteContext& context, const Request& request,
                              nlohmann::json document) {
  const auto format = STRATA_TRY(document_format(request));
  const std::string address = with_query(
      own_origin(request, context.options.allowed_origins) + request.path, along_query(request));
  const auto form = [&](bool is_shown, const char* name, const char* type, const char* title) {
    return ogc_link(with_query(address, std::string("f=") + name), is_shown ? "self" : "alternate",
                    type, title);
  };
  auto& links = document["links"];
  links.push_back(form(format == DocumentFormat::json, "json", "application/json", "As JSON"));
  links.push_back(form(format == DocumentFormat::html, "html", "text/html", "As a page"));
  Response response = format == DocumentFormat::json
                          ? json_response(document)
                          : text_response(ogc_page(document), "text/html; charset=utf-8");
  response.with("Vary", "Accept");
  return response;
}

std::string uri_of(const app::GisPlane& plane, const Model& model, const std::string& base) {
  return plane.crs() ? std::string(kEpsg) + std::to_string(plane.crs()->code())
                     : base + "/crs/" + model.slug + "/" + plane.name();
}

std::vector<std::string> systems_of(const app::GisPlane& plane, const Model& model,
                                    const std::string& base) {
  std::vector<std::string> systems;
  if (plane.crs()) systems.emplace_back(kCrs84);
  systems.push_back(uri_of(plane, model, base));
  return systems;
}

Result<app::GisSystem> system_of(const Request& request, const std::string& parameter,
                                 const app::GisPlane& plane, const Model& model,
                                 const std::string& base) {
  const auto found = request.query.find(parameter);
  if (found == request.query.end()) return plane.usual_system();
  std::string text = found->second;
  // a safe CURIE
  if (text.starts_with('[') && text.ends_with(']')) text = text.substr(1, text.size() - 2);
  if (plane.crs() && (text == kCrs84 || text == "CRS84" || text == "OGC:CRS84"))
    return app::GisSystem::degrees;
  if (text == uri_of(plane, model, base) ||
      (plane.crs() && text == "EPSG:" + std::to_string(plane.crs()->code())))
    return app::GisSystem::plane;
  std::string known;
  for (const std::string& system : systems_of(plane, model, base))
    known += (known.empty() ? "" : ", ") + system;
  return fail(ErrorCode::malformed, "Unknown coordinate system",
              "`" + parameter + "` must be one of: " + known + ".", parameter);
}

Result<std::optional<GisBox>> bbox_of(const Request& request) {
  const auto found = request.query.find("bbox");
  if (found == request.query.end()) return std::nullopt;
  const auto numbers = numbers_of(found->second);
  if (!numbers || (numbers->size() != 4 && numbers->size() != 6))
    return fail(ErrorCode::malformed, "Invalid box",
                "`bbox` must be four numbers, separated by commas: the smallest first and second "
                "coordinate, then the largest ones. With heights, there are six.",
                "bbox");
  const std::size_t half = numbers->size() / 2;
  const GisBox box{{(*numbers)[0], (*numbers)[1]}, {(*numbers)[half], (*numbers)[half + 1]}};
  if (box.low.x > box.high.x || box.low.y > box.high.y)
    return fail(ErrorCode::malformed, "Invalid box",
                "In `bbox`, the first corner must have the smaller coordinates. Boxes across the "
                "180th meridian are not supported.",
                "bbox");
  return box;
}

Result<std::optional<protocol::At>> datetime_of(const Request& request) {
  const auto found = request.query.find("datetime");
  if (found == request.query.end()) return std::nullopt;
  const std::string& text = found->second;
  const auto is_open = [](std::string_view part) { return part.empty() || part == ".."; };
  const auto slash = text.find('/');
  std::string end = text;
  bool good = true;
  if (slash != std::string::npos) {
    const std::string begin = text.substr(0, slash);
    end = text.substr(slash + 1);
    const auto from = utc_timestamp(begin), to = utc_timestamp(end);
    good = (from || is_open(begin)) && (to || is_open(end)) && !(from && to && *from > *to);
    if (good && is_open(end)) return std::nullopt;
  }
  const auto utc = utc_timestamp(end);
  if (!good || !utc)
    return fail(ErrorCode::malformed, "Invalid time",
                "`datetime` must be a time such as 2026-05-04T12:00:00Z, or an interval of two "
                "times such as 2026-05-04T12:00:00Z/.. whose end may be open.",
                "datetime");
  if (*utc >= utc_text(std::chrono::system_clock::now())) return std::nullopt;
  return protocol::At(*utc);
}

Error as_malformed(Error error) {
  if (error.code == ErrorCode::invalid) error.code = ErrorCode::malformed;
  return error;
}

Result<app::GisPlane> plane_of(const Request& request, const Model& model) {
  if (!request.query.contains("along")) return app::GisPlane(model, std::nullopt);
  const auto axis = map_axis(request);
  if (!axis) return tl::unexpected(as_malformed(axis.error()));
  return app::GisPlane(model, *axis);
}

}  // namespace strata::net
