#pragma once

#include <string>

#include "core/error.h"
#include "mesh/atlas/atlas.h"
#include "mesh/surface/triangle_mesh.h"

namespace strata::test {

struct ScanAtlas {
  mesh::TriangleMesh mesh;
  mesh::Atlas atlas;  // always made here, never the file's own
};

// Returns a real scan of STRATA_TEST_DATA with an atlas made at 2048². It takes seconds to make the
// atlas, so all tests of a process share it.
const Result<ScanAtlas>& scan_with_made_atlas(const std::string& name);

}  // namespace strata::test
