#pragma once

#include <chrono>

#include "core/error.h"
#include "core/progress.h"
#include "domain/scene/model.h"
#include "store/store.h"

namespace strata::jobs {

inline constexpr const char* kDemoProject = "demo";  // slugs of the project and the model
inline constexpr const char* kDemoModel = "demo-pot";

// Like make_demo in jobs/import_job.h, but the caller sets the time of the fills.
Result<Model> make_demo_at(store::Store& store, Progress& progress, double detail,
                           std::chrono::system_clock::time_point time);

}  // namespace strata::jobs
