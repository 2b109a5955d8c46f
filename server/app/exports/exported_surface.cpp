#include "app/exports/exported_surface.h"

#include "mesh/surface/simplify.h"
#include "room/rooms.h"
#include "room/surface.h"

namespace strata::app {

Result<ExportedSurface> exported_surface(const Services& services, const ModelExport& request,
                                         Progress& progress) {
  ExportedSurface surface{request.room->surface().geometry(), {}};
  // The steps of the texture follow from the start, because most files have all triangles.
  progress.begin_stage(0, 0);
  if (request.max_triangles && surface.geometry->triangle_count() > *request.max_triangles) {
    auto memory = STRATA_TRY(services.rooms.memory().reserve(
        mesh::bytes_to_simplify(*surface.geometry), "the reduction of a mesh"));
    surface.geometry = std::make_shared<const mesh::Geometry>(
        STRATA_TRY(mesh::simplify(*surface.geometry, *request.max_triangles, progress)));
    memory.recount(surface.geometry->bytes());
    surface.memory = std::move(memory);
  }
  return surface;
}

}  // namespace strata::app
