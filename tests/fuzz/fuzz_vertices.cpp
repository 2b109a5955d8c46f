// Fuzzes numbers of vertices: the properties of a PLY, and CSV with a line for each vertex. The
// first byte selects which of the two files of a CSV import is the input.
#include <cstdint>
#include <cstdlib>
#include <span>
#include <string_view>

#include "core/progress.h"
#include "mesh/io/vertex_properties.h"

namespace {

using namespace strata;

constexpr std::size_t kMaxRead = 4;  // properties; more of them only take longer
constexpr std::string_view kScan = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
constexpr std::string_view kNumbers = "quality\n1\nnan\n3.5\n";

void demand(bool holds) {
  if (!holds) std::abort();
}

void check(const Result<mesh::VertexProperty>& property) {
  if (!property) {
    demand(!is_server_failure(property.error().code));
    return;
  }
  demand(property->positions.size() == property->values.size());
}

std::span<const std::uint8_t> bytes_of(std::string_view text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::string_view text(reinterpret_cast<const char*>(data + 1), size - 1);
  Progress progress;
  if (data[0] % 2 == 0) {
    check(mesh::read_vertex_csv(bytes_of(kScan), "scan.obj", text, progress));
    return 0;
  }
  const auto names = mesh::vertex_property_names(bytes_of(text));
  for (std::size_t i = 0; i < names.size() && i < kMaxRead; ++i)
    check(mesh::read_vertex_property(bytes_of(text), names[i]));
  check(mesh::read_vertex_csv(bytes_of(text), "scan.ply", kNumbers, progress));
  check(mesh::read_vertex_csv(bytes_of(text), "scan.obj", kNumbers, progress));
  return 0;
}
