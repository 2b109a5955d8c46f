// Interpolation of readings: kriging in a plane as a reference, planted fields, seams, thin walls
// and readings that cannot be interpolated.
#include "query/interpolation/interpolate.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <optional>
#include <random>
#include <vector>

#include "core/progress.h"
#include "support/cut_shapes.h"
#include "support/cut_sheet.h"

namespace strata::query {
namespace {

using test::kSheetHeight;
using test::kSheetWidth;
using test::SheetCuts;
using test::Surface;

glm::dvec3 place(const Surface& surface, std::uint32_t texel) {
  return surface.geometry.origin +
         glm::dvec3(surface.map.position(texel / 64, static_cast<int>(texel % 64)));
}

SurfaceValues no_values(const Surface& surface) {
  const std::size_t slots = surface.map.block_of_slot.size();
  return {std::vector<std::uint32_t>(slots * 64), std::vector<std::uint64_t>(slots)};
}

struct Point {
  glm::dvec3 at;
  double value;
};

// Paints a spot around each point. `belongs` returns which texels can belong to the spot.
SurfaceValues spots(
    const Surface& surface, const std::vector<Point>& points, double radius,
    const std::function<bool(const Point&, glm::dvec3)>& belongs = [](const auto&, auto) {
      return true;
    }) {
  SurfaceValues values = no_values(surface);
  test::for_each_surface_texel(surface.map, [&](std::uint32_t texel) {
    const glm::dvec3 at = place(surface, texel);
    for (const Point& point : points)
      if (glm::distance(at, point.at) <= radius && belongs(point, at))
        values.set(texel, {std::bit_cast<std::uint32_t>(static_cast<float>(point.value)), true});
  });
  return values;
}

std::optional<double> number_at(const SurfaceValues& values, std::uint32_t texel) {
  const TexelValue value = values.of(texel);
  if (!value.valid) return std::nullopt;
  return double{std::bit_cast<float>(value.bits)};
}

std::uint32_t nearest_texel(const Surface& surface, glm::dvec3 at) {
  std::uint32_t nearest = 0;
  double least = std::numeric_limits<double>::infinity();
  test::for_each_surface_texel(surface.map, [&](std::uint32_t texel) {
    if (const double distance = glm::distance(place(surface, texel), at); distance < least) {
      least = distance;
      nearest = texel;
    }
  });
  return nearest;
}

Result<SurfaceValues> compute(Interpolated what, const Surface& surface,
                              const SurfaceValues& values, double range, int threads = 2) {
  Progress progress;
  return interpolated_values(what, values, ValueType::f32, range, surface.map, surface.graph, "e",
                             progress, threads);
}

// A sample of a Matérn field with smoothness 1 in the plane, with variance 1, as a sum of waves
// whose frequencies follow its spectrum.
class PlantedField {
 public:
  PlantedField(double range, unsigned seed) : random_(seed) {
    std::uniform_real_distribution<double> uniform(0, 1);
    const double kappa = std::sqrt(8) / range;
    for (int i = 0; i < kWaves; ++i) {
      const double u = uniform(random_), turn = 2 * std::numbers::pi * uniform(random_);
      const double frequency = kappa * std::sqrt(u / (1 - u));
      waves_.push_back({frequency * std::cos(turn), frequency * std::sin(turn),
                        2 * std::numbers::pi * uniform(random_)});
    }
  }
  double at(double x, double y) const {
    double sum = 0;
    for (const glm::dvec3& wave : waves_) sum += std::cos(wave.x * x + wave.y * y + wave.z);
    return sum * std::sqrt(2.0 / kWaves);
  }

