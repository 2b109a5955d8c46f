#pragma once

#include "core/digest.h"
#include "domain/scene/surface_image.h"
#include "store/pg/pg.h"

namespace strata::store {

Result<void> check_surface_image(const SurfaceImage& image);
// One row, its slug made from the wish or the name; `picture` is a blob that the transaction at
// hand keeps.
Result<SurfaceImage> insert_surface_image(PgConnection& connection, const SurfaceImage& image,
                                          const Sha256& picture);

}  // namespace strata::store
