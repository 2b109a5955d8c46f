#pragma once

#include <chrono>

#include "core/error.h"
#include "core/progress.h"
#include "domain/scene/model.h"
#include "store/store.h"

namespace strata::jobs {

inline constexpr const char* kDemoProject = "demo";  // slugs
inline constexpr const char* kDemoModel = "demo-pot";

// As make_demo of jobs/import_job.h; `time` is that of the fills.
Result<Model> make_demo_at(store::Store& store, Progress& progress, double detail,
                           std::chrono::system_clock::time_point time);

}  // namespace strata::jobs
