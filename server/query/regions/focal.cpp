#include "query/regions/focal.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/progress.h"
#include "mesh/parallel.h"
#include "mesh/texels/texel_graph.h"
#include "query/regions/neighborhood_limits.h"
#include "query/regions/parallel_values.h"
#include "query/regions/place_permutations.h"
#include "query/regions/row_runs.h"
#include "query/regions/texel_discs.h"
#include "query/regions/value_areas.h"

namespace strata::query {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

// Parts of a statistic. Each adds a value with its area, or another part.
struct MeanPart {
  double area = 0, weighted = 0;
  void add(float value, float of_area) {
    area += double{of_area};
    weighted += double{value} * double{of_area};
  }
  void add(const MeanPart& other) {
    area += other.area;
    weighted += other.weighted;
  }
  std::optional<float> result() const {
    if (!(area > 0)) return std::nullopt;
    return static_cast<float>(weighted / area);
  }
};
struct AreaPart {
  double area = 0;
  void add(float, float of_area) { area += double{of_area}; }
  void add(const AreaPart& other) { area += other.area; }
  std::optional<float> result() const {
    return area > 0 ? std::optional(static_cast<float>(area)) : std::nullopt;
  }
};
struct MinPart {
  float least = kInfinity;
  void add(float value, float) { least = std::min(least, value); }
  void add(const MinPart& other) { least = std::min(least, other.least); }
  std::optional<float> result() const {
    return least < kInfinity ? std::optional(least) : std::nullopt;
  }
};
struct MaxPart {
  float greatest = -kInfinity;
  void add(float value, float) { greatest = std::max(greatest, value); }
  void add(const MaxPart& other) { greatest = std::max(greatest, other.greatest); }
  std::optional<float> result() const {
    return greatest > -kInfinity ? std::optional(greatest) : std::nullopt;
  }
};

// What a statistic reads.
struct Input {
  const SurfaceValues& values;
  const RowRuns& rows;
  const mesh::SurfaceMap& map;
  std::vector<float> numbers;  // by texel; empty for variety

  bool has_value(std::uint32_t texel) const {
    return (values.valid[texel / 64] >> texel % 64 & 1u) != 0;
  }
};

// The parts of each block and of its rows of 8 texels. Prefix sums would be faster, but one very
// large value would take the precision of all values to its right.
template <class Part>
class RowParts {
 public:
  explicit RowParts(const Input& input, int threads)
      : input_(input),
        parts_(input.map.block_of_slot.size() * kBlockSize),
        of_block_(input.map.block_of_slot.size()) {
    constexpr std::size_t kSlotsAtOnce = 4096;
    const std::size_t slots = input.map.block_of_slot.size();
    mesh::parallel_for(
        threads, static_cast<int>((slots + kSlotsAtOnce - 1) / kSlotsAtOnce), [&](int number) {
          const std::size_t first = static_cast<std::size_t>(number) * kSlotsAtOnce;
          for (std::size_t slot = first; slot < std::min(slots, first + kSlotsAtOnce); ++slot) {
            for (std::uint32_t i = 0; i < 64; ++i)
              add_texel(static_cast<std::uint32_t>(slot * 64) + i, parts_[slot * 8 + i / 8]);
            for (std::size_t row = slot * 8; row < slot * 8 + 8; ++row)
              of_block_[slot].add(parts_[row]);
          }
        });
  }

  void add_texel(std::uint32_t texel, Part& part) const {
    if (input_.has_value(texel)) part.add(input_.numbers[texel], input_.map.area[texel]);
  }

  // Adds the texels x0…x1 of a row, which are all surface texels.
  void add_chord(int y, int x0, int x1, Part& part) const {
    const auto side = static_cast<std::size_t>(input_.map.blocks_per_side);
    for (int x = x0; x <= x1;) {
      const int end = std::min(x / kBlockSize * kBlockSize + kBlockSize - 1, x1);
      const std::uint32_t slot =
          input_.map.slot_of_block[static_cast<std::size_t>(y / kBlockSize) * side +
                                   static_cast<std::size_t>(x / kBlockSize)];
      const auto row = slot * 8 + static_cast<std::uint32_t>(y % kBlockSize);
      if (end - x == kBlockSize - 1) {
        part.add(parts_[row]);
      } else {
        for (int i = x % kBlockSize; i <= end % kBlockSize; ++i)
          add_texel(row * 8 + static_cast<std::uint32_t>(i), part);
      }
      x = end + 1;
    }
  }