 private:
  static constexpr int kWaves = 400;
  std::mt19937 random_;
  std::vector<glm::dvec3> waves_;
};

// Places at texels of the sheet, at least `apart` from each other and `margin` from the border.
std::vector<glm::dvec2> scattered(std::size_t count, double apart, double margin, unsigned seed) {
  std::mt19937 random(seed);
  std::vector<glm::dvec2> places;
  while (places.size() < count) {
    const auto on = [&](int length) {
      return margin +
             std::floor(double(random()) / double(std::mt19937::max()) * (length - 2 * margin)) +
             0.5;
    };
    const double x = on(kSheetWidth), y = on(kSheetHeight);
    if (std::ranges::none_of(places, [&](glm::dvec2 other) {
          return glm::distance(other, glm::dvec2(x, y)) < apart;
        }))
      places.emplace_back(x, y);
  }
  return places;
}

std::vector<Point> planted(const std::vector<glm::dvec2>& places, const PlantedField& field) {
  std::vector<Point> points;
  for (const glm::dvec2 place : places)
    points.push_back({{place, 0}, 12 + 2 * field.at(place.x, place.y)});
  return points;
}

// Kriging on the sheet in plain C++. Nothing flows over the border of the sheet, so it acts as a
// mirror: the covariance is that of the plane, summed over mirror images. It is then divided by the
// standard deviations.
class SheetKriging {
 public:
  SheetKriging(std::vector<Point> points, double range, double noise)
      : points_(std::move(points)), range_(range), inverse_(points_.size()) {
    const std::size_t count = points_.size();
    std::vector<std::vector<double>> matrix(count, std::vector<double>(2 * count, 0));
    for (std::size_t i = 0; i < count; ++i) {
      for (std::size_t j = 0; j < count; ++j)
        matrix[i][j] = covariance(points_[i].at, points_[j].at) + (i == j ? noise : 0);
      matrix[i][count + i] = 1;
    }
    for (std::size_t i = 0; i < count; ++i)  // Gauss and Jordan, of a positive definite matrix
      for (std::size_t j = 0; j < count; ++j) {
        if (i == j) continue;
        const double factor = matrix[j][i] / matrix[i][i];
        for (std::size_t k = 0; k < 2 * count; ++k) matrix[j][k] -= factor * matrix[i][k];
      }
    double ones = 0, weighted = 0;
    for (std::size_t i = 0; i < count; ++i) {
      inverse_[i].resize(count);
      for (std::size_t j = 0; j < count; ++j) {
        inverse_[i][j] = matrix[i][count + j] / matrix[i][i];
        ones += inverse_[i][j];
        weighted += inverse_[i][j] * points_[j].value;
      }
    }
    mean = weighted / ones;
    mean_variance_ = 1 / ones;
    double squares = 0;
    for (std::size_t i = 0; i < count; ++i)
      for (std::size_t j = 0; j < count; ++j)
        squares += (points_[i].value - mean) * inverse_[i][j] * (points_[j].value - mean);
    deviation = std::sqrt(squares / double(count - 1));
  }
  // Returns the expected value and its error.
  std::pair<double, double> at(glm::dvec3 place) const {
    std::vector<double> near;
    for (const Point& point : points_) near.push_back(covariance(point.at, place));
    double value = mean, variance = 1, of_mean = 1;
    for (std::size_t i = 0; i < points_.size(); ++i) {
      double weight = 0;
      for (std::size_t j = 0; j < points_.size(); ++j) weight += inverse_[i][j] * near[j];
      value += weight * (points_[i].value - mean);
      variance -= weight * near[i];
      of_mean -= weight;
    }
    return {value, deviation * std::sqrt(variance + of_mean * of_mean * mean_variance_)};
  }

  double mean = 0, deviation = 0;

 private:
  double covariance(glm::dvec3 a, glm::dvec3 b) const {
    return mirrored(a, b) / std::sqrt(mirrored(a, a) * mirrored(b, b));
  }
  double mirrored(glm::dvec3 a, glm::dvec3 b) const {
    double sum = 0;
    for (int x = -2; x <= 2; ++x)
      for (int y = -2; y <= 2; ++y)
        sum += in_plane(
            glm::distance(a, {x * kSheetWidth + (x % 2 == 0 ? b.x : kSheetWidth - b.x),
                              y * kSheetHeight + (y % 2 == 0 ? b.y : kSheetHeight - b.y), 0}));
    return sum;
  }
  double in_plane(double distance) const {
    const double scaled = std::sqrt(8) * distance / range_;
    return scaled < 1e-9 ? 1 : scaled * std::cyl_bessel_k(1.0, scaled);
  }

