#pragma once

#include <algorithm>
#include <atomic>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/progress.h"
#include "mesh/parallel.h"
#include "query/regions/surface_values.h"

namespace strata::query {

// How one pass over all texels is reported: its part of the progress, and the message.
struct PassReport {
  const char* message;
  double from = 0, to = 1;
};

// Computes `make().at(texel)`, an optional float, for each texel whose bit is set in `texels` (one
// word per slot), as f32. Each part of the work has an object of its own. Fails when cancelled.
template <class Make>
Result<SurfaceValues> compute_values(std::span<const std::uint64_t> texels, Progress& progress,
                                     int threads, const PassReport& report, Make make) {
  constexpr std::size_t kSlotsAtOnce = 256;
  const std::size_t slots = texels.size();
  SurfaceValues result{std::vector<std::uint32_t>(slots * 64), std::vector<std::uint64_t>(slots)};
  const std::size_t parts = (slots + kSlotsAtOnce - 1) / kSlotsAtOnce;
  std::atomic<std::size_t> done{0};
  mesh::parallel_for(threads, static_cast<int>(parts), [&](int number) {
    auto values = make();
    const std::size_t first = static_cast<std::size_t>(number) * kSlotsAtOnce;
    for (std::size_t slot = first; slot < std::min(slots, first + kSlotsAtOnce); ++slot)
      for (std::uint64_t left = texels[slot]; left != 0; left &= left - 1) {
        if (progress.cancelled()) return;
        const auto texel = static_cast<std::uint32_t>(
            slot * 64 + static_cast<std::size_t>(std::countr_zero(left)));
        if (const auto value = values.at(texel))
          result.set(texel, {std::bit_cast<std::uint32_t>(*value), true});
      }
    progress.report(report.from + (report.to - report.from) * double(++done) / double(parts),
                    report.message);
  });
  if (progress.cancelled()) return cancelled_problem();
  return result;
}

}  // namespace strata::query
