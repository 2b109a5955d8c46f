#include "domain/layers/palette.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/text/hex.h"

namespace strata {
namespace {

constexpr std::size_t kMaxPoints = 4096;

std::string format_color(const Rgba& color) { return "#" + to_hex(color); }

constexpr const char* kPatterns[] = {"solid", "hatch", "dots", "outline"};

Result<void> read_pattern(const nlohmann::json& item, PaletteMode mode, const std::string& field,
                          Palette::Point& point) {
  auto wrong = [&](const char* member, std::string detail) {
    return fail(ErrorCode::invalid, "Invalid palette", std::move(detail), field + "." + member);
  };
  if (const auto pattern = item.find("pattern"); pattern != item.end()) {
    const auto known =
        std::ranges::find_if(kPatterns, [&](const char* name) { return *pattern == name; });
    if (known == std::end(kPatterns))
      return wrong("pattern", "The pattern must be solid, hatch, dots or outline.");
    point.pattern = static_cast<Pattern>(known - std::begin(kPatterns));
    if (mode == PaletteMode::linear && point.pattern != Pattern::solid)
      return wrong("pattern",
                   "A palette with continuous colors cannot have patterns. Use a step or a "
                   "categorical palette.");
  }
  if (const auto angle = item.find("angle"); angle != item.end()) {
    if (!angle->is_number() || angle->get<double>() < 0 || angle->get<double>() > 180)
      return wrong("angle", "The angle of lines must be from 0 to 180 degrees.");
    point.angle = angle->get<double>();
  }
  if (const auto spacing = item.find("spacing_mm"); spacing != item.end()) {
    if (!spacing->is_number() || spacing->get<double>() < 0 ||
        spacing->get<double>() > kWidestSpacing_mm)
      return wrong("spacing_mm", "The distance between lines or dots must be 60000 mm or less.");
    point.spacing_mm = spacing->get<double>();
  }
  return {};
}

Palette linear_palette(double min, double max) {
  // Viridis at nine stops. It is perceptually uniform, and readable with every type of color vision
  // and in grayscale.
  static constexpr Rgba kStops[] = {{68, 1, 84, 255},    {71, 45, 123, 255},  {59, 82, 139, 255},
                                    {44, 114, 142, 255}, {33, 145, 140, 255}, {40, 174, 128, 255},
                                    {94, 201, 98, 255},  {173, 220, 48, 255}, {253, 231, 37, 255}};
  Palette palette{PaletteMode::linear, min, max, {}, {}};
  const int n = static_cast<int>(std::size(kStops));
  for (int i = 0; i < n; ++i)
    palette.points.push_back({min + (max - min) * i / (n - 1), kStops[i]});
  return palette;
}

Rgba mix(const Rgba& a, const Rgba& b, double t) {
  Rgba out;
  for (int i = 0; i < 4; ++i)
    out[i] = static_cast<std::uint8_t>(std::lround(a[i] + (b[i] - a[i]) * t));
  return out;
}

}  // namespace

std::string rgb_text(const Rgba& color) { return "#" + to_hex(std::span(color).first<3>()); }

Result<Rgba> parse_color(const nlohmann::json& json, const std::string& field) {
  auto wrong = [&] {
    return fail(ErrorCode::invalid, "Invalid color",
                "Write a color as \"#rrggbb\" or \"#rrggbbaa\".", field);
  };
  if (!json.is_string()) return wrong();
  const auto& text = json.get_ref<const std::string&>();
  if ((text.size() != 7 && text.size() != 9) || text[0] != '#') return wrong();
  Rgba color{0, 0, 0, 255};
  for (std::size_t i = 1; i < text.size(); i += 2) {
    const int high = hex_digit_value(text[i]), low = hex_digit_value(text[i + 1]);
    if (high < 0 || low < 0) return wrong();
    color[i / 2] = static_cast<std::uint8_t>(high << 4 | low);
  }
  return color;
}

Result<Palette> palette_from_json(const nlohmann::json& json, const std::string& field) {
  auto wrong = [&](const char* member, std::string detail) {
    return fail(ErrorCode::invalid, "Invalid palette", std::move(detail), field + "." + member);
  };
  if (!json.is_object())
    return fail(ErrorCode::invalid, "Invalid palette", "A palette must be a JSON object.", field);
  Palette palette;
  const std::string mode = json.value("mode", std::string("linear"));
  if (mode == "linear")
    palette.mode = PaletteMode::linear;
  else if (mode == "step")
    palette.mode = PaletteMode::step;
  else if (mode == "categorical")
    palette.mode = PaletteMode::categorical;
  else
    return wrong("mode", "The mode must be linear, step or categorical.");

  const auto points = json.find("points");
  if (points != json.end()) {
    if (!points->is_array() || points->size() > kMaxPoints)
      return wrong("points", "The points must be a list of at most 4096 elements.");
    for (std::size_t i = 0; i < points->size(); ++i) {
      const auto& item = (*points)[i];
      const std::string at_field = "points[" + std::to_string(i) + "]";
      if (!item.is_object() || !item.contains("at") || !item["at"].is_number() ||
          !item.contains("color"))
        return wrong(at_field.c_str(), "Each point needs a number `at` and a `color`.");
      auto color = STRATA_TRY(parse_color(item["color"], field + "." + at_field + ".color"));
      const double at = item["at"].get<double>();
      if (!palette.points.empty() && at <= palette.points.back().at)
        return wrong(at_field.c_str(),
                     "The points must be in ascending order: each `at` must be larger than the one "
                     "before it.");
      Palette::Point point{at, color, item.value("label", std::string()),
                           item.value("value", std::string())};
      STRATA_TRY(read_pattern(item, palette.mode, field + "." + at_field, point));
      palette.points.push_back(std::move(point));
    }
  }
  if (palette.points.empty() && palette.mode != PaletteMode::categorical)
    return wrong("points", "A linear or step palette needs at least one point.");
  const bool has_points = !palette.points.empty();
  palette.min = json.value("min", has_points ? palette.points.front().at : 0.0);
  palette.max = json.value("max", has_points ? palette.points.back().at : 1.0);
  if (!std::isfinite(palette.min) || !std::isfinite(palette.max) || palette.max < palette.min)
    return wrong("max",
                 "The upper limit must be a number that is not smaller than the lower limit.");
  palette.column = json.value("column", std::string());
  if (const auto others = json.find("others"); others != json.end()) {
    auto color = STRATA_TRY(parse_color(*others, field + ".others"));
    palette.others = color;
  }
  return palette;
}

nlohmann::json to_json(const Palette& palette) {
  static constexpr const char* kModes[] = {"linear", "step", "categorical"};
  nlohmann::json points = nlohmann::json::array();
  for (const auto& point : palette.points) {
    nlohmann::json item{{"at", point.at}, {"color", format_color(point.color)}};
    if (!point.label.empty()) item["label"] = point.label;
    if (!point.value.empty()) item["value"] = point.value;
    if (point.pattern != Pattern::solid) {
      item["pattern"] = kPatterns[static_cast<int>(point.pattern)];
      if (point.pattern != Pattern::outline) item["angle"] = point.angle;
      if (point.pattern != Pattern::outline && point.spacing_mm > 0)
        item["spacing_mm"] = point.spacing_mm;
    }
    points.push_back(std::move(item));
  }
  nlohmann::json json{{"mode", kModes[static_cast<int>(palette.mode)]},
                      {"min", palette.min},
                      {"max", palette.max},
                      {"points", points}};
  if (!palette.column.empty()) json["column"] = palette.column;
  if (palette.others) json["others"] = format_color(*palette.others);
  return json;
}

Palette default_palette(ValueType type, bool categorical) {
  if (categorical) {
    static constexpr Rgba kOkabeIto[] = {
        {230, 159, 0, 255}, {86, 180, 233, 255}, {0, 158, 115, 255},  {240, 228, 66, 255},
        {0, 114, 178, 255}, {213, 94, 0, 255},   {204, 121, 167, 255}};
    Palette palette{PaletteMode::categorical, 1, 7, {}, {}};
    for (int i = 0; i < 7; ++i) palette.points.push_back({double(i + 1), kOkabeIto[i]});
    return palette;
  }
  return is_float(type) ? linear_palette(0, 1)
                        : linear_palette(0, std::min(100.0, highest_value(type)));
}

Rgba generated_color(std::uint32_t key) {
  const std::uint32_t h = key * 2654435761u;
  const float hue = static_cast<float>(h >> 8) / 16777216.0f * 6.0f;
  const float saturation = 0.55f + 0.25f * static_cast<float>(h & 0xffu) / 255.0f;
  constexpr float kBrightness = 0.85f;
  auto channel = [&](float offset) {
    const float k = std::fmod(offset + hue, 6.0f);
    const float v =
        kBrightness - kBrightness * saturation * std::clamp(std::min(k, 4.0f - k), 0.0f, 1.0f);
    return static_cast<std::uint8_t>(std::lround(v * 255.0f));
  };
  return {channel(5), channel(3), channel(1), 255};
}

const Palette::Point* point_of(const Palette& palette, double value) {
  const auto& points = palette.points;
  if (palette.mode == PaletteMode::linear || points.empty()) return nullptr;
  if (palette.mode == PaletteMode::categorical) {
    const auto found = std::ranges::lower_bound(points, value, {}, &Palette::Point::at);
    return found != points.end() && found->at == value ? &*found : nullptr;
  }
  const double v = std::clamp(value, palette.min, palette.max);
  const auto above = std::ranges::upper_bound(points, v, {}, &Palette::Point::at);
  return above == points.begin() ? &*above : &*(above - 1);
}

Rgba color_of(const Palette& palette, double value) {
  if (const Palette::Point* point = point_of(palette, value)) return point->color;
  if (palette.mode == PaletteMode::categorical)
    return palette.others.value_or(
        generated_color(static_cast<std::uint32_t>(static_cast<std::int64_t>(value))));
  const auto& points = palette.points;
  const double v = std::clamp(value, palette.min, palette.max);
  const auto above = std::ranges::upper_bound(points, v, {}, &Palette::Point::at);
  if (above == points.begin()) return points.front().color;
  const auto below = above - 1;
  if (above == points.end()) return below->color;
  return mix(below->color, above->color, (v - below->at) / (above->at - below->at));
}

}  // namespace strata
