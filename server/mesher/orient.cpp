#include "mesher/orient.h"

#include <algorithm>
#include <cmath>
#include <queue>
#include <thread>
#include <vector>

namespace strata::mesher {
namespace {

using Eigen::Vector3d;
using open3d::geometry::KDTreeFlann;
using open3d::geometry::PointCloud;

constexpr int kNeighbors = 10;

// The neighbors of all points, in both directions: those of point i are at[begin[i]…begin[i + 1]].
struct Graph {
  std::vector<std::uint64_t> begin;
  std::vector<std::uint32_t> at;
};

std::vector<std::uint32_t> nearest(const PointCloud& cloud, const KDTreeFlann& tree) {
  const std::size_t count = cloud.points_.size();
  std::vector<std::uint32_t> found(count * kNeighbors);
  const std::size_t threads = std::max(1U, std::thread::hardware_concurrency());
  std::vector<std::jthread> workers;
  for (std::size_t worker = 0; worker < threads; ++worker)
    workers.emplace_back([&, worker] {
      std::vector<int> indices;
      std::vector<double> squares;
      for (std::size_t i = worker; i < count; i += threads) {
        tree.SearchKNN(cloud.points_[i], kNeighbors, indices, squares);
        for (int k = 0; k < kNeighbors; ++k)  // a point that lacks neighbors is its own
          found[i * kNeighbors + k] =
              k < int(indices.size()) ? std::uint32_t(indices[k]) : std::uint32_t(i);
      }
    });
  workers.clear();  // waits
  return found;
}

Graph graph_of(const PointCloud& cloud, const KDTreeFlann& tree) {
  const std::size_t count = cloud.points_.size();
  const auto found = nearest(cloud, tree);
  Graph graph;
  graph.begin.assign(count + 1, 0);
  for (std::size_t e = 0; e < found.size(); ++e) {
    ++graph.begin[e / kNeighbors + 1];
    ++graph.begin[found[e] + 1];
  }
  for (std::size_t i = 0; i < count; ++i) graph.begin[i + 1] += graph.begin[i];
  graph.at.resize(graph.begin[count]);
  std::vector<std::uint64_t> next(graph.begin.begin(), graph.begin.end() - 1);
  for (std::size_t e = 0; e < found.size(); ++e) {
    graph.at[next[e / kNeighbors]++] = found[e];
    graph.at[next[found[e]]++] = std::uint32_t(e / kNeighbors);
  }
  return graph;
}

void turn_outward(PointCloud& cloud, const std::vector<std::uint32_t>& part) {
  Vector3d middle = Vector3d::Zero();
  for (const auto i : part) middle += cloud.points_[i];
  middle /= double(part.size());
  double outward = 0, reach = 0, up = 0;
  for (const auto i : part) {
    const Vector3d arm = cloud.points_[i] - middle;
    outward += cloud.normals_[i].dot(arm);
    reach += arm.norm();
    up += cloud.normals_[i].z();
  }
  const bool flat = std::abs(outward) < 0.1 * reach;
  if ((flat ? up : outward) < 0)
    for (const auto i : part) cloud.normals_[i] = -cloud.normals_[i];
}

}  // namespace

void orient_normals(PointCloud& cloud, const KDTreeFlann& tree) {
  const Graph graph = graph_of(cloud, tree);
  struct Step {
    float cost;
    std::uint32_t from, to;
    bool operator<(const Step& other) const { return cost > other.cost; }  // the cheapest first
  };
  std::vector<bool> done(cloud.points_.size());
  std::priority_queue<Step> steps;
  std::vector<std::uint32_t> part;
  const auto visit = [&](std::uint32_t point) {
    done[point] = true;
    part.push_back(point);
    for (auto e = graph.begin[point]; e < graph.begin[point + 1]; ++e) {
      const std::uint32_t other = graph.at[e];
      if (done[other]) continue;
      const double parallel = std::abs(cloud.normals_[point].dot(cloud.normals_[other]));
      steps.push({float(1 - parallel), point, other});
    }
  };
  for (std::uint32_t first = 0; first < done.size(); ++first) {
    if (done[first]) continue;
    part.clear();
    visit(first);
    while (!steps.empty()) {
      const Step step = steps.top();
      steps.pop();
      if (done[step.to]) continue;
      if (cloud.normals_[step.from].dot(cloud.normals_[step.to]) < 0)
        cloud.normals_[step.to] = -cloud.normals_[step.to];
      visit(step.to);
    }
    turn_outward(cloud, part);
  }
}

}  // namespace strata::mesher