  std::vector<Point> points_;
  double range_;
  std::vector<std::vector<double>> inverse_;
  double mean_variance_ = 0;
};

// Differences in units of a standard deviation.
struct Differences {
  double squares = 0, worst = 0;
  int count = 0;
  void add(double difference) {
    squares += difference * difference;
    worst = std::max(worst, std::abs(difference));
    ++count;
  }
  double rms() const { return std::sqrt(squares / count); }
};

TEST(Interpolation, equals_kriging_with_dense_matrices) {
  const Surface sheet = test::cut_sheet();
  for (const double range : {60.0, 90.0}) {
    const auto points = planted(scattered(25, 16, 6, 1), PlantedField(range, 2));
    const SheetKriging expected(points, range, 0.01);
    const auto values = spots(sheet, points, 1);
    const auto means = compute(Interpolated::mean, sheet, values, range),
               errors = compute(Interpolated::error, sheet, values, range);
    ASSERT_TRUE(means && errors);
    Differences mean, error;
    for (double y = 0.5; y < kSheetHeight; y += 7)
      for (double x = 0.5; x < kSheetWidth; x += 7) {
        const std::uint32_t texel = nearest_texel(sheet, {x, y, 0});
        const auto [right_mean, right_error] = expected.at({x, y, 0});
        mean.add((*number_at(*means, texel) - right_mean) / expected.deviation);
        error.add((*number_at(*errors, texel) - right_error) / expected.deviation);
      }
    EXPECT_LT(mean.rms(), 0.02);
    EXPECT_LT(mean.worst, 0.1);
    EXPECT_LT(error.rms(), 0.02);
    EXPECT_LT(error.worst, 0.1);
  }
}

TEST(Interpolation, keeps_readings_and_tends_to_the_mean_far_away) {
  const double range = 40;
  const Surface sheet = test::cut_sheet();
  const std::vector<Point> points{{{30.5, 30.5, 0}, 3},
                                  {{30.5, 90.5, 0}, 5},
                                  {{60.5, 60.5, 0}, 10},
                                  {{90.5, 30.5, 0}, 4},
                                  {{90.5, 90.5, 0}, 8}};
  const SheetKriging expected(points, range, 0.01);
  const auto values = spots(sheet, points, 1);
  const auto means = compute(Interpolated::mean, sheet, values, range),
             errors = compute(Interpolated::error, sheet, values, range);
  ASSERT_TRUE(means && errors);
  for (const Point& point : points) {
    const std::uint32_t texel = nearest_texel(sheet, point.at);
    EXPECT_NEAR(*number_at(*means, texel), point.value, 0.03 * expected.deviation);
    EXPECT_LT(*number_at(*errors, texel), 0.3 * expected.deviation);
  }
  const std::uint32_t far = nearest_texel(sheet, {185, 64, 0});
  EXPECT_NEAR(*number_at(*means, far), expected.mean, 0.02 * expected.deviation);
  EXPECT_GT(*number_at(*errors, far), expected.deviation);
  EXPECT_NEAR(*number_at(*errors, far), expected.at({185, 64, 0}).second,
              0.02 * expected.deviation);
}

TEST(Interpolation, predicts_a_planted_field_within_its_errors) {
  const double range = 120;
  const Surface sheet = test::cut_sheet({{96}, {64}});
  const PlantedField field(range, 5);
  const auto points = planted(scattered(60, 10, 6, 4), field);
  const auto truth = [&](glm::dvec3 at) { return 12 + 2 * field.at(at.x, at.y); };
  const auto predict = [&](const std::vector<Point>& from) {
    const auto values = spots(sheet, from, 1);
    return std::pair(compute(Interpolated::mean, sheet, values, range),
                     compute(Interpolated::error, sheet, values, range));
  };
  {
    const auto [means, errors] = predict(points);
    ASSERT_TRUE(means && errors);
    int texels = 0, within = 0;
    test::for_each_surface_texel(sheet.map, [&](std::uint32_t texel) {
      ++texels;
      within += std::abs(*number_at(*means, texel) - truth(place(sheet, texel))) <=
                2 * *number_at(*errors, texel);
    });
    EXPECT_GT(within, 0.85 * texels);
    EXPECT_LT(within, 0.999 * texels);  // errors are not much too large
  }
  // Leave-one-out.
  double of_prediction = 0, of_plain_mean = 0;
  int left_out = 0, within = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    auto others = points;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(i));
    const auto [means, errors] = predict(others);
    ASSERT_TRUE(means && errors);
    double plain_mean = 0;
    for (const Point& other : others) plain_mean += other.value / double(others.size());
    const std::uint32_t texel = nearest_texel(sheet, points[i].at);
    const double off = *number_at(*means, texel) - points[i].value;
    of_prediction += off * off;
    of_plain_mean += std::pow(plain_mean - points[i].value, 2);
    within += std::abs(off) <= 2 * *number_at(*errors, texel);
    ++left_out;
  }
  EXPECT_GE(within, 0.85 * left_out);
  EXPECT_LT(std::sqrt(of_prediction), 0.5 * std::sqrt(of_plain_mean));
}

