#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "core/text/number_text.h"
#include "mesh/index_table.h"
#include "mesh/io/load_formats.h"
#include "mesh/repair/keep_triangles.h"
#include "mesh/repair/manifold.h"
#include "mesh/repair/weld.h"

namespace strata::mesh {
namespace {

constexpr std::uint32_t kNone = 0xffffffffu;
// squares and cubes of larger lengths exceed the range of float
constexpr double kMaxCoordinate = 1e15;
constexpr std::string_view kWelded = "welded vertices";
constexpr double kFarAway = 1e5;  // in multiples of the mesh's size
constexpr double kMinExtent = 1e-12;

std::vector<bool> used_vertices(const TriangleMesh& mesh) {
  std::vector<bool> used(mesh.positions.size(), false);
  for (std::uint32_t index : mesh.triangles) used[index] = true;
  return used;
}

Result<void> check_coordinates(const TriangleMesh& mesh, const std::vector<bool>& used) {
  std::uint64_t not_finite = 0, too_large = 0, first = kNone;
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    if (!used[i]) continue;
    const glm::dvec3& p = mesh.positions[i];
    const bool finite = std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
    const bool large =
        finite && std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}) > kMaxCoordinate;
    if ((!finite || large) && first == kNone) first = i;
    not_finite += !finite;
    too_large += large;
  }
  if (not_finite > 0) {
    return refuse_file(
        std::to_string(not_finite) +
        " vertices that triangles use have a coordinate that is not a finite number (the first is vertex " +
        std::to_string(first) + ", counted from 0). Remove or repair them.");
  }
  if (too_large > 0) {
    return refuse_file(
        std::to_string(too_large) +
        " vertices that triangles use have a coordinate beyond 1e15 (the first is vertex " +
        std::to_string(first) + ", counted from 0). Check the unit of the file.");
  }
  return {};
}

bool has_no_area(const TriangleMesh& mesh, const std::uint32_t* t) {
  const glm::dvec3 &a = mesh.positions[t[0]], &b = mesh.positions[t[1]], &c = mesh.positions[t[2]];
  return glm::cross(b - a, c - a) == glm::dvec3(0);
}

std::array<std::uint32_t, 3> sorted_corners(const std::uint32_t* t) {
  std::array<std::uint32_t, 3> key{t[0], t[1], t[2]};
  if (key[0] > key[1]) std::swap(key[0], key[1]);
  if (key[1] > key[2]) std::swap(key[1], key[2]);
  if (key[0] > key[1]) std::swap(key[0], key[1]);
  return key;
}

// If most triangles have no area because single precision is too coarse, the remaining triangles do
// not show the scanned object.
Result<void> refuse_collapsed(const TriangleMesh& mesh, std::uint64_t without_area,
                              std::uint64_t triangles) {
  if (without_area * 2 <= triangles) return {};
  glm::dvec3 low(INFINITY), high(-INFINITY);
  for (const std::uint32_t index : mesh.triangles) {
    low = glm::min(low, mesh.positions[index]);
    high = glm::max(high, mesh.positions[index]);
  }
  const glm::dvec3 far = glm::max(glm::abs(low), glm::abs(high)), extent = high - low;
  if (std::max({far.x, far.y, far.z}) < kFarAway * std::max({extent.x, extent.y, extent.z}))
    return {};
  return refuse_file(
      std::to_string(without_area) + " of " + std::to_string(triangles) +
      " triangles have no area: the mesh is so far from the origin that its coordinates lost their "
      "precision. Export it with double precision, or near the origin.");
}

