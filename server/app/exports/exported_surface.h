#pragma once

#include <memory>

#include "app/exports/model_export.h"
#include "core/memory_ledger.h"
#include "mesh/surface/geometry.h"

namespace strata::app {

// The surface in a file.
struct ExportedSurface {
  std::shared_ptr<const mesh::Geometry> geometry;
  MemoryLedger::Share memory;  // for a geometry that is not the one of the room
};

// Returns the part of the surface, with the number of triangles that the request requires. Fails
// like `export_model`.
Result<ExportedSurface> exported_surface(const Services& services, const ModelExport& request,
                                         Progress& progress);

}  // namespace strata::app
