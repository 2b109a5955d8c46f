#include "fuzz/mesh_invariants.h"
#include "mesh/surface/geometry.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  strata::Progress progress;
  const auto loaded = strata::mesh::load_mesh_bytes({data, size}, "fuzz.ply", progress);
  if (!loaded) return 0;
  strata::test::check_loaded(*loaded);
  const auto geometry =
      strata::mesh::build_geometry(loaded->mesh, strata::mesh::Atlas{loaded->mesh.corner_uvs, {}});
  if (!strata::mesh::decode_geometry(strata::mesh::encode_geometry(geometry))) std::abort();
  return 0;
}