TEST(Interpolation, does_not_depend_on_seams_of_a_plane) {
  const double range = 50;
  const auto points = planted(scattered(30, 12, 6, 7), PlantedField(range, 8));
  const double deviation = SheetKriging(points, range, 0.01).deviation;
  std::vector<std::vector<double>> expected;
  for (const SheetCuts& cuts : {SheetCuts{}, SheetCuts{{96}, {64}},
                                SheetCuts{{40, 96, 104, 152}, {24, 64}}, SheetCuts{{96}, {}, 30}}) {
    const Surface sheet = test::cut_sheet(cuts);
    const auto values = spots(sheet, points, 1.6);
    const auto means = compute(Interpolated::mean, sheet, values, range),
               errors = compute(Interpolated::error, sheet, values, range);
    ASSERT_TRUE(means && errors);
    std::vector<std::vector<double>> found(2);
    for (double y = 4.5; y < kSheetHeight; y += 8)
      for (double x = 4.5; x < kSheetWidth; x += 8) {
        const std::uint32_t texel = nearest_texel(sheet, {x, y, 0});
        found[0].push_back(*number_at(*means, texel));
        found[1].push_back(*number_at(*errors, texel));
      }
    if (expected.empty()) expected = found;
    Differences mean, error;
    for (std::size_t i = 0; i < found[0].size(); ++i) {
      mean.add((found[0][i] - expected[0][i]) / deviation);
      error.add((found[1][i] - expected[1][i]) / deviation);
    }
    EXPECT_LT(mean.rms(), 0.02);
    EXPECT_LT(mean.worst, 0.1);
    EXPECT_LT(error.rms(), 0.02);
    EXPECT_LT(error.worst, 0.1);
  }
}

// A cylinder. Its atlas has a seam where s is 0 and 1.
test::Shape cylinder() {
  return {96, 64,
          [](double s, double t) {
            const double turn = 2 * std::numbers::pi * s;
            return glm::dvec3(std::cos(turn), std::sin(turn), 4 * t);
          },
          [](double s, double t) { return glm::dvec2(2 * std::numbers::pi * s, 4 * t); }};
}

