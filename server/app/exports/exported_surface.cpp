#include "app/exports/exported_surface.h"

#include <algorithm>
#include <utility>

#include "app/cancellable.h"
#include "mesh/surface/simplify.h"
#include "query/regions/selected_triangles.h"
#include "room/queries.h"
#include "room/rooms.h"
#include "room/surface.h"

namespace strata::app {
namespace {

// Replaces the geometry by the one that `make` returns, which needs `bytes` of memory.
template <class Make>
Result<void> replace_geometry(ExportedSurface& surface, const Services& services,
                              std::uint64_t bytes, const Make& make) {
  auto memory = STRATA_TRY(services.rooms.memory().reserve(bytes, "the mesh of a file"));
  auto geometry = STRATA_TRY(make(*surface.geometry));
  surface.geometry = std::make_shared<const mesh::Geometry>(std::move(geometry));
  memory.recount(surface.geometry->bytes());
  surface.memory = std::move(memory);
  return {};
}

Result<mesh::Geometry> selected_part(const mesh::Geometry& geometry,
                                     const room::SelectedArea::Texels& selected,
                                     Progress& progress) {
  const auto indices = STRATA_TRY(
      query::selected_triangles(geometry, selected.resolution, selected.texels, progress));
  return mesh::with_triangles(geometry, indices);
}

}  // namespace

Result<ExportedSurface> exported_surface(const Services& services, const ModelExport& request,
                                         Progress& progress) {
  ExportedSurface surface{request.room->surface().geometry(), {}};
  // The steps of the texture follow from the start, because most files have the whole surface.
  progress.begin_stage(0, 0);
  if (request.within) {
    progress.report(0, "Selecting the part");
    const auto selected = STRATA_TRY(cancellable(
        progress, [&] { return request.room->queries().selected_texels(*request.within); }));
    if (std::ranges::all_of(selected.texels, [](std::uint64_t slot) { return slot == 0; }))
      return fail(ErrorCode::invalid, "Nothing is selected",
                  "No surface is in this part of the model, so the file would be empty. Choose "
                  "another part.",
                  "within");
    const std::uint64_t bytes =
        query::bytes_to_select_triangles(*surface.geometry, selected.resolution) +
        surface.geometry->bytes();
    STRATA_TRY(replace_geometry(surface, services, bytes, [&](const mesh::Geometry& geometry) {
      return selected_part(geometry, selected, progress);
    }));
  }
  if (request.max_triangles && surface.geometry->triangle_count() > *request.max_triangles)
    STRATA_TRY(replace_geometry(surface, services, mesh::bytes_to_simplify(*surface.geometry),
                                [&](const mesh::Geometry& geometry) {
                                  return mesh::simplify(geometry, *request.max_triangles, progress);
                                }));
  return surface;
}

}  // namespace strata::app
