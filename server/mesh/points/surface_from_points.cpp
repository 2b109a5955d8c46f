#include "mesh/points/surface_from_points.h"

#include <unistd.h>

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <numeric>

#include "core/child_process.h"
#include "core/mapped_file.h"
#include "core/temporary_file.h"
#include "core/uuid.h"
#include "mesh/io/load_formats.h"
#include "mesh/points/point_file.h"

namespace strata::mesh {
namespace {

namespace fs = std::filesystem;

// Next to the server's program, where it is built and installed.
fs::path mesher_program() {
  if (const char* named = std::getenv("STRATA_MESHER"); named && *named) return named;
  std::error_code error;
  return fs::read_symlink("/proc/self/exe", error).parent_path() / "strata-mesher";
}

// Half of the memory of the machine.
std::uint64_t memory_limit() {
  return std::uint64_t(sysconf(_SC_PHYS_PAGES)) * std::uint64_t(sysconf(_SC_PAGE_SIZE)) / 2;
}

template <class T>
void write_value(std::ostream& out, const T& value) {
  out.write(reinterpret_cast<const char*>(&value), sizeof value);
}

Result<void> write_points(const fs::path& file, const TriangleMesh& mesh,
                          const std::vector<glm::vec3>& normals,
                          const std::vector<std::uint32_t>& chosen) {
  std::ofstream out(file, std::ios::binary);
  PointFileHeader header;
  header.points = chosen.size();
  header.has_normals = normals.empty() ? 0 : 1;
  header.has_colors = mesh.vertex_colors.empty() ? 0 : 1;
  write_value(out, header);
  for (const auto i : chosen) write_value(out, mesh.positions[i]);
  if (header.has_normals)
    for (const auto i : chosen) write_value(out, normals[i]);
  if (header.has_colors)
    for (const auto i : chosen) write_value(out, mesh.vertex_colors[i]);
  if (!out.flush())
    return fail(ErrorCode::storage_full, "Disk full",
                "The points could not be written to " + file.parent_path().string() + ".");
  return {};
}

// Reads arrays one after another, and refuses a file that is too short.
class Arrays {
 public:
  explicit Arrays(std::span<const std::uint8_t> bytes) : rest_(bytes) {}

  template <class T>
  bool take(std::vector<T>& values, std::uint64_t count) {
    if (count > rest_.size() / sizeof(T)) return false;
    values.resize(count);
    std::memcpy(values.data(), rest_.data(), count * sizeof(T));
    rest_ = rest_.subspan(count * sizeof(T));
    return true;
  }

 private:
  std::span<const std::uint8_t> rest_;
};

Result<SurfaceFromPoints> read_surface(const fs::path& file, TriangleMesh& mesh) {
  const auto damaged = [] {
    return fail(ErrorCode::internal, "Surface not created",
                "The file of strata-mesher is damaged.");
  };
  const auto mapped = MappedFile::open(file);
  if (!mapped) return damaged();
  Arrays arrays(mapped->bytes());
  std::vector<SurfaceFileHeader> headers;
  if (!arrays.take(headers, 1) || headers[0].magic != SurfaceFileHeader::kMagic ||
      headers[0].triangles > kMaxTriangles)
    return damaged();
  const SurfaceFileHeader& header = headers[0];
  if (!arrays.take(mesh.positions, header.vertices)) return damaged();
  if (header.has_colors && !arrays.take(mesh.vertex_colors, header.vertices)) return damaged();
  if (!arrays.take(mesh.triangles, header.triangles * 3)) return damaged();
  if (std::ranges::any_of(mesh.triangles, [&](auto at) { return at >= header.vertices; }))
    return damaged();
  SurfaceFromPoints facts;
  facts.point_spacing = header.point_spacing;
  facts.cell = header.cell;
  facts.gap = header.gap;
  facts.distance_median = header.distance_median;
  facts.distance_95 = header.distance_95;
  return facts;
}

Error advice(MesherExit status, const std::string& last_words) {
  switch (status) {
    case MesherExit::no_surface:
      return {ErrorCode::invalid, "Mesh file refused",
              "The file contains points without triangles, and no surface could be made from "
              "them. They may be too sparse or lie on a line. Create a mesh from them in "
              "another program, such as CloudCompare or MeshLab, and import it.",
              "file"};
    case MesherExit::out_of_memory:
      return {ErrorCode::out_of_memory, "Too many details",
              "The surface of the points needs more than half of the server's memory. Import "
              "them with longer edges (`cell`), or divide the points.",
              "cell"};
    default:
      return {ErrorCode::internal, "Surface not created",
              "The program strata-mesher failed: " +
                  (last_words.empty() ? "it was ended by the system." : last_words)};
  }
}

std::string text_of(double number) {
  char buffer[32];
  const auto end = std::to_chars(buffer, buffer + sizeof buffer, number);
  return {buffer, end.ptr};
}

// Leaves out points that have no place.
void keep_finite(TriangleMesh& mesh, std::vector<glm::vec3>& normals) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    const glm::dvec3& p = mesh.positions[i];
    if (!(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z))) continue;
    mesh.positions[kept] = p;
    if (!normals.empty()) normals[kept] = normals[i];
    if (!mesh.vertex_colors.empty()) mesh.vertex_colors[kept] = mesh.vertex_colors[i];
    ++kept;
  }
  mesh.positions.resize(kept);
  if (!normals.empty()) normals.resize(kept);
  if (!mesh.vertex_colors.empty()) mesh.vertex_colors.resize(kept);
}

}  // namespace