TEST(Interpolation, does_not_depend_on_seams_of_a_cylinder) {
  std::vector<Point> points;
  std::mt19937 random(3);
  for (int i = 0; i < 40; ++i) {
    const double s = (i * 0.381966) - std::floor(i * 0.381966), t = (i + 0.5) / 40;
    points.push_back(
        {cylinder().position(s, t), std::sin(4 * std::numbers::pi * s) + 2 * t +
                                        0.2 * double(random()) / double(std::mt19937::max())});
  }
  double plain_mean = 0, squares = 0;
  for (const Point& point : points) plain_mean += point.value / double(points.size());
  for (const Point& point : points) squares += std::pow(point.value - plain_mean, 2);
  const double deviation = std::sqrt(squares / double(points.size()));
  std::vector<double> expected_means, expected_errors;
  for (const test::Cuts cuts : {test::Cuts{1, 1}, test::Cuts{2, 1}, test::Cuts{4, 3}}) {
    const Surface surface = test::cut_surface(cylinder(), cuts, 512);
    const auto values = spots(surface, points, 0.06);
    const auto means = compute(Interpolated::mean, surface, values, 1.5),
               errors = compute(Interpolated::error, surface, values, 1.5);
    ASSERT_TRUE(means && errors);
    std::vector<double> found_means, found_errors;
    for (double t = 0.05; t < 1; t += 0.1)
      for (double s = 0.03; s < 1; s += 0.05) {
        const std::uint32_t texel = nearest_texel(surface, cylinder().position(s, t));
        found_means.push_back(*number_at(*means, texel));
        found_errors.push_back(*number_at(*errors, texel));
      }
    if (expected_means.empty()) {
      expected_means = found_means;
      expected_errors = found_errors;
    }
    Differences mean, error;
    for (std::size_t i = 0; i < found_means.size(); ++i) {
      mean.add((found_means[i] - expected_means[i]) / deviation);
      error.add((found_errors[i] - expected_errors[i]) / deviation);
    }
    EXPECT_LT(mean.rms(), 0.03);
    EXPECT_LT(mean.worst, 0.1);
    EXPECT_LT(error.rms(), 0.03);
    EXPECT_LT(error.worst, 0.1);
  }
}

// A wall of two sides with a rim at s = 0.5, unfolded along s.
constexpr double kHeight = 1, kThickness = 0.02, kLength = 2 * kHeight + kThickness;
test::Shape wall() {
  return {202, 100,
          [](double s, double t) {
            const double along = s * kLength;
            if (along <= kHeight) return glm::dvec3(0, t, along);
            if (along < kHeight + kThickness) return glm::dvec3(along - kHeight, t, kHeight);
            return glm::dvec3(kThickness, t, kLength - along);
          },
          [](double s, double t) { return glm::dvec2(s * kLength, t); }};
}

TEST(Interpolation, does_not_pass_through_a_thin_wall) {
  for (const test::Cuts cuts : {test::Cuts{1, 1, 0, 1}, test::Cuts{5, 3}}) {
    const Surface surface = test::cut_surface(wall(), cuts, 512);
    std::vector<Point> points;
    for (double t = 0.05; t < 1; t += 0.1)
      for (const double z : {0.2, 0.4}) {
        points.push_back({{0, t, z}, 10 + 0.1 * t});
        points.push_back({{kThickness, t, z}, 2 + 0.1 * t});
      }
    const auto values = spots(surface, points, 0.015, [](const Point& point, glm::dvec3 at) {
      return (point.at.x < kThickness / 2) == (at.x < kThickness / 2);
    });
    const auto means = compute(Interpolated::mean, surface, values, 0.6);
    ASSERT_TRUE(means);
    for (double t = 0.1; t < 0.9; t += 0.05)
      for (const double z : {0.15, 0.3, 0.4}) {
        EXPECT_NEAR(*number_at(*means, nearest_texel(surface, {0, t, z})), 10, 0.4);
        EXPECT_NEAR(*number_at(*means, nearest_texel(surface, {kThickness, t, z})), 2, 0.4);
      }
  }
}

// Two squares close to each other.
Surface two_squares() {
  mesh::TriangleMesh squares;
  for (const double z : {0.0, 0.01})
    for (const glm::dvec2 at : {glm::dvec2(0, 0), {1, 0}, {1, 1}, {0, 1}})
      squares.positions.push_back({at, z});
  squares.triangles = {0, 1, 2, 0, 2, 3, 4, 5, 6, 4, 6, 7};
  return test::surface_of("two squares", squares, 256);
}

