// Painting from maps and measurements. The tiles depend only on the shape, and not on the content
// of the layer.
#include <glm/gtc/matrix_transform.hpp>

#include "domain/layers/mask_texels.h"
#include "mesh/texels/slot_bits.h"
#include "query/maps/point_splats.h"
#include "room/caches/appearance_cache.h"
#include "room/open/open_surface.h"
#include "room/pipeline/gpu_problem.h"
#include "room/pipeline/seen_texels.h"

namespace strata::room {
namespace {

// Side of the depth buffer that determines the first visible surface.
constexpr int kProjectionSide_px = 4096;

TileMap as_tile_map(std::map<TileAddress, TileData>&& written) {
  TileMap tiles;
  for (auto& [address, tile] : written)
    if (tile.valid.any()) tiles[address] = std::make_shared<const TileData>(std::move(tile));
  return tiles;
}

// Returns a camera without perspective that sees all of the bounding box.
Camera camera_along(const glm::dvec3& direction, const mesh::Geometry& geometry) {
  const glm::dvec3 low = glm::dvec3(geometry.box_min) + geometry.origin,
                   high = glm::dvec3(geometry.box_max) + geometry.origin;
  const glm::dvec3 middle = (low + high) * 0.5;
  const double radius = std::max(glm::length(high - low) / 2, 1e-9);
  const glm::dvec3 up = std::abs(direction.z) < 0.9 ? glm::dvec3(0, 0, 1) : glm::dvec3(0, 1, 0);
  Camera camera;
  camera.view = glm::lookAt(middle - 2 * radius * direction, middle, up);
  camera.projection = glm::ortho(-radius, radius, -radius, radius, 0.5 * radius, 3.5 * radius);
  camera.width = camera.height = kProjectionSide_px;
  return camera;
}

}  // namespace

Result<TileMap> OpenRoom::SurfacePart::point_splats(const Layer& layer,
                                                    const std::vector<PlacedValue>& values,
                                                    double radius, double tolerance) {
  room_.touch();
  const auto map = room_.maps_->wait(layer.resolution);
  if (!map) return tl::unexpected(room_.gpu_problem(map.error()));
  const auto graph = STRATA_TRY(room_.surface_lookup_->graph(**map));
  const auto tree = room_.surface_lookup_->tree();
  std::vector<query::PointSplat> point_splats;
  for (const PlacedValue& value : values) {
    const auto hit = tree->nearest(glm::vec3(value.world - room_.geometry_->origin),
                                   static_cast<float>(tolerance));
    const auto texel = hit ? mesh::surface_texel_at(**map, hit->uv) : std::nullopt;
    if (!texel)
      return fail(ErrorCode::invalid, "Not on the model",
                  "Line " + std::to_string(value.line) +
                      ": the surface is farther away than the tolerance. Check the unit and the " +
                      "coordinates, or increase the tolerance.",
                  "body");
    point_splats.push_back({*texel, hit->position, value.bits});
  }
  auto painted = STRATA_TRY(query::paint_point_splats(**map, *graph, point_splats,
                                                      static_cast<float>(radius), layer.type));
  return as_tile_map(std::move(painted));
}

Result<TileMap> OpenRoom::SurfacePart::project(const Layer& layer, const glm::dvec3& direction,
                                               const ValueAt& value_at) {
  room_.touch();
  const auto map = room_.maps_->wait(layer.resolution);
  if (!map) return tl::unexpected(room_.gpu_problem(map.error()));
  const glm::dvec2 window(kProjectionSide_px);
  const auto seen =
      seen_texels(room_.services_.renderer, room_.model_handle(), layer.resolution,
                  camera_along(direction, *room_.geometry_), glm::dvec2(0), window, false);
  if (!seen) return tl::unexpected(room_.gpu_problem(seen.error()));
  std::map<TileAddress, TileData> written;
  for (const auto& [address, mask] : *seen) {
    TileData tile(layer.type);
    for_each_texel(mask, [&, address = address](int texel) {
      const auto place = mesh::slot_texel(**map, address, texel);
      if (const auto bits = value_at(glm::dvec3((*map)->position(place.slot, place.texel)) +
                                     room_.geometry_->origin))
        tile.write(texel, *bits);
    });
    written.emplace(address, std::move(tile));
  }
  return as_tile_map(std::move(written));
}

Result<std::shared_ptr<const mesh::SurfaceMap>> OpenRoom::SurfacePart::map(int resolution) {
  return room_.surface_map(resolution);
}

Result<std::shared_ptr<const mesh::TexelGraph>> OpenRoom::SurfacePart::graph(int resolution) {
  const auto map = STRATA_TRY(room_.surface_map(resolution));
  return room_.surface_lookup_->graph(*map);
}

Result<std::shared_ptr<const query::TexelAppearance>> OpenRoom::SurfacePart::colors(
    int resolution, std::optional<SurfaceImageId> image_id) {
  const auto map = STRATA_TRY(room_.surface_map(resolution));
  SurfaceImageCache& images = room_.surface_image_cache();
  AppearanceCache::Sources sources;
  if (image_id) {
    const auto image = images.find(to_string(*image_id));
    if (!image)
      return fail(ErrorCode::invalid, "Surface image not found", "The surface image was deleted.",
                  "look");
    sources = {false, {*image}};
    sources.images.front().opacity = 1;  // only its own colors
  } else {
    sources.images = images.all();
    std::erase_if(sources.images,
                  [](const SurfaceImage& image) { return !image.visible || image.opacity <= 0; });
  }
  return room_.appearance_->colors(
      *map, std::move(sources),
      [&](const SurfaceImage& image, int side) { return images.picture(image.id, side); });
}

std::shared_ptr<const mesh::Geometry> OpenRoom::SurfacePart::geometry() const {
  return room_.geometry_;
}

Result<std::shared_ptr<const mesh::FittedSheet>> OpenRoom::SurfacePart::sheet(
    const mesh::FitRequest& request, const std::optional<double>& cut) {
  return room_.surface_lookup_->sheet(request, cut, room_.model().up);
}

std::shared_ptr<const mesh::SearchTree> OpenRoom::SurfacePart::search_tree() {
  return room_.surface_lookup_->tree();
}

}  // namespace strata::room