std::vector<std::uint32_t> thinned(const std::vector<glm::dvec3>& positions, std::size_t most) {
  std::vector<std::uint32_t> all(positions.size());
  std::iota(all.begin(), all.end(), 0U);
  if (positions.size() <= most) return all;
  glm::dvec3 low(HUGE_VAL), high(-HUGE_VAL);
  for (const auto& p : positions) low = glm::min(low, p), high = glm::max(high, p);
  const glm::dvec3 size = high - low;
  const double longest = std::max({size.x, size.y, size.z});
  if (!(longest > 0)) return {0};
  // At most 2^21 cells along each axis, so that a key has 63 bits. The first cells have the size
  // for points on the sides of the box.
  const double least = longest / 2e6;
  const double sides = size.x * size.y + size.y * size.z + size.z * size.x;
  double cell = std::max(least, std::sqrt(2 * sides / double(most)));
  std::vector<std::pair<std::uint64_t, std::uint32_t>> keys(positions.size());
  const auto thin = [&] {
    for (std::uint32_t i = 0; i < positions.size(); ++i) {
      const glm::dvec3 at = (positions[i] - low) / cell;
      keys[i] = {std::uint64_t(at.x) << 42 | std::uint64_t(at.y) << 21 | std::uint64_t(at.z), i};
    }
    std::ranges::sort(keys);
    std::vector<std::uint32_t> chosen;
    for (std::size_t k = 0; k < keys.size(); ++k)
      if (k == 0 || keys[k].first != keys[k - 1].first) chosen.push_back(keys[k].second);
    return chosen;
  };
  // The number of occupied cells of a surface is about proportional to 1 / cell².
  std::vector<std::uint32_t> kept = thin();
  for (int round = 0; round < 8; ++round) {
    const double share = double(kept.size()) / double(most);
    if (share <= 1 && (share > 0.7 || cell <= least)) break;
    cell = std::max(least, cell * std::clamp(std::sqrt(share / 0.85), 0.25, 4.0));
    kept = thin();
  }
  for (; kept.size() > most; kept = thin()) cell *= 2;
  std::ranges::sort(kept);
  return kept;
}

Result<SurfaceFromPoints> surface_from_points(TriangleMesh& mesh, std::vector<glm::vec3>& normals,
                                              const PointOptions& options, Progress& progress) {
  const std::size_t in_file = mesh.positions.size();
  keep_finite(mesh, normals);
  if (mesh.positions.size() < kLeastMeshedPoints)
    return refuse_file("The file contains " + std::to_string(in_file) +
                       " vertices but no triangle. A surface can be made from " +
                       std::to_string(kLeastMeshedPoints) +
                       " points or more. Import a mesh, or more points.");
  const fs::path folder = options.folder.empty() ? fs::temp_directory_path() : options.folder;
  const std::string name = to_string(random_uuid());
  const TemporaryFile points(folder / (name + ".points")), surface(folder / (name + ".surface"));
  progress.report(kParsedShare, "Thinning the points");
  const auto chosen = thinned(mesh.positions, kMaxMeshedPoints);
  STRATA_TRY(write_points(points.path, mesh, normals, chosen));
  mesh = {};
  normals = {};

  const auto exit =
      STRATA_TRY(run_child(mesher_program(),
                           {points.path, surface.path, text_of(options.cell), text_of(options.gap),
                            std::to_string(memory_limit())},
                           progress, [&](std::string_view line) {
                             double done = 0;
                             const auto [end, error] =
                                 std::from_chars(line.data(), line.data() + line.size(), done);
                             if (error == std::errc() && end != line.data() + line.size())
                               progress.report(kParsedShare + (1 - kParsedShare) * 0.9 * done,
                                               std::string(end + 1, line.data() + line.size()));
                           }));
  if (exit.status != 0) return tl::unexpected(advice(MesherExit(exit.status), exit.last_words));
  auto facts = STRATA_TRY(read_surface(surface.path, mesh));
  facts.points = in_file;
  facts.used = chosen.size();
  return facts;
}

}  // namespace strata::mesh
