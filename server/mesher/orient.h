#pragma once

#include <open3d/geometry/KDTreeFlann.h>
#include <open3d/geometry/PointCloud.h>

namespace strata::mesher {

// Turns the normals of a cloud to the same side, along the surface (Hoppe et al. 1992): a spanning
// tree of the graph of neighbors, whose edges prefer parallel normals, passes the side on. Each
// connected part is then turned outward from its middle, or up (+z) if it has no inside, such as
// terrain. Open3D's own function fails for exactly flat and round parts. About 400 bytes per point.
void orient_normals(open3d::geometry::PointCloud& cloud, const open3d::geometry::KDTreeFlann& tree);

}  // namespace strata::mesher