  // Adds the texels of a slot with these bits.
  void add_texels(std::uint32_t slot, std::uint64_t bits, Part& part) const {
    const std::uint64_t valid = input_.values.valid[slot];
    if ((valid & ~bits) == 0) {
      part.add(of_block_[slot]);
      return;
    }
    for (std::uint32_t row = 0; row < 8; ++row) {
      const std::uint64_t of_row = std::uint64_t{0xff} << 8 * row;
      if ((valid & of_row & ~bits) == 0) {
        part.add(parts_[slot * 8 + row]);
        continue;
      }
      for (std::uint64_t left = valid & of_row & bits; left != 0; left &= left - 1)
        add_texel(slot * 64 + static_cast<std::uint32_t>(std::countr_zero(left)), part);
    }
  }

 private:
  const Input& input_;
  std::vector<Part> parts_, of_block_;
};

// Adds the texels of a disc with add_texels(slot, bits) and add_chord(y, x0, x1). `clear` takes
// back what was added.
template <class Chord, class Texels, class Clear>
void add_disc(const Input& input, TexelDiscs& discs, std::uint32_t texel, Chord add_chord,
              Texels add_texels, Clear clear) {
  clear();
  if (discs.for_each_chord(texel, [&](int y, int x0, int x1) {
        if (!input.rows.are_connected(y, x0, x1)) return false;
        add_chord(y, x0, x1);
        return true;
      }))
    return;
  clear();
  for (const auto& [slot, bits] : discs.blocks_around(texel)) add_texels(slot, bits);
}

template <class Part>
class PartDiscs {
 public:
  PartDiscs(const Input& input, const RowParts<Part>& parts, const mesh::TexelGraph& graph,
            double radius)
      : input_(input), parts_(parts), discs_(input.map, graph, radius) {}

  Part part_at(std::uint32_t texel) {
    Part part;
    add_disc(
        input_, discs_, texel, [&](int y, int x0, int x1) { parts_.add_chord(y, x0, x1, part); },
        [&](std::uint32_t slot, std::uint64_t bits) { parts_.add_texels(slot, bits, part); },
        [&] { part = {}; });
    return part;
  }
  std::optional<float> at(std::uint32_t texel) { return part_at(texel).result(); }

 private:
  const Input& input_;
  const RowParts<Part>& parts_;
  TexelDiscs discs_;
};

class VarietyDiscs {
 public:
  VarietyDiscs(const Input& input, const mesh::TexelGraph& graph, double radius)
      : input_(input), discs_(input.map, graph, radius) {}

  std::optional<float> at(std::uint32_t texel) {
    add_disc(
        input_, discs_, texel,
        [&](int y, int x0, int x1) {
          input_.rows.for_each_run(y, x0, x1, [&](const TexelValue& value, std::uint32_t area) {
            if (value.valid) found_.add(value, area);
          });
        },
        [&](std::uint32_t slot, std::uint64_t bits) {
          for (std::uint64_t left = bits & input_.values.valid[slot]; left != 0; left &= left - 1)
            found_.add(
                input_.values.of(slot * 64 + static_cast<std::uint32_t>(std::countr_zero(left))),
                1);
        },
        [&] { found_.clear(); });
    return found_.count() == 0 ? std::nullopt : std::optional(static_cast<float>(found_.count()));
  }

 private:
  const Input& input_;
  TexelDiscs discs_;
  ValueAreas found_;
};

// The part of the reported progress that one pass over all texels has.
struct Share {
  double from = 0, to = 1;
};

template <class MakeDiscs>
Result<SurfaceValues> compute_discs(const Input& input, Progress& progress, int threads,
                                    MakeDiscs make_discs, Share share = {}) {
  return compute_values(input.map.surface_mask, progress, threads,
                        {"Comparing neighborhoods", share.from, share.to}, make_discs);
}

template <class Part>
Result<SurfaceValues> part_values(const Input& input, double radius, const mesh::TexelGraph& graph,
                                  Progress& progress, int threads, Share share = {}) {
  const RowParts<Part> parts(input, threads);
  return compute_discs(
      input, progress, threads, [&] { return PartDiscs<Part>(input, parts, graph, radius); },
      share);
}

class HotSpotDiscs {
 public:
  HotSpotDiscs(const Input& input, const RowParts<MeanPart>& parts, const mesh::TexelGraph& graph,
               double radius, const EqualPlaces& places)
      : discs_(input, parts, graph, radius), places_(places) {}

