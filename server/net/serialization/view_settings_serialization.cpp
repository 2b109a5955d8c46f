#include "net/serialization/view_settings_serialization.h"

#include <algorithm>

#include "domain/layers/layer.h"
#include "expression/expression_parser.h"
#include "protocol/parse.h"
#include "room/layers.h"
#include "room/room.h"
#include "room/surface_images.h"

namespace strata::net {

Result<room::Highlight> highlight_of(const protocol::Highlight& body, const Layer& layer,
                                     const std::string& field) {
  if (!layer.table)
    return fail(ErrorCode::invalid, "Layer has no records",
                "'" + layer.name +
                    "' stores numbers. Only records of a layer of records can be highlighted.",
                field);
  room::Highlight highlight;
  highlight.isolate = body.isolate;
  if (body.filter) {
    auto filter = STRATA_TRY(query::parse_condition(
        *body.filter, field.empty() ? "filter" : field + ".filter", query::Names::columns));
    highlight.records = std::move(filter);
  } else {
    std::vector<std::uint32_t> keys(body.keys->begin(), body.keys->end());
    std::ranges::sort(keys);
    keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
    highlight.records = std::move(keys);
  }
  return highlight;
}

Result<std::vector<room::SurfaceImageView>> surface_image_views(
    const room::Room& room, const std::vector<protocol::LookShown>& requested) {
  std::vector<room::SurfaceImageView> views;
  for (std::size_t i = 0; i < requested.size(); ++i) {
    const std::string field = "looks[" + std::to_string(i) + "].look";
    auto image = room.surface_images().find(protocol::to_ref(requested[i].look));
    if (!image) {
      Error problem = image.error();
      problem.field = field;
      return tl::unexpected(std::move(problem));
    }
    for (const room::SurfaceImageView& other : views)
      if (other.surface_image_id == image->id)
        return fail(ErrorCode::invalid, "Duplicate surface image",
                    "A view can contain each surface image only once.", field);
    views.push_back({image->id, requested[i].opacity});
  }
  return views;
}

Result<Background> background_of(const std::optional<protocol::Background>& requested) {
  if (!requested) return Background{};
  const auto top = parse_color(requested->top, "background.top"),
             bottom = parse_color(requested->bottom, "background.bottom");
  if (!top) return tl::unexpected(top.error());
  if (!bottom) return tl::unexpected(bottom.error());
  return Background{*top, *bottom};
}

Result<room::ViewSettings> view_settings(
    const room::Room& room, const std::vector<protocol::LayerOverride>& layers,
    const std::optional<std::vector<protocol::LookShown>>& images,
    const std::optional<Light>& light) {
  room::ViewSettings settings;
  for (std::size_t i = 0; i < layers.size(); ++i) {
    const protocol::LayerOverride& requested = layers[i];
    const std::string field = "layers[" + std::to_string(i) + "]";
    const auto layer = room.layers().find(protocol::to_ref(requested.layer));
    if (!layer) {
      Error problem = layer.error();
      problem.field = field + ".layer";
      return tl::unexpected(std::move(problem));
    }
    room::LayerView view{layer->id, requested.visible, requested.opacity, std::nullopt,
                         std::nullopt};
    if (requested.palette) {
      auto palette = STRATA_TRY(palette_from_json(*requested.palette, field + ".palette"));
      view.palette = std::move(palette);
    }
    if (requested.highlight) {
      auto highlight = STRATA_TRY(highlight_of(*requested.highlight, *layer, field + ".highlight"));
      view.highlight = std::move(highlight);
    }
    if (requested.order) view.order = static_cast<int>(*requested.order);
    settings.layers.push_back(std::move(view));
  }
  if (images) {
    auto shown = STRATA_TRY(surface_image_views(room, *images));
    settings.images = std::move(shown);
  }
  if (light) settings.light = *light;
  STRATA_TRY(validate(settings.light));
  return settings;
}

}  // namespace strata::net
