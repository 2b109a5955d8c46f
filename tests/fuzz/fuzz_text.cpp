// Fuzzes all parsers of the short texts in requests and settings: targets and their queries,
// headers, times, points, lines, ids, patterns of file names, world files, tables of readings, keys
// of colors, and levels of the log.
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "core/log_levels.h"
#include "core/text/name_pattern.h"
#include "core/text/percent.h"
#include "core/text/timestamp.h"
#include "core/text/url.h"
#include "core/text/utf8.h"
#include "core/trace.h"
#include "core/uuid.h"
#include "domain/tables/surface_feature.h"
#include "net/http/accept.h"
#include "net/http/byte_range.h"
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
  constexpr std::uint64_t kBytes = 1000;
  if (const auto requested = net::requested_range(text, kBytes)) {
    const net::ByteRange& range = requested->range;
    demand(range.begin < range.end && range.end <= kBytes);
    demand(requested->is_part || (range.begin == 0 && range.end == kBytes));
  }
  for (const auto& accepted : net::accepted_values(text))
    demand(accepted.quality >= 0 && accepted.quality <= 1);
  (void)net::accepts_type(text, "application/geo+json");
  if (const auto context = parse_traceparent(text))
    demand(parse_traceparent(to_traceparent(*context)) == context);
  if (is_safe_url(text)) demand(text.starts_with("https://") || is_loopback_url(text));
}

void read_times(std::string_view text) {
  (void)day_of(text);
  const auto utc = utc_timestamp(text);
  if (utc) demand(utc_timestamp(*utc) == utc);
  demand(parse_time(text).has_value() == utc.has_value());
}

void read_names(std::string_view text) {
  if (const auto levels = log::parse_levels(text)) {
    const auto again = log::parse_levels(log::to_string(*levels));
    demand(again.has_value() && *again == *levels);
  }
  const auto half = text.size() / 2;
  const auto pattern = NamePattern::parse(text.substr(0, half), "pattern");
  if (!pattern) return;
  const std::string_view name = text.substr(half);
  for (const std::string_view word : {"code", "n"}) {
    if (!pattern->has(word)) continue;
    const auto is_known = [](std::string_view value) { return value.size() % 2 == 0; };
    if (const auto reading = pattern->read(name, word, is_known))
      demand(reading->is_known == is_known(reading->words.at(std::string(word))));
  }
}

void read_places(std::string_view text) {
  for (const bool lines : {false, true}) {
    const auto features = parse_features(text, lines);
    if (!features) continue;
    demand(features->size() <= kMaxFeatures);
    demand(parse_features(print_features(*features, lines), lines) == features);
  }
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
  read_times(text);
  read_names(text);
  read_places(text);
  read_numbers(text);
  read_tables(text);
  return 0;
}
