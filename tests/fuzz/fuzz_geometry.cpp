#include <zstd.h>

#include <cstdlib>
#include <memory>
#include <vector>

#include "mesh/surface/search_tree.h"

// Fuzzes stored geometry, which comes from a database that other programs can write to. The input
// is tried in two ways: unchanged, and as the content of a frame with a correct checksum, because a
// fuzzer cannot guess checksums.
namespace {

void decode_and_use(std::span<const std::uint8_t> bytes) {
  auto decoded = strata::mesh::decode_geometry(bytes);
  if (!decoded) return;
  const auto geometry = std::make_shared<strata::mesh::Geometry>(std::move(*decoded));
  const strata::mesh::SearchTree tree(geometry);
  tree.nearest({0.5f, 0, 0}, 1e6f);
  tree.first_hit({0, 0, 100}, {0.1f, 0.01f, -1});
  if (!strata::mesh::decode_geometry(strata::mesh::encode_geometry(*geometry))) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  decode_and_use({data, size});
  std::vector<std::uint8_t> framed{'S', 'G', 'E', 'O', 1};
  framed.resize(5 + ZSTD_compressBound(size));
  const std::size_t frame = ZSTD_compress(framed.data() + 5, framed.size() - 5, data, size, 1);
  if (ZSTD_isError(frame)) std::abort();
  framed.resize(5 + frame);
  decode_and_use(framed);
  return 0;
}
