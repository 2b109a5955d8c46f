#include "app/figures/figure_legend.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "app/figures/record_marks.h"
#include "domain/tables/label_text.h"
#include "room/pictures.h"
#include "room/pipeline/provisional.h"
#include "store/tables/tables.h"

namespace strata::app {
namespace {

// The maximum number of grid cells that are searched for layers. The search takes a few tenths of a
// second.
constexpr double kMaxCells = 250'000;
constexpr std::size_t kMaxPlaces = 32;  // tested points per line
constexpr double kOpaque = 0.99;

query::LayerCover cover_of(const FigureRequest& request, const Layer& layer) {
  const Palette& palette = palette_of(request, layer);
  const double opacity = opacity_of(request, layer);
  query::LayerCover cover;
  cover.tells_values = lists_values(palette);
  if (!palette.column.empty()) {
    // Some of the colors of the records may be transparent.
    cover.of = [opacity](double) {
      return opacity > 0 ? query::Cover::some : query::Cover::nothing;
    };
    return cover;
  }
  const bool hides = layer.blend == LayerBlend::normal;  // hides the layers below
  cover.of = [&palette, opacity, hides](double value) {
    const double alpha = color_of(palette, value)[3] / 255.0 * opacity;
    if (alpha <= 0) return query::Cover::nothing;
    const Palette::Point* point = point_of(palette, value);
    const bool is_solid = !point || point->pattern == Pattern::solid;
    return hides && is_solid && alpha >= kOpaque ? query::Cover::all : query::Cover::some;
  };
  return cover;
}

// Returns the keys of records with lines or points in the drawing. The image shows lines and points
// above all layers.
Result<std::set<double>> marked_keys(store::Store& store, const FigureRequest& request,
                                     const Layer& layer, const Camera& camera) {
  const auto features = STRATA_TRY(features_in(store, request, layer));
  const MarkSight sight(request, camera);
  std::set<double> keys;
  for (const auto& [key, feature, part] : features) {
    const auto value = static_cast<double>(key);
    const double reach = sight.reach_of(feature.places);
    const std::size_t step = std::max<std::size_t>(1, feature.places.size() / kMaxPlaces);
    for (std::size_t i = 0; i < feature.places.size() && !keys.contains(value); i += step) {
      const glm::dvec3& place = feature.places[i];
      if (!sight.part_in_drawing(place, place)) continue;
      const auto seen = STRATA_TRY(sight.sees(place, reach));
      if (seen) keys.insert(value);
    }
  }
  return keys;
}

// A layer with its palette, in all views that show it like this.
struct ListedLayer {
  const FigureRequest* request;  // of the first view
  const Layer* layer;
  const Palette* palette;
  std::set<double> values;  // visible in any of the views
  bool waits = false;       // whether it has unreviewed edits
};

void list_layers(const SeenView& view, std::vector<ListedLayer>& listed) {
  const FigureRequest& request = *view.request;
  for (std::size_t i = request.layers.size(); i-- > 0;) {  // the topmost layer first
    const Layer& layer = request.layers[i];
    // Also true if unreviewed edits only erased texels.
    const bool waits = request.shown.provisional.contains(layer.id);
    if (!view.seen[i].is_seen && !waits) continue;
    const Palette& palette = palette_of(request, layer);
    const auto known = std::ranges::find_if(listed, [&](const ListedLayer& each) {
      return each.layer->id == layer.id && to_json(*each.palette) == to_json(palette);
    });
    ListedLayer& entry = known != listed.end()
                             ? *known
                             : listed.emplace_back(ListedLayer{&request, &layer, &palette, {}});
    entry.values.insert(view.seen[i].values.begin(), view.seen[i].values.end());
    entry.waits |= waits;
  }
}

figure::Legend legend_of(store::Store& store, const ListedLayer& listed) {
  const FigureRequest& request = *listed.request;
  const Layer& layer = *listed.layer;
  const Palette& palette = *listed.palette;
  figure::Legend legend = figure::legend_of(layer, palette, &listed.values, request.language);
  if (listed.waits) {
    const Palette::Point& waiting = room::provisional_palette()->points.front();
    legend.entries.push_back(
        {request.waiting_label, waiting.color, waiting.pattern, waiting.angle, true});
  }
  if (palette.column.empty() || !layer.table) return legend;
  const auto table = store.tables().find(to_string(*layer.table), request.role);
  const Column* column = table ? find_column(table->columns, palette.column) : nullptr;
  if (column)
    legend.title = label_or(layer.labels, request.language, layer.name) + ": " +
                   label_or(column->labels, request.language, column->name) +
                   (column->unit.empty() ? "" : " [" + column->unit + "]");
  return legend;
}

}  // namespace

const Palette& palette_of(const FigureRequest& request, const Layer& layer) {
  const auto& own = request.shown.shown.of(layer.id).palette;
  return own ? *own : layer.palette;
}

double opacity_of(const FigureRequest& request, const Layer& layer) {
  return std::clamp(request.shown.shown.of(layer.id).opacity.value_or(layer.opacity), 0.0, 1.0);
}

std::vector<query::LayerCover> covers_of(const FigureRequest& request) {
  std::vector<query::LayerCover> covers;
  for (const Layer& layer : request.layers) covers.push_back(cover_of(request, layer));
  return covers;
}

Result<std::vector<query::SeenLayer>> layers_in(store::Store& store, const FigureRequest& request,
                                                const figure::Drawing& drawing) {
  if (request.layers.empty()) return std::vector<query::SeenLayer>{};
  const Camera camera = figure::camera_of(drawing);
  const double cells = static_cast<double>(camera.width) * camera.height;
  const double coarser = std::max(1.0, std::sqrt(cells / kMaxCells));
  std::vector<std::string> refs;
  for (const Layer& layer : request.layers) refs.push_back(to_string(layer.id));
  auto seen = STRATA_TRY(request.room->pictures().seen_layers(
      refs, covers_of(request), camera, std::max(1, static_cast<int>(camera.width / coarser)),
      std::max(1, static_cast<int>(camera.height / coarser)), request.shown.at));
  for (std::size_t i = 0; i < seen.size(); ++i) {
    if (!request.layers[i].table) continue;
    const auto marked = STRATA_TRY(marked_keys(store, request, request.layers[i], camera));
    seen[i].is_seen |= !marked.empty();
    seen[i].values.insert(marked.begin(), marked.end());
  }
  return seen;
}

std::vector<figure::Legend> legends_of(store::Store& store, const std::vector<SeenView>& views) {
  std::vector<ListedLayer> listed;
  for (const SeenView& view : views) list_layers(view, listed);
  std::vector<figure::Legend> legends;
  for (const ListedLayer& each : listed) legends.push_back(legend_of(store, each));
  return legends;
}

}  // namespace strata::app