  std::optional<float> at(std::uint32_t texel) {
    const MeanPart part = discs_.part_at(texel);
    if (!(part.area > 0)) return std::nullopt;
    const double within = part.area / places_.area;
    const double variance = places_.deviation * places_.deviation * (places_.number - within) /
                            (within * (places_.number - 1));
    // Without a deviation, or if all places are within the radius, no place stands out.
    if (!(variance > 0)) return 0.0f;
    return static_cast<float>((part.weighted / part.area - places_.mean) / std::sqrt(variance));
  }

 private:
  PartDiscs<MeanPart> discs_;
  const EqualPlaces& places_;
};

Result<EqualPlaces> measure_places(const Input& input, const RowParts<MeanPart>& parts,
                                   double radius, const mesh::TexelGraph& graph, Progress& progress,
                                   int threads) {
  auto means = STRATA_TRY(
      compute_discs(input, progress, threads,
                    [&] { return PartDiscs<MeanPart>(input, parts, graph, radius); }, {0, 0.15}));
  auto areas =
      STRATA_TRY(part_values<AreaPart>(input, radius, graph, progress, threads, {0.15, 0.3}));
  double area = 0, weighted = 0, squares = 0, place_areas = 0;
  const auto for_each_place = [&](auto visit) {
    for (std::uint32_t texel = 0; texel < means.bits.size(); ++texel)
      if (input.has_value(texel))
        visit(double{input.map.area[texel]}, double{std::bit_cast<float>(means.bits[texel])},
              double{std::bit_cast<float>(areas.bits[texel])});
  };
  for_each_place([&](double of_texel, double mean, double of_place) {
    area += of_texel;
    weighted += of_texel * mean;
    place_areas += of_texel * of_place;
  });
  if (!(area > 0)) return EqualPlaces{};
  const double mean = weighted / area;
  for_each_place([&](double of_texel, double value, double) {
    squares += of_texel * (value - mean) * (value - mean);
  });
  const double of_place = place_areas / area, deviation = std::sqrt(squares / area);
  // Of equal values, only the mean is rounded.
  constexpr double kRounding = 1e-6;
  return EqualPlaces{std::move(means),
                     std::move(areas),
                     mean,
                     deviation > kRounding * std::abs(mean) ? deviation : 0,
                     area / of_place,
                     of_place,
                     &input.values.valid};
}

constexpr double kPlaceRadius = 0.25;  // of the radius of a hot spot

Result<SurfaceValues> hot_spot_values(const Input& input, double radius,
                                      const mesh::TexelGraph& graph, Progress& progress,
                                      int threads) {
  const RowParts<MeanPart> parts(input, threads);
  const EqualPlaces places =
      STRATA_TRY(measure_places(input, parts, kPlaceRadius * radius, graph, progress, threads));
  return compute_discs(input, progress, threads,
                       [&] { return HotSpotDiscs(input, parts, graph, radius, places); }, {0.3, 1});
}

// Returns the means of discs, and keeps their areas.
class MeasuredDiscs {
 public:
  MeasuredDiscs(const Input& input, const RowParts<MeanPart>& parts, const mesh::TexelGraph& graph,
                double radius, std::vector<float>& areas)
      : discs_(input, parts, graph, radius), areas_(areas) {}

  std::optional<float> at(std::uint32_t texel) {
    const MeanPart part = discs_.part_at(texel);
    areas_[texel] = static_cast<float>(part.area);
    return part.result();
  }

 private:
  PartDiscs<MeanPart> discs_;
  std::vector<float>& areas_;
};

// What a permutation test compares at a texel: the part of its disc outside its own place.
struct Neighbors {
  double sum = 0, number = 0, own = 0;
};

class NeighborsAtTexels {
 public:
  NeighborsAtTexels(const EqualPlaces& places, const SurfaceValues& means,
                    const std::vector<float>& areas)
      : places_(places), means_(means), areas_(areas) {}

