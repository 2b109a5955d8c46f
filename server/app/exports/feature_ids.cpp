#include "app/exports/feature_ids.h"

#include <algorithm>
#include <array>
#include <limits>
#include <unordered_map>

#include "core/overloaded.h"
#include "media/picture_writer.h"
#include "query/statistics/value_classes.h"

namespace strata::app {
namespace {

using mesh::FeatureProperty;

// Writes the ids of the texels row by row, from the top of the atlas.
class IdWriter {
 public:
  IdWriter(const LayerClasses& classes, std::uint32_t none)
      : layer_(classes.areas.view.layer),
        tiles_(classes.areas.view.snapshot.tiles),
        of_values_(query::classes_of(layer_)),
        none_(none) {
    for (std::size_t i = 0; i < classes.classes.size(); ++i)
      ids_.emplace(classes.classes[i], static_cast<std::uint32_t>(i));
  }

  Result<std::vector<std::uint8_t>> write(Progress& progress) const {
    const int side = layer_.resolution / kTileSize;
    PictureWriter writer(PictureFormat::png, layer_.resolution, layer_.resolution);
    std::vector<std::uint8_t> rows(std::size_t{4} * kTileSize *
                                   static_cast<std::size_t>(layer_.resolution));
    for (int y = side - 1; y >= 0; --y) {
      if (progress.cancelled()) return cancelled_problem();
      progress.report(static_cast<double>(side - 1 - y) / side, "Writing the features");
      for (int x = 0; x < side; ++x) put_tile(x, y, rows);
      writer.put(rows);
    }
    return writer.finish();
  }

 private:
  std::uint32_t id_of(std::uint32_t bits) const {
    const auto id = ids_.find(of_values_.of(bits, decode_value(layer_.type, bits)));
    return id == ids_.end() ? none_ : id->second;
  }

  // Writes the pixels of a tile to the rows of all tiles with this y.
  void put_tile(int tile_x, int tile_y, std::vector<std::uint8_t>& rows) const {
    const auto found =
        tiles_.find({static_cast<std::uint16_t>(tile_x), static_cast<std::uint16_t>(tile_y)});
    for (int y = 0; y < kTileSize; ++y) {
      std::uint8_t* pixel =
          &rows[std::size_t{4} * (static_cast<std::size_t>(kTileSize - 1 - y) *
                                      static_cast<std::size_t>(layer_.resolution) +
                                  static_cast<std::size_t>(tile_x) * kTileSize)];
      for (int texel = y * kTileSize; texel < (y + 1) * kTileSize; ++texel, pixel += 4) {
        const bool has_value = found != tiles_.end() && found->second->valid.test(texel);
        const std::uint32_t id = has_value ? id_of(found->second->bits(texel)) : none_;
        for (int channel = 0; channel < 3; ++channel)
          pixel[channel] = static_cast<std::uint8_t>(id >> (8 * channel));
        pixel[3] = 255;
      }
    }
  }

  const Layer& layer_;
  const TileMap& tiles_;
  const query::ValueClasses of_values_;
  std::unordered_map<std::uint32_t, std::uint32_t> ids_;  // by class
  const std::uint32_t none_;
};

std::string text_of(const FeatureValue& value) {
  const auto* text = std::get_if<std::string>(&value);
  return text ? *text : std::string();
}

std::optional<double> number_of(const FeatureValue& value) {
  return std::visit(Overloaded{[](std::int64_t number) -> std::optional<double> {
                                 return static_cast<double>(number);
                               },
                               [](double number) -> std::optional<double> { return number; },
                               [](const auto&) -> std::optional<double> { return std::nullopt; }},
                    value);
}

FeatureProperty::Choices choices_of(const FeatureTable& table, std::size_t field) {
  FeatureProperty::Choices choices{table.fields[field].choices, {}};
  for (const Feature& feature : table.features) {
    const auto choice = std::ranges::find(choices.names, text_of(feature.values[field]));
    choices.values.emplace_back();
    if (choice != choices.names.end())
      choices.values.back() = static_cast<std::uint16_t>(choice - choices.names.begin());
  }
  return choices;
}

FeatureProperty property_of(const FeatureTable& table, std::size_t field) {
  FeatureProperty property{
      table.fields[field].name, {}, table.fields[field].title, table.fields[field].unit};
  if (!table.fields[field].choices.empty()) {
    property.values = choices_of(table, field);
    return property;
  }
  switch (table.fields[field].kind) {
    case FeatureField::Kind::boolean: {
      auto& flags = property.values.emplace<FeatureProperty::Flags>();
      for (const Feature& feature : table.features) {
        const bool* flag = std::get_if<bool>(&feature.values[field]);
        flags.push_back(flag ? std::optional(*flag) : std::nullopt);
      }
      break;
    }
    case FeatureField::Kind::integer:
    case FeatureField::Kind::real: {
      auto& numbers = property.values.emplace<FeatureProperty::Numbers>();
      for (const Feature& feature : table.features)
        numbers.push_back(number_of(feature.values[field]));
      break;
    }
    case FeatureField::Kind::text: {
      auto& texts = property.values.emplace<FeatureProperty::Texts>();
      for (const Feature& feature : table.features) texts.push_back(text_of(feature.values[field]));
      break;
    }
  }
  return property;
}

}  // namespace

IdChannels id_channels(std::uint32_t count) {
  IdChannels channels;
  // One more value than features, for texels without a feature.
  while (count >= 1u << (8 * channels.channels)) ++channels.channels;
  channels.none = (1u << (8 * channels.channels)) - 1;
  return channels;
}

std::uint64_t bytes_to_write_ids(const Layer& layer) {
  // A PNG is hardly larger than its pixels, also if it cannot be compressed.
  constexpr std::uint64_t kPixel = 5;
  const auto side = static_cast<std::uint64_t>(layer.resolution);
  return kPixel * side * side;
}

std::uint64_t bytes_of(const mesh::GlbFeatures& features) {
  constexpr std::uint64_t kCopies = 2;  // the values, and their bytes in the file
  std::uint64_t bytes = features.ids.bytes.size();
  for (const FeatureProperty& property : features.properties)
    bytes += kCopies * mesh::bytes_of(property);
  return bytes;
}

Result<mesh::GlbFeatures> glb_features(const LayerClasses& classes, Progress& progress) {
  const FeatureTable& table = classes.table;
  if (table.features.empty())
    return fail(ErrorCode::invalid, "Layer has no values",
                "The layer '" + classes.areas.view.layer.slug +
                    "' has no values, so there are no features. Choose another layer.",
                "features");
  mesh::GlbFeatures features;
  features.name = classes.areas.view.layer.name;
  features.count = static_cast<std::uint32_t>(table.features.size());
  const IdChannels channels = id_channels(features.count);
  features.channels = channels.channels;
  features.none = channels.none;
  auto ids = STRATA_TRY(IdWriter(classes, features.none).write(progress));
  features.ids = {"image/png", std::move(ids)};
  for (std::size_t field = 0; field < table.fields.size(); ++field)
    features.properties.push_back(property_of(table, field));
  return features;
}

}  // namespace strata::app
