#include "app/exports/model_export.h"

#include <algorithm>
#include <bit>

#include "app/cancellable.h"
#include "app/exports/exported_surface.h"
#include "app/exports/feature_ids.h"
#include "app/layers/drawn_layers.h"
#include "app/layers/layer_features.h"
#include "core/memory_ledger.h"
#include "core/uuid.h"
#include "domain/scene/model.h"
#include "media/picture_writer.h"
#include "mesh/io/gltf/write_glb.h"
#include "mesh/io/write_obj.h"
#include "query/sampling/baked_colors.h"
#include "room/caches/surface_image_cache.h"
#include "room/rooms.h"
#include "room/surface.h"
#include "room/surface_images.h"

namespace strata::app {
namespace {

constexpr JpegSettings kTexture{92, true};
// The stages of the task after query::kBaked.
constexpr double kEncoded = 0.85, kIdsWritten = 0.9;

// Encodes the texture in pieces, so that a job can be cancelled.
Result<mesh::SceneImage> encode(const Picture& picture, PictureFormat format, Progress& progress) {
  constexpr int kRows = 64;
  PictureWriter writer(format, picture.width, picture.height, kTexture);
  const auto row_bytes = std::size_t{4} * static_cast<std::size_t>(picture.width);
  for (int y = 0; y < picture.height; y += kRows) {
    if (progress.cancelled()) return cancelled_problem();
    progress.report(static_cast<double>(y) / picture.height, "Writing the texture");
    const auto rows = static_cast<std::size_t>(std::min(kRows, picture.height - y));
    writer.put({picture.rgba.data() + row_bytes * static_cast<std::size_t>(y), row_bytes * rows});
  }
  return mesh::SceneImage{std::string(media_type(format)), writer.finish()};
}

// A part of the file with its memory, until the file is written.
template <class Content>
struct Held {
  Content content;
  MemoryLedger::Share memory;
};

Result<Held<mesh::SceneImage>> make_texture(const Services& services, const ModelExport& request,
                                            Progress& progress) {
  const int size = request.texture_size ? *request.texture_size : default_texture_size(request);
  const auto geometry = request.room->surface().geometry();
  auto memory = STRATA_TRY(services.rooms.memory().reserve(query::bytes_to_bake(*geometry, size),
                                                           "the texture of a model"));
  Picture picture;
  {
    const ComposedSurface surface = STRATA_TRY(compose_surface(
        services, *request.room, request.role, request.layers, request.shown, request.at, size));
    auto baked = STRATA_TRY(query::bake_colors(*geometry, surface.colors, size, progress));
    picture = std::move(baked);
  }
  progress.begin_stage(query::kBaked, kEncoded);
  auto image = STRATA_TRY(encode(picture, request.texture_format, progress));
  memory.recount(image.bytes.size());
  return Held<mesh::SceneImage>{std::move(image), std::move(memory)};
}

Result<Held<mesh::GlbFeatures>> make_features(const Services& services, const ModelExport& request,
                                              Progress& progress) {
  progress.report(0, "Reading the features");
  auto memory = STRATA_TRY(services.rooms.memory().reserve(bytes_to_write_ids(*request.features),
                                                           "the features of a model"));
  const auto classes = STRATA_TRY(cancellable(progress, [&] {
    return layer_classes(
        services.store,
        {request.room, *request.features, request.at, {}, request.role, request.language});
  }));
  auto features = STRATA_TRY(glb_features(classes, progress));
  memory.recount(bytes_of(features));
  return Held<mesh::GlbFeatures>{std::move(features), std::move(memory)};
}

}  // namespace

int default_texture_size(const ModelExport& request) {
  constexpr unsigned kMin = 1024, kMax = 4096;
  unsigned side = kMin;
  for (const Layer& layer : request.layers)
    side = std::max(side, static_cast<unsigned>(layer.resolution));
  const std::vector<SurfaceImage> images = request.room->surface_images().all();
  for (const auto& shown : request.shown.images.value_or(room::surface_images_shown(images)))
    for (const SurfaceImage& image : images)
      if (image.id == shown.surface_image_id)
        side = std::max(side, static_cast<unsigned>(std::max(image.width, image.height)));
  return static_cast<int>(std::bit_ceil(std::min(side, kMax)));
}

Result<std::shared_ptr<const TemporaryFile>> export_model(const Services& services,
                                                          const ModelExport& request,
                                                          const std::filesystem::path& folder,
                                                          Progress& progress) {
  const Model description = request.room->model();
  mesh::GlbModel model;
  model.name = description.name;
  model.copyright = description.credit;
  const ExportedSurface surface = STRATA_TRY(exported_surface(services, request, progress));
  model.geometry = surface.geometry;
  model.metres_per_unit = description.metres();
  model.up = description.up;
  model.unlit = request.unlit;
  const bool is_glb = request.format == ModelFileFormat::glb;
  if (is_glb) STRATA_TRY(mesh::check_glb_size(*model.geometry));  // before the long work
  auto texture = STRATA_TRY(make_texture(services, request, progress));
  model.color = std::move(texture.content);
  progress.begin_stage(kEncoded, kIdsWritten);
  MemoryLedger::Share of_features;
  if (request.features) {
    auto features = STRATA_TRY(make_features(services, request, progress));
    model.features = std::move(features.content);
    of_features = std::move(features.memory);
  }
  progress.begin_stage(kIdsWritten, 1);
  auto file = std::make_shared<TemporaryFile>(folder / (to_string(random_uuid()) + ".model"));
  file->triangles = model.geometry->triangle_count();
  file->name = description.slug + (is_glb ? ".glb" : ".zip");
  file->media_type = is_glb ? "model/gltf-binary" : "application/zip";
  file->bytes = STRATA_TRY(is_glb ? mesh::write_glb(model, file->path, progress)
                                  : mesh::write_obj(model, description.slug, file->path, progress));
  return file;
}

}  // namespace strata::app