  Neighbors at(std::uint32_t texel) const {
    // A place can be empty, and smaller than others at an edge.
    const double size = number(places_.areas, texel) / places_.area,
                 within = double{areas_[texel]} / places_.area,
                 own = size > 0 ? number(places_.means, texel) : places_.mean;
    return {within * number(means_, texel) - size * own, within - size, own};
  }

 private:
  static double number(const SurfaceValues& values, std::uint32_t texel) {
    return double{std::bit_cast<float>(values.bits[texel])};
  }

  const EqualPlaces& places_;
  const SurfaceValues& means_;
  const std::vector<float>& areas_;
};

class ChanceAtTexels {
 public:
  ChanceAtTexels(const NeighborsAtTexels& neighbors, const PlacePermutations& permutations)
      : neighbors_(neighbors), permutations_(permutations) {}

  std::optional<float> at(std::uint32_t texel) const {
    const Neighbors found = neighbors_.at(texel);
    return permutations_.chance(found.sum, found.number, found.own);
  }

 private:
  const NeighborsAtTexels& neighbors_;
  const PlacePermutations& permutations_;
};

std::vector<float> decoded(const SurfaceValues& values, ValueType type) {
  std::vector<float> numbers(values.bits.size());
  for (std::size_t i = 0; i < numbers.size(); ++i)
    numbers[i] = static_cast<float>(decode_value(type, values.bits[i]));
  return numbers;
}

}  // namespace

Result<SurfaceValues> focal_values(Focal statistic, const SurfaceValues& values, ValueType type,
                                   double radius, const mesh::SurfaceMap& map,
                                   const mesh::TexelGraph& graph, const std::string& field,
                                   Progress& progress, int threads) {
  if (map.surface_texels == 0) return values;
  STRATA_TRY(check_focal_radius(radius, mean_texel_size(map), field));
  const RowRuns rows(values, map, graph, progress, threads);
  Input input{values, rows, map, {}};
  if (statistic != Focal::variety) input.numbers = decoded(values, type);
  switch (statistic) {
    case Focal::mean: return part_values<MeanPart>(input, radius, graph, progress, threads);
    case Focal::min: return part_values<MinPart>(input, radius, graph, progress, threads);
    case Focal::max: return part_values<MaxPart>(input, radius, graph, progress, threads);
    case Focal::hot_spot: return hot_spot_values(input, radius, graph, progress, threads);
    case Focal::variety: break;
  }
  return compute_discs(input, progress, threads,
                       [&] { return VarietyDiscs(input, graph, radius); });
}

Result<SurfaceValues> hot_spot_chances(const SurfaceValues& values, ValueType type, double radius,
                                       int permutations, const mesh::SurfaceMap& map,
                                       const mesh::TexelGraph& graph, const std::string& field,
                                       Progress& progress, int threads) {
  if (map.surface_texels == 0) return values;
  STRATA_TRY(check_focal_radius(radius, mean_texel_size(map), field));
  const RowRuns rows(values, map, graph, progress, threads);
  const Input input{values, rows, map, decoded(values, type)};
  const RowParts<MeanPart> parts(input, threads);
  const EqualPlaces places =
      STRATA_TRY(measure_places(input, parts, kPlaceRadius * radius, graph, progress, threads));
  std::vector<float> areas(values.bits.size());
  const SurfaceValues means = STRATA_TRY(
      compute_discs(input, progress, threads,
                    [&] { return MeasuredDiscs(input, parts, graph, radius, areas); }, {0.3, 0.8}));
  const NeighborsAtTexels neighbors(places, means, areas);
  double most = 0;
  for (std::uint32_t texel = 0; texel < areas.size(); ++texel)
    if (means.of(texel).valid) most = std::max(most, neighbors.at(texel).number);
  const PlacePermutations shuffled(places, map.area, most, permutations, progress);
  return compute_values(means.valid, progress, threads, {"Comparing permutations", 0.8, 1},
                        [&] { return ChanceAtTexels(neighbors, shuffled); });
}

}  // namespace strata::query