TEST(Interpolation, gives_no_value_to_pieces_without_a_reading) {
  const Surface surface = two_squares();
  const std::vector<Point> points{
      {{0.2, 0.2, 0}, 1}, {{0.8, 0.3, 0}, 2}, {{0.5, 0.5, 0}, 3}, {{0.3, 0.8, 0}, 4}};
  const auto on_first = [](const Point& point, glm::dvec3 at) {
    return std::abs(point.at.z - at.z) < 0.005;
  };
  const auto values = spots(surface, points, 0.02, on_first);
  for (const Interpolated what : {Interpolated::mean, Interpolated::error}) {
    const auto result = compute(what, surface, values, 0.5);
    ASSERT_TRUE(result);
    test::for_each_surface_texel(surface.map, [&](std::uint32_t texel) {
      ASSERT_EQ(number_at(*result, texel).has_value(), place(surface, texel).z < 0.005);
    });
  }
}

TEST(Interpolation, counts_small_and_large_spots_once) {
  const double range = 60;
  const Surface sheet = test::cut_sheet();
  const auto points = planted(scattered(12, 30, 10, 11), PlantedField(range, 12));
  const double deviation = SheetKriging(points, range, 0.01).deviation;
  const auto small = spots(sheet, points, 1), large = spots(sheet, points, 5);
  for (const Interpolated what : {Interpolated::mean, Interpolated::error}) {
    const auto from_small = compute(what, sheet, small, range),
               from_large = compute(what, sheet, large, range);
    ASSERT_TRUE(from_small && from_large);
    test::for_each_surface_texel(sheet.map, [&](std::uint32_t texel) {
      for (const Point& point : points)
        if (glm::distance(point.at, place(sheet, texel)) < 10) return;
      ASSERT_NEAR(*number_at(*from_small, texel), *number_at(*from_large, texel), 0.1 * deviation);
    });
  }
}

TEST(Interpolation, shows_no_borders_of_cells) {
  const double range = 120;
  const Surface sheet = test::cut_sheet();
  const auto points = planted(scattered(8, 40, 10, 7), PlantedField(range, 8));
  const double deviation = SheetKriging(points, range, 0.01).deviation;
  const auto means = compute(Interpolated::mean, sheet, spots(sheet, points, 1), range);
  ASSERT_TRUE(means);
  std::vector<std::vector<double>> grid(kSheetHeight, std::vector<double>(kSheetWidth));
  test::for_each_surface_texel(sheet.map, [&](std::uint32_t texel) {
    const glm::ivec2 at = test::sheet_place(sheet, texel);
    grid[std::size_t(at.y)][std::size_t(at.x)] = *number_at(*means, texel);
  });
  // At a border of cells, the step from texel to texel would be unlike the steps next to it. The
  // surface is bent at readings only.
  const auto is_near_reading = [&](std::size_t x, std::size_t y) {
    return std::ranges::any_of(points, [&](const Point& point) {
      return glm::distance(point.at, glm::dvec3(x, y, 0)) < 12;
    });
  };
  double largest_step = 0, largest_bend = 0;
  for (std::size_t y = 0; y < grid.size(); ++y)
    for (std::size_t x = 1; x + 1 < grid[y].size(); ++x) {
      if (is_near_reading(x, y)) continue;
      const auto& row = grid[y];
      largest_step = std::max(largest_step, std::abs(row[x] - row[x - 1]));
      largest_bend = std::max(largest_bend, std::abs(row[x - 1] - 2 * row[x] + row[x + 1]));
    }
  EXPECT_GT(largest_step, 0.01 * deviation);
  EXPECT_LT(largest_bend, 0.006 * deviation);
}

TEST(Interpolation, does_not_depend_on_threads) {
  const Surface sheet = test::cut_sheet({{96}, {64}});
  const auto values = spots(sheet, planted(scattered(30, 12, 6, 7), PlantedField(50, 8)), 1.6);
  for (const Interpolated what : {Interpolated::mean, Interpolated::error})
    EXPECT_EQ(compute(what, sheet, values, 50, 1)->bits, compute(what, sheet, values, 50, 4)->bits);
}

