#include "fuzz/mesh_invariants.h"

// Fuzzes a GLB or glTF file. The input is also the content of the external buffer.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  strata::Progress progress;
  std::vector<strata::mesh::InputFiles::Entry> entries;
  entries.push_back({"fuzz.gltf", {data, size}, std::nullopt});
  entries.push_back({"a.bin", {data, size}, std::nullopt});
  auto files = strata::mesh::InputFiles::of(std::move(entries), "/tmp", progress);
  if (!files) std::abort();
  if (const auto loaded = strata::mesh::load_mesh(std::move(*files), progress))
    strata::test::check_loaded(*loaded);
  return 0;
}
