// Fuzzes all parsers of the short texts in requests: targets and their queries, cookies, origins,
// points, ids, world files, tables of readings, and keys of colors.
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "core/text/percent.h"
#include "core/text/utf8.h"
#include "core/uuid.h"
#include "net/http/http_types.h"
#include "net/http/origin.h"
#include "net/http/page.h"
#include "net/serialization/point_text.h"
#include "query/maps/color_keys.h"
#include "query/maps/point_measurements.h"
#include "query/rasters/world_file.h"

namespace {

using namespace strata;

void demand(bool holds) {
  if (!holds) std::abort();
}

bool is_text(std::string_view text) {
  return is_utf8(text) && text.find('\0') == std::string_view::npos;
}

std::string exact(double number) {
  char text[40];
  return {text, std::to_chars(text, text + sizeof text, number).ptr};
}

void read_target(std::string_view text) {
  net::Request request;
  if (!net::parse_target(text, request)) return;
  demand(request.path.starts_with('/') && is_text(request.path));
  std::string target = "/";
  for (const auto& segment : request.segments) demand(is_text(segment));
  for (const auto& [key, value] : request.query) {
    demand(is_text(key) && is_text(value));
    target += (target.size() == 1 ? "?" : "&") + percent_encode(key) + "=" + percent_encode(value);
  }
  net::Request again;
  demand(net::parse_target(target, again).has_value());
  demand(again.query == request.query);
  if (const auto page = net::page_of(request)) {
    demand(page->limit >= 1 && page->limit <= net::kMaxPage && page->offset >= 0);
    net::Response response;
    net::add_page_links(response, request, *page, 1'000'000);
    for (const char c : response.header("Link")) demand(c >= 32 && c < 127);
  }
}

void read_headers(std::string_view text) {
  demand(net::cookie_value(text, "strata_session").size() <= text.size());
  const auto half = text.size() / 2;
  (void)net::is_own_origin(text.substr(0, half), text.substr(half), {"https://site.example/"},
                           text.size() % 2 == 0);
}

void read_numbers(std::string_view text) {
  if (const auto point = net::parse_point(text)) {
    const auto again = net::parse_point("POINT Z(" + exact(point->x) + " " + exact(point->y) + " " +
                                        exact(point->z) + ")");
    demand(again.has_value() && *again == *point);
  }
  if (const auto length = net::parse_length(text, "cell"))
    demand(*length >= 1e-6 && *length <= 1e6);
  if (const auto world = query::parse_world_file(text, "world")) {
    std::string lines;
    for (const double number : {world->x_per_column, world->y_per_column, world->x_per_row,
                                world->y_per_row, world->x, world->y})
      lines += exact(number) + "\n";
    const auto again = query::parse_world_file(lines, "world");
    demand(again.has_value() && again->x_per_column == world->x_per_column && again->y == world->y);
  }
  if (const auto id = parse_uuid(text)) demand(parse_uuid(to_string(*id)) == id);
  if (const auto number = parse_integer(text, -1000, 1000, "field"))
    demand(*number >= -1000 && *number <= 1000);
}

void read_tables(std::string_view text) {
  if (const auto measurements = query::parse_point_measurements(text)) {
    demand(!measurements->empty() && measurements->size() <= query::kMaxPointMeasurements);
    int line = 1;
    for (const auto& measurement : *measurements) {
      demand(measurement.line > line && std::isfinite(measurement.value));
      for (int axis = 0; axis < 3; ++axis) demand(std::isfinite(measurement.position[axis]));
      line = measurement.line;
    }
  }
  if (const auto keys = query::parse_color_keys(text, "colors")) {
    demand(!keys->empty() && keys->size() <= query::kMaxColorKeys);
    const query::ColorKeys finder(*keys, query::kUsualTolerance);
    for (const auto& key : *keys) demand(finder.value_of(key.color.data()).has_value());
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  read_target(text);
  read_headers(text);
  read_numbers(text);
  read_tables(text);
  return 0;
}
