#include "query/regions/line_depth.h"

#include <Eigen/Cholesky>
#include <Eigen/Dense>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "core/progress.h"
#include "mesh/texels/texel_graph.h"
#include "query/regions/neighborhood_limits.h"
#include "query/regions/parallel_values.h"
#include "query/regions/texel_discs.h"

namespace strata::query {
namespace {

constexpr int kScales = 3;
constexpr double kReach = 3.5;  // of a Gaussian, in σ

// The parts of σ²·f″ on the center of a line of depth 1 and width 2σ: 2 / √(2πe).
constexpr double kDepthOfLine = 0.48394;

// What the neighborhoods read.
struct Input {
  const mesh::SurfaceMap& map;
  const mesh::TexelGraph& graph;
  std::vector<std::uint64_t> valid;  // finite values
  std::vector<float> numbers;
  std::vector<glm::vec3> positions;

  bool has_value(std::uint32_t texel) const { return (valid[texel / 64] >> texel % 64 & 1u) != 0; }
};

Input read_input(Line line, const SurfaceValues& values, ValueType type,
                 const mesh::SurfaceMap& map, const mesh::TexelGraph& graph) {
  Input input{map, graph, values.valid, std::vector<float>(values.bits.size()),
              std::vector<glm::vec3>(values.bits.size())};
  for (std::uint32_t slot = 0; slot < values.valid.size(); ++slot)
    for (std::uint64_t left = values.valid[slot]; left != 0; left &= left - 1) {
      const int i = std::countr_zero(left);
      const std::size_t texel = std::size_t{slot} * 64 + static_cast<std::size_t>(i);
      const auto number = static_cast<float>(decode_value(type, values.bits[texel]));
      if (!std::isfinite(number)) input.valid[slot] &= ~(std::uint64_t{1} << i);
      input.numbers[texel] = line == Line::valley ? number : -number;
      input.positions[texel] = map.position(slot, i);
    }
  return input;
}

// The texels with a value in a neighborhood, relative to the texel in its middle, as arrays whose
// lengths are multiples of kLanes.
class Neighborhood {
 public:
  static constexpr std::size_t kLanes = 4;
  using Lanes = Eigen::Array<float, kLanes, 1>;

  Neighborhood(const Input& input, double radius)
      : input_(input),
        discs_(input.map, input.graph, radius),
        area_scale_(static_cast<float>(static_cast<double>(input.map.surface_texels) /
                                       input.map.area_total)) {}

  void collect(std::uint32_t texel) {
    middle_ = texel;
    clear();
    if (!discs_.for_each_chord(texel,
                               [&](int row, int x0, int x1) { return add_chord(row, x0, x1); }))
      collect_near_seam();
    // Texels of area 0 do not change the sums.
    while (x.size() % kLanes != 0) add(0, glm::vec3(0), 0);
  }

  std::vector<float> x, y, z, value, area;

 private:
  void clear() {
    for (auto* array : {&x, &y, &z, &value, &area}) array->clear();
  }
  void add(float number, const glm::vec3& at, float of_area) {
    value.push_back(number);
    x.push_back(at.x);
    y.push_back(at.y);
    z.push_back(at.z);
    area.push_back(of_area);
  }
  void add_texel(std::uint32_t texel) {
    if (!input_.has_value(texel)) return;
    add(input_.numbers[texel] - input_.numbers[middle_],
        input_.positions[texel] - input_.positions[middle_], input_.map.area[texel] * area_scale_);
  }

  // Adds the texels x0…x1 of a row. Returns false if they are not all connected along the row.
  bool add_chord(int row, int x0, int x1) {
    const mesh::SurfaceMap& map = input_.map;
    if (row < 0 || x0 < 0 || row >= map.resolution || x1 >= map.resolution) return false;
    std::uint32_t texel = texel_in_atlas(map, x0, row);
    for (int column = x0;; ++column) {
      if (texel == mesh::kNoNeighbour) return false;
      add_texel(texel);
      if (column == x1) return true;
      texel = mesh::neighbour(map, input_.graph, texel, mesh::Way::right);
    }
  }

