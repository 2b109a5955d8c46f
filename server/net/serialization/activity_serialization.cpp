#include "net/serialization/activity_serialization.h"

#include <charconv>

#include "core/text/timestamp.h"
#include "net/serialization/edit_serialization.h"

namespace strata::net {

nlohmann::json to_json(const store::Activity& line) {
  nlohmann::json json{{"id", line.id},
                      {"time", utc_text(line.time)},
                      {"begun", utc_text(line.begun)},
                      {"kind", line.kind},
                      {"op", line.op},
                      {"count", line.count}};
  const auto put_text = [&](const char* name, const std::string& text) {
    if (!text.empty()) json[name] = text;
  };
  const auto put = [&](const char* name, const auto& value) {
    if (value) json[name] = *value;
  };
  put_text("user", line.user);
  put_text("name", line.name);
  put("model", line.model);
  put_text("model_name", line.model_name);
  put("layer", line.layer);
  put("table", line.table);
  put("record", line.record);
  put("comment", line.comment);
  put_text("text", line.text);
  put_text("person", line.person);
  put_text("group", line.group);
  put_text("role", line.role);
  put("texels", line.texels);
  put("area_m2", line.area_m2);
  if (!line.changed.empty()) json["changed"] = line.changed;
  return json;
}

std::string to_text(const store::ActivityPlace& place) {
  return std::to_string(place.time_us) + "-" + std::to_string(place.id);
}

// Limits the numbers to 16 and 15 digits, far below the limits of their database columns.
std::optional<store::ActivityPlace> place_of(std::string_view text) {
  const std::size_t dash = text.find('-');
  if (dash == std::string_view::npos) return std::nullopt;
  const auto number = [](std::string_view digits, std::size_t most, std::int64_t& into) {
    if (digits.empty() || digits.size() > most || digits.front() == '-') return false;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), into);
    return error == std::errc() && end == digits.data() + digits.size();
  };
  store::ActivityPlace place;
  if (!number(text.substr(0, dash), 16, place.time_us) ||
      !number(text.substr(dash + 1), 15, place.id))
    return std::nullopt;
  return place;
}

}  // namespace strata::net
