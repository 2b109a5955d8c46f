#pragma once

#include <OpenMesh/Core/Mesh/TriConnectivity.hh>
#include <OpenMesh/Core/System/omstream.hh>
#include <array>
#include <cstdint>
#include <vector>

#include "mesh/surface/triangle_mesh.h"

namespace strata::test {

// Builds the mesh with OpenMesh, face by face. `add_face` accepts a face only if the surface stays
// a manifold: it refuses a third triangle at an edge, two triangles that use an edge in the same
// direction, and a vertex whose triangles would be more than one closed fan. So independent code
// checks the results of mesh/repair/manifold. Debian builds it with assertions: some faults end the
// program instead, which also fails a test.
struct OpenMeshOracle {
  OpenMesh::TriConnectivity mesh;
  std::vector<std::uint32_t> refused;  // triangles

  explicit OpenMeshOracle(const mesh::TriangleMesh& triangles) {
    for (std::size_t i = 0; i < triangles.positions.size(); ++i) mesh.new_vertex();
    // It prints the reason of each refusal on its error stream.
    omerr().disable();
    for (std::uint32_t t = 0; t < triangles.triangle_count(); ++t) {
      std::array<OpenMesh::VertexHandle, 3> corners;
      for (std::size_t k = 0; k < 3; ++k)
        corners[k] =
            OpenMesh::VertexHandle(static_cast<int>(triangles.triangles[3 * std::size_t{t} + k]));
      if (!mesh.add_face(corners[0], corners[1], corners[2]).is_valid()) refused.push_back(t);
    }
    omerr().enable();
  }
};

}  // namespace strata::test