  void collect_near_seam() {
    clear();
    for (const auto& [slot, bits] : discs_.blocks_around(middle_))
      for (std::uint64_t left = bits; left != 0; left &= left - 1)
        add_texel(slot * 64 + static_cast<std::uint32_t>(std::countr_zero(left)));
  }

  const Input& input_;
  TexelDiscs discs_;
  const float area_scale_;
  std::uint32_t middle_ = 0;
};

// Fits quadratic polynomials to neighborhoods.
class LineFit {
 public:
  LineFit(const Input& input, double width)
      : around_(input, kReach * width / 2), sigma_(width / 2) {}

  std::optional<float> at(std::uint32_t texel) {
    around_.collect(texel);
    const std::size_t count = around_.x.size();
    weight_.resize(count);
    u_.resize(count);
    v_.resize(count);
    weigh();
    project();
    std::optional<double> strongest;
    for (int scale = 0; scale < kScales; ++scale) {
      if (scale > 0) narrow();
      const auto curvature = largest_curvature(std::pow(2.0, 0.5 * scale));
      if (curvature) strongest = std::max(strongest.value_or(0), *curvature);
    }
    if (!strongest) return std::nullopt;
    return static_cast<float>(*strongest / kDepthOfLine);
  }

 private:
  using Lanes = Neighborhood::Lanes;
  static constexpr std::size_t kLanes = Neighborhood::kLanes;
  static Eigen::Map<const Lanes> lanes(const std::vector<float>& array, std::size_t at) {
    return Eigen::Map<const Lanes>(array.data() + at);
  }
  static Eigen::Map<Lanes> lanes(std::vector<float>& array, std::size_t at) {
    return Eigen::Map<Lanes>(array.data() + at);
  }

  // Sets the weights for the largest scale, without the area.
  void weigh() {
    const auto factor = static_cast<float>(-1 / (2 * sigma_ * sigma_));
    for (std::size_t i = 0; i < weight_.size(); i += kLanes) {
      const auto x = lanes(around_.x, i), y = lanes(around_.y, i), z = lanes(around_.z, i);
      lanes(weight_, i) = ((x * x + y * y + z * z) * factor).exp();
    }
  }

  // Turns the weights into those of the next scale, whose σ is smaller by √2.
  void narrow() {
    for (std::size_t i = 0; i < weight_.size(); i += kLanes)
      lanes(weight_, i) = lanes(weight_, i).square();
  }

  // Sets the coordinates in the plane that fits the texels best, in units of σ.
  void project() {
    std::array<double, 10> sums{};  // of 1, x, y, z, xx, xy, xz, yy, yz, zz
    std::array<Lanes, 10> parts;
    parts.fill(Lanes::Zero());
    for (std::size_t i = 0; i < weight_.size(); i += kLanes) {
      const Lanes x = lanes(around_.x, i), y = lanes(around_.y, i), z = lanes(around_.z, i);
      const Lanes w = lanes(weight_, i) * lanes(around_.area, i);
      const Lanes wx = w * x, wy = w * y, wz = w * z;
      parts[0] += w;
      parts[1] += wx;
      parts[2] += wy;
      parts[3] += wz;
      parts[4] += wx * x;
      parts[5] += wx * y;
      parts[6] += wx * z;
      parts[7] += wy * y;
      parts[8] += wy * z;
      parts[9] += wz * z;
    }
    for (std::size_t k = 0; k < sums.size(); ++k) sums[k] = parts[k].cast<double>().sum();
    const Eigen::Vector3d mean = Eigen::Vector3d(sums[1], sums[2], sums[3]) / sums[0];
    Eigen::Matrix3d spread;
    spread << sums[4], sums[5], sums[6], sums[5], sums[7], sums[8], sums[6], sums[8], sums[9];
    spread = spread / sums[0] - mean * mean.transpose();
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes;
    axes.computeDirect(spread);  // ascending, so the first one is the normal
    const Eigen::Vector3f a = (axes.eigenvectors().col(2) / sigma_).cast<float>(),
                          b = (axes.eigenvectors().col(1) / sigma_).cast<float>();
    for (std::size_t i = 0; i < weight_.size(); i += kLanes) {
      const auto x = lanes(around_.x, i), y = lanes(around_.y, i), z = lanes(around_.z, i);
      lanes(u_, i) = x * a.x() + y * a.y() + z * a.z();
      lanes(v_, i) = x * b.x() + y * b.y() + z * b.z();
    }
  }

