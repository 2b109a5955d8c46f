#include "fuzz/mesh_invariants.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  strata::Progress progress;
  if (const auto loaded = strata::mesh::load_mesh_bytes({data, size}, "fuzz.zip", progress))
    strata::test::check_loaded(*loaded);
  return 0;
}
