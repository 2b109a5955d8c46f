#pragma once

#include <array>
#include <cstddef>
#include <string_view>

#include "core/histogram.h"

namespace strata::room {

// The stages of an edit. `compute` is empty for strokes, which the GPU computes.
enum class EditStage { queue, compute, gpu, journal, total };
inline constexpr std::array<std::string_view, 5> kEditStages{"queue", "compute", "gpu", "journal",
                                                             "total"};

// The durations of the stages of saved edits in all models, for the metrics of the server. All
// threads may use it.
struct EditTimings {
  std::array<Histogram, kEditStages.size()> strokes, other_edits;

  Histogram& of(bool is_stroke, EditStage stage) {
    return (is_stroke ? strokes : other_edits)[static_cast<std::size_t>(stage)];
  }
};

}  // namespace strata::room
