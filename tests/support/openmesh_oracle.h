#pragma once

#include <OpenMesh/Core/Mesh/TriConnectivity.hh>
#include <OpenMesh/Core/System/omstream.hh>
#include <array>
#include <cstdint>
#include <vector>

#include "mesh/surface/triangle_mesh.h"

namespace strata::test {

// Builds the mesh with OpenMesh, face by face, so independent code checks the results of
// mesh/repair/manifold. `add_face` accepts a face only if the surface stays a manifold. It refuses
// a third triangle at an edge, two triangles that use an edge in the same direction, and a vertex
// whose triangles would be more than one closed fan. Debian builds OpenMesh with assertions, so
// some faults abort the program, which also fails the test.
struct OpenMeshOracle {
  OpenMesh::TriConnectivity mesh;
  std::vector<std::uint32_t> refused;  // indices of the refused triangles

  explicit OpenMeshOracle(const mesh::TriangleMesh& triangles) {
    for (std::size_t i = 0; i < triangles.positions.size(); ++i) mesh.new_vertex();
    // OpenMesh prints the reason of each refusal to its error stream.
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
