#include "mesher/reconstruct.h"

#include <open3d/geometry/KDTreeFlann.h>
#include <open3d/geometry/PointCloud.h>
#include <open3d/geometry/TriangleMesh.h>
#include <open3d/t/geometry/RaycastingScene.h>
#include <open3d/t/geometry/TriangleMesh.h>
#include <open3d/utility/Logging.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <thread>

#include "mesher/orient.h"

namespace strata::mesher {
namespace {

using Eigen::Vector3d;
using open3d::geometry::KDTreeFlann;
using open3d::geometry::KDTreeSearchParamKNN;
using open3d::geometry::PointCloud;
using open3d::geometry::TriangleMesh;

constexpr int kNeighbors = 24;  // of a plane through the neighbors of a point
constexpr int kLeastPoints = 50;
constexpr std::size_t kSampled = 20'000;             // points that are measured
constexpr int kLeastDepth = 5, kGreatestDepth = 11;  // the library makes 2^5 cells at least
constexpr double kCellsPerSpacing = 1.5, kGapPerSpacing = 12, kNearPerSpacing = 3;
// The library's box around the points is larger by this factor. A surface ends at the box, so the
// smallest boxes would cut surfaces that close a gap at the end of the points.
constexpr double kBoxScale = 1.2;
// Specks with less than this area, in cells, are left out.
constexpr double kSpeckCells = 60;

PointCloud cloud_of(const Points& points, Vector3d& center) {
  PointCloud cloud;
  cloud.points_.reserve(points.positions.size());
  Vector3d low = Vector3d::Constant(HUGE_VAL), high = -low;
  for (const auto& p : points.positions) {
    const Vector3d at(p[0], p[1], p[2]);
    low = low.cwiseMin(at);
    high = high.cwiseMax(at);
  }
  center = (low + high) / 2;  // the library computes with 32-bit numbers
  for (const auto& p : points.positions) cloud.points_.emplace_back(p[0], p[1], p[2]);
  for (Vector3d& p : cloud.points_) p -= center;
  cloud.colors_.reserve(points.colors.size());
  for (const auto& c : points.colors)
    cloud.colors_.emplace_back(Vector3d(c[0], c[1], c[2]) / 255.0);
  return cloud;
}

double percentile(std::vector<double>& values, double share) {
  if (values.empty()) return 0;
  const auto at = values.begin() + std::ptrdiff_t(share * double(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

// Returns the median distance of points to the next one that is elsewhere.
double spacing_of(const PointCloud& cloud, const KDTreeFlann& tree) {
  const std::size_t step = std::max<std::size_t>(1, cloud.points_.size() / kSampled);
  std::vector<double> distances, squares;
  std::vector<int> found;
  for (std::size_t i = 0; i < cloud.points_.size(); i += step) {
    tree.SearchKNN(cloud.points_[i], 4, found, squares);
    const auto other = std::ranges::find_if(squares, [](double square) { return square > 0; });
    if (other != squares.end()) distances.push_back(std::sqrt(*other));
  }
  return percentile(distances, 0.5);
}

// Takes the normals of the file. Returns false if more than 1 % of them have no direction.
bool take_normals(const Points& points, PointCloud& cloud) {
  if (points.normals.empty()) return false;
  std::size_t bad = 0;
  cloud.normals_.reserve(points.normals.size());
  for (const auto& n : points.normals) {
    Vector3d normal(n[0], n[1], n[2]);
    const double length = normal.norm();
    if (!(length > 1e-6 && length < 1e6)) ++bad;
    cloud.normals_.push_back(length > 1e-6 && length < 1e6 ? Vector3d(normal / length)
                                                           : Vector3d(0, 0, 0));
  }
  if (bad * 100 <= points.normals.size()) return true;
  cloud.normals_.clear();
  return false;
}

// Joins the vertices of each edge whose both ends are marked (union-find). Returns a representative
// of the part of each marked vertex.
std::vector<std::uint32_t> parts_of(const TriangleMesh& mesh, const std::vector<bool>& marked) {
  std::vector<std::uint32_t> parent(mesh.vertices_.size());
  std::iota(parent.begin(), parent.end(), 0U);
  const auto root = [&](std::uint32_t i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
  };
  for (const auto& t : mesh.triangles_)
    for (int k = 0; k < 3; ++k) {
      const auto a = std::uint32_t(t[k]), b = std::uint32_t(t[(k + 1) % 3]);
      if (marked[a] && marked[b]) parent[root(a)] = root(b);
    }
  for (std::uint32_t i = 0; i < parent.size(); ++i) parent[i] = root(i);
  return parent;
}

// Removes the places without points: connected vertices that are farther than `near` from all
// points, if they reach farther than `gap` / 2 from the points, or to the end of the surface, which
// is at the library's box. So narrow gaps are closed, and wide ones end at the points.
void leave_out_places_without_points(TriangleMesh& mesh, const KDTreeFlann& tree, double near,
                                     double gap) {
  std::vector<double> distance(mesh.vertices_.size());
  std::vector<bool> far(mesh.vertices_.size());
  std::vector<int> found;
  std::vector<double> squares;
  for (std::size_t i = 0; i < far.size(); ++i) {
    tree.SearchKNN(mesh.vertices_[i], 1, found, squares);
    distance[i] = std::sqrt(squares[0]);
    far[i] = distance[i] > near;
  }
  const auto part = parts_of(mesh, far);
  std::vector<bool> is_open(far.size());
  for (const auto& edge : mesh.GetNonManifoldEdges(false))  // also those with one triangle
    for (int k = 0; k < 2; ++k)
      if (far[std::size_t(edge[k])]) is_open[part[std::size_t(edge[k])]] = true;
  for (std::size_t i = 0; i < far.size(); ++i)
    if (far[i] && distance[i] > gap / 2) is_open[part[i]] = true;
  for (std::size_t i = 0; i < far.size(); ++i) far[i] = far[i] && is_open[part[i]];
  mesh.RemoveVerticesByMask(far);
}

// Removes small separate pieces, which noise causes.
void remove_specks(TriangleMesh& mesh, double cell) {
  const auto [clusters, counts, areas] = mesh.ClusterConnectedTriangles();
  if (areas.size() < 2) return;
  std::vector<bool> specks(mesh.triangles_.size());
  for (std::size_t i = 0; i < specks.size(); ++i)
    specks[i] = areas[std::size_t(clusters[i])] < kSpeckCells * cell * cell;
  if (std::ranges::find(specks, false) == specks.end()) return;  // they are all that there is
  mesh.RemoveTrianglesByMask(specks);
  mesh.RemoveUnreferencedVertices();
}

// Measures the distances of a sample of the points to the surface.
void measure(const PointCloud& cloud, const TriangleMesh& mesh, mesh::SurfaceFileHeader& facts) {
  using open3d::core::Tensor;
  const std::size_t step = std::max<std::size_t>(1, cloud.points_.size() / kSampled);
  std::vector<float> sample;
  for (std::size_t i = 0; i < cloud.points_.size(); i += step)
    for (int k = 0; k < 3; ++k) sample.push_back(float(cloud.points_[i][k]));
  std::vector<float> corners;
  corners.reserve(mesh.vertices_.size() * 3);
  for (const Vector3d& p : mesh.vertices_)
    for (int k = 0; k < 3; ++k) corners.push_back(float(p[k]));
  std::vector<std::uint32_t> triangles;
  triangles.reserve(mesh.triangles_.size() * 3);
  for (const auto& t : mesh.triangles_)
    for (int k = 0; k < 3; ++k) triangles.push_back(std::uint32_t(t[k]));
  open3d::t::geometry::RaycastingScene scene;
  scene.AddTriangles(
      Tensor(corners, {std::int64_t(corners.size() / 3), 3}, open3d::core::Float32),
      Tensor(triangles, {std::int64_t(triangles.size() / 3), 3}, open3d::core::UInt32));
  const Tensor answer = scene.ComputeDistance(
      Tensor(sample, {std::int64_t(sample.size() / 3), 3}, open3d::core::Float32));
  const auto measured = answer.ToFlatVector<float>();
  std::vector<double> distances(measured.begin(), measured.end());
  facts.distance_median = percentile(distances, 0.5);
  facts.distance_95 = percentile(distances, 0.95);
}

void take(const TriangleMesh& mesh, const Vector3d& center, bool colored, Surface& surface) {
  for (const Vector3d& p : mesh.vertices_)
    surface.positions.push_back({p.x() + center.x(), p.y() + center.y(), p.z() + center.z()});
  for (const auto& t : mesh.triangles_)
    surface.triangles.push_back({std::uint32_t(t[0]), std::uint32_t(t[1]), std::uint32_t(t[2])});
  if (colored)
    for (const Vector3d& c : mesh.vertex_colors_) {
      const auto byte = [](double value) {
        return std::uint8_t(std::lround(std::clamp(value, 0.0, 1.0) * 255));
      };
      surface.colors.push_back({byte(c.x()), byte(c.y()), byte(c.z()), 255});
    }
}

}  // namespace

bool reconstruct(const Points& points, const Settings& settings,
                 const std::function<void(double, const char*)>& report, Surface& surface) {
  open3d::utility::SetVerbosityLevel(open3d::utility::VerbosityLevel::Error);
  if (points.positions.size() < kLeastPoints) return false;
  Vector3d center;
  PointCloud cloud = cloud_of(points, center);
  report(0.02, "Measuring the distances between points");
  const KDTreeFlann tree(cloud);
  mesh::SurfaceFileHeader& facts = surface.facts;
  facts.point_spacing = spacing_of(cloud, tree);
  const double extent = (cloud.GetMaxBound() - cloud.GetMinBound()).maxCoeff() * kBoxScale;
  if (!(facts.point_spacing > 0 && extent > 0)) return false;

  if (!take_normals(points, cloud)) {
    report(0.1, "Estimating the directions of the surface");
    cloud.EstimateNormals(KDTreeSearchParamKNN(kNeighbors), false);
    report(0.25, "Finding the outer side of the surface");
    orient_normals(cloud, tree);
  }

  // The box is divided into 2^depth cells. A length of the user is an upper limit.
  const double divisions =
      settings.cell > 0 ? std::ceil(std::log2(extent / settings.cell))
                        : std::round(std::log2(extent / (kCellsPerSpacing * facts.point_spacing)));
  const int depth = int(std::clamp<double>(divisions, kLeastDepth, kGreatestDepth));
  facts.cell = extent / std::exp2(depth);
  facts.gap = std::max(settings.gap > 0 ? settings.gap : kGapPerSpacing * facts.point_spacing,
                       4 * facts.cell);
  report(0.4, "Creating the surface");
  const int threads = int(std::max(1U, std::thread::hardware_concurrency()));
  auto [mesh, densities] = TriangleMesh::CreateFromPointCloudPoisson(
      cloud, std::size_t(depth), 0, float(kBoxScale), false, threads);
  report(0.85, "Leaving out places without points");
  const double near = std::max(kNearPerSpacing * facts.point_spacing, 2 * facts.cell);
  leave_out_places_without_points(*mesh, tree, near, facts.gap);
  remove_specks(*mesh, facts.cell);
  if (mesh->triangles_.empty()) return false;
  report(0.93, "Measuring the surface");
  measure(cloud, *mesh, facts);
  take(*mesh, center, cloud.HasColors() && mesh->HasVertexColors(), surface);
  facts.vertices = surface.positions.size();
  facts.triangles = surface.triangles.size();
  facts.has_colors = surface.colors.empty() ? 0 : 1;
  return true;
}

}  // namespace strata::mesher
