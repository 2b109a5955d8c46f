#pragma once

#include <cstdint>
#include <span>
#include <vector>

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
  PlacePermutations(const EqualPlaces& places, std::span<const float> areas, double neighbors,
                    int permutations);

  // Returns the pseudo p-value of a sum of the values of `neighbors` places: the share of the
  // permutations, including the given values, in which the sum is at least as far from its
  // expected value. `neighbors` can have a fraction, for a part of a place. `own` is the value of
  // the place itself. Returns 1 if nothing can be shuffled.
  float chance(double sum, double neighbors, double own) const;

 private:
  const double mean_, number_;
  std::size_t permutations_;
  // Of each permutation: the sums of the first random values, as deviations from the mean. The
  // sums of equally many values are next to each other.
  std::vector<float> sums_;
};

}  // namespace strata::query
