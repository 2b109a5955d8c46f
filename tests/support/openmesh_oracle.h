#pragma once

#include <OpenMesh/Core/Mesh/TriConnectivity.hh>
#include <OpenMesh/Core/System/omstream.hh>
#include <array>
#include <cstdint>
#include <vector>

#include "mesh/surface/triangle_mesh.h"

namespace strata::test {

// The mesh as OpenMesh builds it face by face. `add_face` takes a face only where the surface stays
// one: it refuses a third triangle at an edge, two triangles that run along an edge the same way,
// and a vertex whose triangles would be more than one closed fan. So it judges the work of
// mesh/repair/manifold by code that is not ours. Debian builds it with assertions: some faults end
// the program instead, which fails a test as well.
struct OpenMeshOracle {
  OpenMesh::TriConnectivity mesh;
  std::vector<std::uint32_t> refused;  // triangles

  explicit OpenMeshOracle(const mesh::TriangleMesh& triangles) {
    for (std::size_t i = 0; i < triangles.positions.size(); ++i) mesh.new_vertex();
    // It explains each refusal on its error stream.
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