  // Returns σ² times the largest second derivative at a scale whose σ is smaller by `factor`, or
  // nothing if the texels do not determine it.
  std::optional<double> largest_curvature(double factor) const {
    constexpr int kTerms = 6;    // 1, u, v, uu, uv, vv
    std::array<Lanes, 21> sums;  // of the products of two terms, and of each term and the value
    sums.fill(Lanes::Zero());
    for (std::size_t i = 0; i < weight_.size(); i += kLanes) {
      const Lanes u = lanes(u_, i), v = lanes(v_, i), f = lanes(around_.value, i);
      const Lanes w = lanes(weight_, i) * lanes(around_.area, i);
      const Lanes wu = w * u, wv = w * v, wuu = wu * u, wuv = wu * v, wvv = wv * v;
      const Lanes wuuu = wuu * u, wuuv = wuu * v, wuvv = wuv * v, wvvv = wvv * v;
      sums[0] += w;
      sums[1] += wu;
      sums[2] += wv;
      sums[3] += wuu;
      sums[4] += wuv;
      sums[5] += wvv;
      sums[6] += wuuu;
      sums[7] += wuuv;
      sums[8] += wuvv;
      sums[9] += wvvv;
      sums[10] += wuuu * u;
      sums[11] += wuuu * v;
      sums[12] += wuuv * v;
      sums[13] += wuvv * v;
      sums[14] += wvvv * v;
      sums[15] += w * f;
      sums[16] += wu * f;
      sums[17] += wv * f;
      sums[18] += wuu * f;
      sums[19] += wuv * f;
      sums[20] += wvv * f;
    }
    std::array<double, 21> s{};
    for (std::size_t k = 0; k < s.size(); ++k) s[k] = sums[k].cast<double>().sum();
    if (!(s[0] > 0)) return std::nullopt;
    Eigen::Matrix<double, kTerms, kTerms> products;
    products << s[0], s[1], s[2], s[3], s[4], s[5],  //
        s[1], s[3], s[4], s[6], s[7], s[8],          //
        s[2], s[4], s[5], s[7], s[8], s[9],          //
        s[3], s[6], s[7], s[10], s[11], s[12],       //
        s[4], s[7], s[8], s[11], s[12], s[13],       //
        s[5], s[8], s[9], s[12], s[13], s[14];
    Eigen::Matrix<double, kTerms, 1> right(s.data() + 15), units;
    const double squared = factor * factor;
    units << 1, factor, factor, squared, squared, squared;
    products = units.asDiagonal() * products * units.asDiagonal() / s[0];
    right = units.asDiagonal() * right / s[0];
    const Eigen::LDLT<Eigen::Matrix<double, kTerms, kTerms>> solver(products);
    constexpr double kLeastPivot = 1e-3;  // in a full neighborhood, all are at least 1
    if (!(solver.vectorD().minCoeff() > kLeastPivot)) return std::nullopt;
    const Eigen::Matrix<double, kTerms, 1> fit = solver.solve(right);
    const double uu = fit[3], uv = fit[4], vv = fit[5];
    return uu + vv + std::hypot(uu - vv, uv);
  }

  Neighborhood around_;
  const double sigma_;  // of the largest scale
  std::vector<float> weight_, u_, v_;
};

}  // namespace

Result<SurfaceValues> line_depth_values(Line line, const SurfaceValues& values, ValueType type,
                                        double width, const mesh::SurfaceMap& map,
                                        const mesh::TexelGraph& graph, const std::string& field,
                                        Progress& progress, int threads) {
  if (map.surface_texels == 0) return values;
  STRATA_TRY(check_line_width(width, mean_texel_size(map), field));
  const Input input = read_input(line, values, type, map, graph);
  return compute_values(input.valid, progress, threads, {"Finding lines"},
                        [&] { return LineFit(input, width); });
}

}  // namespace strata::query
