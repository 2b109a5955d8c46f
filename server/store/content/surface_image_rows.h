#pragma once

#include "core/digest.h"
#include "domain/scene/surface_image.h"
#include "store/pg/pg.h"

namespace strata::store {

Result<void> check_surface_image(const SurfaceImage& image);
// Inserts one row, with a slug made from the requested slug or the name. `picture` is a blob that
// the current transaction has locked.
Result<SurfaceImage> insert_surface_image(PgConnection& connection, const SurfaceImage& image,
                                          const Sha256& picture);

}  // namespace strata::store
