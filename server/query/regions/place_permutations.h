#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "core/progress.h"
#include "query/regions/surface_values.h"

namespace strata::query {

// Places of about equal size that cover a surface. `means` and `areas` are the mean value and the
// area of the place around each texel; only the texels with a bit in `valid` count.
struct EqualPlaces {
  SurfaceValues means, areas;      // f32
  double mean = 0, deviation = 0;  // of the means, weighted by the areas of the texels
  double number = 0;               // of places that fit on the texels
  double area = 0;                 // mean of the areas
  const std::vector<std::uint64_t>* valid = nullptr;
};

// A conditional permutation test (Anselin 1995): the value of a place stays where it is, and the
// values of all other places are shuffled, so its neighbors get random values. All places use the
// same permutations, which a fixed seed determines. Thread-safe once it is constructed.
class PlacePermutations {
 public:
  // `areas` are those of the texels. `neighbors` is the largest number of neighbors of a place.
  // Needs 12 bytes of memory per place. When cancelled, the chances have no meaning.
  PlacePermutations(const EqualPlaces& places, std::span<const float> areas, double neighbors,
                    int permutations, const Progress& progress);

  // Returns the pseudo p-value of a sum of the values of `neighbors` places: the share of the
  // permutations, including the given values, in which the sum is at least as far from its
  // expected value. `neighbors` can have a fraction, for a part of a place. `own` is the value of
  // the place itself. A place with this value, or the nearest value, is not shuffled. Returns 1 if
  // nothing can be shuffled.
  float chance(double sum, double neighbors, double own) const;

 private:
  // An occurrence of a place in a permutation. The first place has the rank 1.
  struct Drawn {
    std::uint32_t place = 0, permutation = 0, rank = 0;
    auto operator<=>(const Drawn&) const = default;
  };
  std::vector<float> values_of_places(const EqualPlaces& places, std::span<const float> areas,
                                      const Progress& progress);
  void draw(const std::vector<float>& values, std::size_t longest, const Progress& progress);
  // Returns the value and the number of the place whose value is nearest to `value`.
  std::pair<float, std::uint32_t> place_with(double value) const;

  // Values are deviations from the mean of the places.
  double mean_ = 0;
  const double number_;
  const std::size_t permutations_;
  std::vector<std::pair<float, std::uint32_t>> by_value_;  // the places, ascending by value
  // Of each permutation: the sums of the values of the first places. The sums of equally many
  // values are next to each other.
  std::vector<float> sums_;
  std::vector<Drawn> drawn_;  // ascending, so those of a place are next to each other
};

}  // namespace strata::query