// Keeps triangles that have an area and are the first with their three corners, in any winding.
Result<void> drop_triangles(LoadedMesh& loaded) {
  TriangleMesh& mesh = loaded.mesh;
  const std::size_t triangles = mesh.triangle_count();
  IndexTable table(mesh.triangle_count());
  std::uint64_t degenerate = 0, no_area = 0, duplicate = 0;
  std::uint32_t kept_triangles = 0;
  for (std::size_t i = 0; i < mesh.triangle_count(); ++i) {
    const std::uint32_t t[3] = {mesh.triangles[3 * i], mesh.triangles[3 * i + 1],
                                mesh.triangles[3 * i + 2]};
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) {
      ++degenerate;
      continue;
    }
    if (has_no_area(mesh, t)) {
      ++no_area;
      continue;
    }
    const auto key = sorted_corners(t);
    const std::uint64_t hash = mix_hash(mix_hash(mix_hash(0, key[0]), key[1]), key[2]);
    // Writes the triangle to its final position even before it is kept, because the table compares
    // triangles there.
    std::copy(t, t + 3, mesh.triangles.begin() + 3 * std::ptrdiff_t{kept_triangles});
    const std::uint32_t found =
        table.find_or_insert(hash, kept_triangles, [&](std::uint32_t other) {
          return sorted_corners(&mesh.triangles[3 * std::size_t{other}]) == key;
        });
    if (found != kept_triangles) {
      ++duplicate;
      continue;
    }
    move_triangle(mesh, i, kept_triangles++);
  }
  resize_triangles(mesh, kept_triangles);
  if (kept_triangles == 0) return refuse_file("No triangle of the file has an area.");
  STRATA_TRY(refuse_collapsed(mesh, degenerate + no_area, triangles));
  note(loaded.repairs, "dropped degenerate triangles", degenerate);
  note(loaded.repairs, "dropped triangles without area", no_area);
  note(loaded.repairs, "dropped duplicate triangles", duplicate);
  return {};
}

std::uint64_t count_not_finite(const TriangleMesh& mesh) {
  std::uint64_t count = 0;
  for (const glm::dvec3& p : mesh.positions)
    count += !(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z));
  return count;
}

// Moves the used vertices to the front, in their order.
void drop_unused(TriangleMesh& mesh) {
  const std::vector<bool> used = used_vertices(mesh);
  std::vector<std::uint32_t> moved(mesh.positions.size());
  std::uint32_t kept_vertices = 0;
  for (std::size_t i = 0; i < used.size(); ++i) {
    if (!used[i]) continue;
    mesh.positions[kept_vertices] = mesh.positions[i];
    if (!mesh.vertex_colors.empty()) mesh.vertex_colors[kept_vertices] = mesh.vertex_colors[i];
    moved[i] = kept_vertices++;
  }
  mesh.positions.resize(kept_vertices);
  if (!mesh.vertex_colors.empty()) mesh.vertex_colors.resize(kept_vertices);
  for (std::uint32_t& index : mesh.triangles) index = moved[index];
}

}  // namespace

bool is_fault(const Repair& repair) { return !repair.what.starts_with(kWelded); }

Result<void> repair(LoadedMesh& loaded, Progress& progress, const LoadOptions& options) {
  TriangleMesh& mesh = loaded.mesh;
  progress.report(kParsedShare, "Checking coordinates");
  std::uint64_t merged = 0;
  {
    std::vector<bool> used = used_vertices(mesh);
    STRATA_TRY(check_coordinates(mesh, used));
    if (progress.cancelled()) return cancelled_problem();
    progress.report(0.65, "Joining equal vertices");
    merged = weld_equal(mesh, used);
    note(loaded.repairs, std::string(kWelded).append(" at equal positions"), merged);
    if (progress.cancelled()) return cancelled_problem();
    if (options.weld_distance > 0) {
      used = used_vertices(mesh);
      const std::uint64_t near = weld_near(mesh, used, options.weld_distance);
      note(loaded.repairs,
           std::string(kWelded).append(" within ").append(short_number(options.weld_distance)),
           near);
      merged += near;
    }
  }
  if (progress.cancelled()) return cancelled_problem();
  progress.report(0.7, "Dropping degenerate and duplicate triangles");
  STRATA_TRY(drop_triangles(loaded));
  STRATA_TRY(make_manifold(loaded, progress, 0.75, 0.95));
  progress.report(0.95, "Dropping unused vertices");
  // no triangle uses these vertices
  const std::uint64_t not_finite = count_not_finite(mesh), before = mesh.positions.size();
  drop_unused(mesh);
  note(loaded.repairs, "dropped unused vertices",
       before - mesh.positions.size() - merged - not_finite);
  note(loaded.repairs, "dropped unused vertices with coordinates that are no finite numbers",
       not_finite);

  glm::dvec3 low = mesh.positions[0], high = low;
  for (const glm::dvec3& p : mesh.positions) {
    low = glm::min(low, p);
    high = glm::max(high, p);
  }
  const glm::dvec3 extent = high - low;
  if (std::max({extent.x, extent.y, extent.z}) < kMinExtent) {
    return refuse_file("The whole mesh is smaller than 1e-12 units. Check the unit of the file.");
  }
  mesh.positions.shrink_to_fit();
  progress.report(1, "Read");
  return {};
}

}  // namespace strata::mesh
