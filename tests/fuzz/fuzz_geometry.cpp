#include <cstdlib>
#include <memory>

#include "mesh/search_tree.h"

// Stored geometry comes back from a database that others can write to.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  auto decoded = strata::mesh::decode_geometry({data, size});
  if (!decoded) return 0;
  const auto geometry = std::make_shared<strata::mesh::Geometry>(std::move(*decoded));
  const strata::mesh::SearchTree tree(geometry);
  tree.nearest({0.5f, 0, 0}, 1e6f);
  tree.first_hit({0, 0, 100}, {0.1f, 0.01f, -1});
  const auto again = strata::mesh::decode_geometry(strata::mesh::encode_geometry(*geometry));
  if (!again) std::abort();
  return 0;
}