TEST(Interpolation, can_be_cancelled_at_any_time) {
  class CancelledLater final : public Progress {
   public:
    explicit CancelledLater(int calls) : calls_(calls) {}
    bool cancelled() const override { return --calls_ < 0; }

   private:
    mutable std::atomic<int> calls_;
  };
  const Surface sheet = test::cut_sheet();
  const auto values = spots(sheet, planted(scattered(30, 12, 6, 7), PlantedField(50, 8)), 1.6);
  int calls = 0;
  for (bool finished = false; !finished; calls = calls * 2 + 1) {
    CancelledLater progress(calls);
    const auto result = interpolated_values(Interpolated::error, values, ValueType::f32, 50,
                                            sheet.map, sheet.graph, "e", progress);
    finished = result.has_value();
    EXPECT_TRUE(finished || result.error().code == ErrorCode::cancelled);
  }
  EXPECT_GT(calls, 40);
}

void expect_refused(const Result<SurfaceValues>& result, const std::string& text) {
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().code, ErrorCode::invalid);
  EXPECT_EQ(result.error().field, "e");
  EXPECT_THAT(result.error().detail, testing::HasSubstr(text));
}

TEST(Interpolation, refuses_readings_and_ranges_that_it_cannot_use) {
  const Surface sheet = test::cut_sheet();
  const auto points = planted(scattered(10, 12, 6, 7), PlantedField(50, 8));
  const auto values = spots(sheet, points, 1);
  const auto mean_of = [&](const SurfaceValues& of, double range) {
    return compute(Interpolated::mean, sheet, of, range);
  };
  for (const double range : {500.0, 1e300, std::numeric_limits<double>::infinity()})
    expect_refused(mean_of(values, range), "or less");
  for (const double range : {-1.0, 0.0, 1e-300, 19.0, std::numeric_limits<double>::quiet_NaN()})
    expect_refused(mean_of(values, range), "or more, which is 20 texels");
  EXPECT_TRUE(mean_of(values, 21));
  EXPECT_TRUE(mean_of(values, 430));
  expect_refused(mean_of(no_values(sheet), 50), "found: 0");
  expect_refused(mean_of(spots(sheet, {points[0]}, 1), 50), "found: 1");
  EXPECT_TRUE(mean_of(spots(sheet, {points[0], points[1], points[2]}, 1), 50));

  SurfaceValues noise = no_values(sheet);
  std::uint32_t number = 0;
  test::for_each_surface_texel(sheet.map, [&](std::uint32_t texel) {
    noise.set(texel, {std::bit_cast<std::uint32_t>(static_cast<float>(++number)), true});
  });
  expect_refused(mean_of(noise, 50), "round");

  auto equal = points;
  for (Point& point : equal) point.value = 5;
  const auto constant = mean_of(spots(sheet, equal, 1), 50);
  ASSERT_TRUE(constant);
  test::for_each_surface_texel(
      sheet.map, [&](std::uint32_t texel) { ASSERT_NEAR(*number_at(*constant, texel), 5, 1e-5); });
  expect_refused(compute(Interpolated::error, sheet, spots(sheet, equal, 1), 50), "same value");
}

TEST(Interpolation, reads_whole_numbers_and_values_at_seams) {
  const Surface sheet = test::cut_sheet({{96}, {64}});
  SurfaceValues values = no_values(sheet);
  // Each spot is on two charts.
  test::for_each_surface_texel(sheet.map, [&](std::uint32_t texel) {
    const glm::ivec2 at = test::sheet_place(sheet, texel);
    if (at.x >= 94 && at.x < 98 && at.y % 24 < 3)
      values.set(texel, {at.y < 40 ? 10u : at.y < 90 ? 20u : 250u, true});
  });
  Progress progress;
  const auto means = interpolated_values(Interpolated::mean, values, ValueType::u8, 30, sheet.map,
                                         sheet.graph, "e", progress);
  ASSERT_TRUE(means);
  EXPECT_NEAR(*number_at(*means, nearest_texel(sheet, {96, 25.5, 0})), 10, 4);
  EXPECT_NEAR(*number_at(*means, nearest_texel(sheet, {96, 73.5, 0})), 20, 4);
  EXPECT_NEAR(*number_at(*means, nearest_texel(sheet, {96, 121.5, 0})), 250, 4);
}

}  // namespace
}  // namespace strata::query
