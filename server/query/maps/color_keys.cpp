#include "query/maps/color_keys.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "query/sampling/cielab.h"

namespace strata::query {
namespace {

constexpr double kMinShare = 0.005;
constexpr int kBinBits = 5;  // bits per channel in the first histogram

struct Lab {
  float l = 0, a = 0, b = 0;
};

float squared_distance(const Lab& x, const Lab& y) {
  return (x.l - y.l) * (x.l - y.l) + (x.a - y.a) * (x.a - y.a) + (x.b - y.b) * (x.b - y.b);
}

Lab lab_of(const std::uint8_t* rgb) {
  const glm::vec3 lab =
      lab_of_light({light_of_srgb(rgb[0]), light_of_srgb(rgb[1]), light_of_srgb(rgb[2])});
  return {lab.x, lab.y, lab.z};
}

// Pixels with similar colors.
struct Bin {
  std::array<std::uint64_t, 3> sum{};
  std::uint64_t count = 0, at_border = 0;

  void add(const Bin& other) {
    for (std::size_t c = 0; c < 3; ++c) sum[c] += other.sum[c];
    count += other.count;
    at_border += other.at_border;
  }
  Rgba mean() const {
    Rgba color{0, 0, 0, 255};
    for (std::size_t c = 0; c < 3; ++c)
      color[c] = static_cast<std::uint8_t>((sum[c] + count / 2) / count);
    return color;
  }
};

// Returns the bins in descending order of pixels.
std::vector<Bin> bins_of(const Picture& picture) {
  std::vector<Bin> bins(std::size_t{1} << (3 * kBinBits));
  const std::uint8_t* rgba = picture.rgba.data();
  for (int y = 0; y < picture.height; ++y)
    for (int x = 0; x < picture.width; ++x, rgba += 4) {
      if (rgba[3] < 128) continue;
      std::size_t at = 0;
      for (int c = 0; c < 3; ++c)
        at = at << kBinBits | static_cast<std::size_t>(rgba[c] >> (8 - kBinBits));
      Bin& bin = bins[at];
      for (std::size_t c = 0; c < 3; ++c) bin.sum[c] += rgba[c];
      ++bin.count;
      bin.at_border += x == 0 || y == 0 || x == picture.width - 1 || y == picture.height - 1;
    }
  std::erase_if(bins, [](const Bin& bin) { return bin.count == 0; });
  std::stable_sort(bins.begin(), bins.end(),
                   [](const Bin& a, const Bin& b) { return a.count > b.count; });
  return bins;
}

// Adds each bin to the nearest center within the tolerance. A bin without such a center becomes a
// center if `may_grow` is true.
std::vector<Bin> gathered(const std::vector<Bin>& bins, std::vector<Lab> centres, float tolerance,
                          bool may_grow) {
  std::vector<Bin> groups(centres.size());
  for (const Bin& bin : bins) {
    const Lab place = lab_of(bin.mean().data());
    std::size_t nearest = centres.size();
    float least = tolerance * tolerance;
    for (std::size_t i = 0; i < centres.size(); ++i)
      if (const float squared = squared_distance(place, centres[i]); squared <= least)
        nearest = i, least = squared;
    if (nearest == centres.size()) {
      if (!may_grow) continue;
      centres.push_back(place);
      groups.emplace_back();
    }
    groups[nearest].add(bin);
  }
  return groups;
}

}  // namespace

Result<std::vector<ColorKey>> parse_color_keys(std::string_view text, const std::string& field) {
  const auto refuse = [&](const std::string& what) {
    return fail(ErrorCode::invalid, "Invalid colors", what, field);
  };
  const auto json = nlohmann::json::parse(text, nullptr, false);
  if (!json.is_object() || json.empty() || json.size() > kMaxColorKeys)
    return refuse("Send an object of 1 to " + std::to_string(kMaxColorKeys) +
                  " colors with their values, such as {\"#c02020\": 1}.");
  std::vector<ColorKey> keys;
  for (const auto& [color, value] : json.items()) {
    if (!value.is_number())
      return refuse("The color " + color.substr(0, 20) + " has a value that is not a number.");
    // Parses the color as a legend of one point, because legends have the same color syntax.
    const auto legend = palette_from_json(
        {{"mode", "categorical"}, {"points", {{{"at", value}, {"color", color}}}}}, field);
    if (!legend)
      return refuse("\"" + color.substr(0, 20) + "\" is not a color. Write it as \"#rrggbb\".");
    keys.push_back({legend->points[0].color, value.get<double>()});
  }
  return keys;
}

ColorKeys::ColorKeys(const std::vector<ColorKey>& keys, double tolerance)
    : squared_tolerance_(static_cast<float>(tolerance * tolerance)) {
  for (const ColorKey& key : keys) {
    const Lab lab = lab_of(key.color.data());
    places_.push_back({lab.l, lab.a, lab.b, key.value});
  }
}

std::optional<double> ColorKeys::value_of(const std::uint8_t* rgb) const {
  const Lab lab = lab_of(rgb);
  std::optional<double> value;
  float least = squared_tolerance_;
  for (const Place& place : places_)
    if (const float squared = squared_distance(lab, {place.l, place.a, place.b});
        squared <= least) {
      value = place.value;
      least = squared;
    }
  return value;
}

std::vector<FoundColor> find_colors(const Picture& picture, double tolerance) {
  const std::vector<Bin> bins = bins_of(picture);
  std::uint64_t pixels = 0;
  for (const Bin& bin : bins) pixels += bin.count;
  const auto large = [&](std::vector<Bin> groups) {
    std::stable_sort(groups.begin(), groups.end(),
                     [](const Bin& a, const Bin& b) { return a.count > b.count; });
    std::erase_if(groups, [&](const Bin& bin) {
      return bin.count == 0 ||
             static_cast<double>(bin.count) < kMinShare * static_cast<double>(pixels);
    });
    if (groups.size() > kMaxFoundColors) groups.resize(kMaxFoundColors);
    return groups;
  };
  auto groups = large(gathered(bins, {}, static_cast<float>(tolerance), true));
  // The second pass uses the means of the groups as centers. The first center of a group is only
  // its largest bin.
  std::vector<Lab> centres;
  for (const Bin& group : groups) centres.push_back(lab_of(group.mean().data()));
  groups = large(gathered(bins, centres, static_cast<float>(tolerance), false));

  std::vector<FoundColor> found;
  std::uint64_t most = 0;
  for (const Bin& group : groups) {
    most = std::max(most, group.at_border);
    found.push_back(
        {group.mean(), static_cast<double>(group.count) / static_cast<double>(pixels), false});
  }
  for (std::size_t i = 0; i < groups.size() && most > 0; ++i)
    if (groups[i].at_border == most) {
      found[i].is_background = true;
      break;
    }
  return found;
}

}  // namespace strata::query
