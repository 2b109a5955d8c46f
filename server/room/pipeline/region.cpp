#include "room/pipeline/region.h"

#include "core/overloaded.h"
#include "core/polygon_area.h"
#include "domain/layers/mask_texels.h"
#include "mesh/texels/slot_bits.h"
#include "query/conditions/flood.h"
#include "room/pipeline/expression_binding.h"
#include "room/pipeline/gpu_problem.h"

namespace strata::room {
namespace {

WrittenValue written_value(bool erase, std::uint32_t bits) {
  return erase ? WrittenValue() : WrittenValue(bits);
}

glm::vec3 position_at(const mesh::SurfaceMap& map, TileAddress tile, int texel) {
  const auto place = mesh::slot_texel(map, tile, texel);
  return map.position(place.slot, place.texel);
}

}  // namespace

Result<PlaceOnSurface> find_place(const Place& place, const mesh::SurfaceMap& map,
                                  SurfaceLookup& surface, const std::string& field) {
  const auto tree = surface.tree();
  const glm::dvec3 origin = surface.geometry().origin;
  const query::SurfacePoint point = std::visit(
      Overloaded{
          [&](const PixelPlace& pixel) {
            return query::pick(*tree, origin, pixel.camera, pixel.x, pixel.y, {});
          },
          [&](const glm::dvec3& world) { return query::nearest_point(*tree, origin, world, {}); }},
      place);
  if (!point.hit)
    return fail(ErrorCode::invalid, "Not on the model",
                "There is no surface at this position. Choose a position on the model.", field);
  if (const auto texel = mesh::surface_texel_at(map, point.uv))
    return PlaceOnSurface{*texel, glm::vec3(point.position - origin)};
  return fail(ErrorCode::invalid, "No texel at position",
              "The piece of the surface at this position is smaller than a texel of this "
              "layer. Choose another position.",
              field);
}

namespace {

// `outline` is either an Outline (its steps are ignored) or a step.
template <class Part>
Result<TileMasks> texels_in_part(const Part& outline, const mesh::SurfaceMap& map,
                                 const SurfaceLookup& surface, render::Renderer& renderer,
                                 render::ModelHandle model) {
  const PolygonArea area({outline.path});
  auto seen = seen_texels(renderer, model, map.resolution, outline.camera, area.low(), area.high(),
                          outline.through);
  if (!seen) return tl::unexpected(gpu_problem(seen.error()));
  const WindowProjection window_of(outline.camera, surface.geometry().origin);
  for (auto& [address, mask] : *seen) {
    TileMask inside;
    for_each_texel(mask, [&](int texel) {
      if (area.contains(window_of(position_at(map, address, texel)))) inside.set(texel);
    });
    mask = inside;
  }
  return seen;
}

}  // namespace

void combine(TileMasks& selected, const TileMasks& other, Combination combination) {
  if (combination == Combination::intersect)
    std::erase_if(selected, [&](const auto& tile) { return !other.contains(tile.first); });
  for (const auto& [address, mask] : other) {
    const auto found = selected.find(address);
    if (found == selected.end()) {
      if (combination == Combination::add) selected.emplace(address, mask);
      continue;
    }
    for (int w = 0; w < kMaskWords; ++w) {
      std::uint64_t& bits = found->second.words[w];
      switch (combination) {
        case Combination::add: bits |= mask.words[w]; break;
        case Combination::subtract: bits &= ~mask.words[w]; break;
        case Combination::intersect: bits &= mask.words[w]; break;
      }
    }
  }
}

Result<TileMasks> texels_in(const Outline& outline, const mesh::SurfaceMap& map,
                            const SurfaceLookup& surface, render::Renderer& renderer,
                            render::ModelHandle model) {
  auto selected = STRATA_TRY(texels_in_part(outline, map, surface, renderer, model));
  for (const Outline::Step& step : outline.steps) {
    const auto part = STRATA_TRY(texels_in_part(step, map, surface, renderer, model));
    combine(selected, part, step.combination);
  }
  return selected;
}

Result<std::vector<TileChange>> fill_changes(const FillEdit& fill, ValueType type,
                                             const RegionContext& context) {
  using Changes = Result<std::vector<TileChange>>;
  const WrittenValue value = written_value(fill.erase, fill.value_bits);
  const auto selected = [&](Result<query::TexelSelection> selection) -> Changes {
    if (!selection) return tl::unexpected(selection.error());
    return fill_selected(context.tiles, type, context.map, std::move(*selection), value);
  };
  const auto flooded = [&](const Place& at, auto flood) -> Changes {
    const auto start = STRATA_TRY(find_place(at, context.map, context.surface, "at"));
    const auto graph = STRATA_TRY(context.surface.graph(context.map));
    return selected(flood(*graph, start.texel));
  };
  return std::visit(
      Overloaded{
          [&](const FillEdit::Everywhere&) -> Changes {
            return fill_everywhere(context.tiles, type, context.map, value);
          },
          [&](const FillEdit::Where& where) -> Changes {
            const auto bound =
                STRATA_TRY(bind_for_layer(where.condition, context.layers, context.store,
                                          context.author, context.visibility, "where"));
            return selected(
                query::select_where(bound.expression, bound.layers, context.map, "where", 2,
                                    {context.surface.geometry().origin, context.metres}));
          },
          [&](const FillEdit::Island& island) {
            return flooded(island.at, [&](const mesh::TexelGraph& graph, std::uint32_t start) {
              return query::select_piece(context.map, graph, start);
            });
          },
          [&](const FillEdit::Connected& connected) {
            return flooded(connected.at, [&](const mesh::TexelGraph& graph, std::uint32_t start) {
              return query::select_connected(context.map, graph, context.tiles, start);
            });
          },
          [&](const FillEdit::Selected& chosen) -> Changes {
            if (chosen.resolution != context.map.resolution)
              return fail(ErrorCode::conflict, "Layer was changed",
                          "The resolution of the layer was changed while the area was selected. "
                          "Select the area again.",
                          "layer");
            return selected(query::TexelSelection(*chosen.texels));
          },
      },
      fill.region);
}

Result<std::vector<TileChange>> polygon_changes(const PolygonEdit& polygon, ValueType type,
                                                const RegionContext& context) {
  const auto inside =
      texels_in(polygon.outline, context.map, context.surface, context.renderer, context.model);
  if (!inside) return tl::unexpected(inside.error());
  return fill_masks(context.tiles, type, context.map, *inside,
                    written_value(polygon.erase, polygon.value_bits));
}

}  // namespace strata::room
