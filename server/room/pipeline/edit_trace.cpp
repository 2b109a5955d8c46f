#include "room/pipeline/edit_trace.h"

#include <array>
#include <string>
#include <vector>

#include "core/log.h"

namespace strata::room {
namespace {

using Clock = EditTrace::Clock;

double ms(Clock::duration duration) {
  return std::chrono::duration<double, std::milli>(duration).count();
}

constexpr Clock::duration kNotReached{-1};

bool has_begun(Clock::time_point time) { return time != Clock::time_point(); }

// Returns the durations of the stages, or kNotReached.
std::array<Clock::duration, kEditStages.size()> stages(const EditTrace& trace,
                                                       Clock::time_point now) {
  const auto until = [&](Clock::time_point next) { return has_begun(next) ? next : now; };
  std::array<Clock::duration, kEditStages.size()> durations;
  durations.fill(kNotReached);
  const auto set = [&](EditStage stage, Clock::duration duration) {
    durations[static_cast<std::size_t>(stage)] = duration;
  };
  set(EditStage::queue, until(trace.started) - trace.arrived);
  const bool is_computed = has_begun(trace.computed);
  if (is_computed) set(EditStage::compute, trace.computed - trace.started);
  if (has_begun(trace.started))
    set(EditStage::gpu, until(trace.painted) - (is_computed ? trace.computed : trace.started));
  if (has_begun(trace.submitted)) set(EditStage::journal, now - trace.submitted);
  set(EditStage::total, now - trace.arrived);
  return durations;
}

}  // namespace

void report_edit(const EditTrace& trace, const TracedEdit& edit, const Error* why,
                 EditTimings& timings, std::chrono::milliseconds slow_after) {
  const auto now = Clock::now();
  const auto durations = stages(trace, now);
  if (!why)
    for (std::size_t i = 0; i < durations.size(); ++i)
      if (durations[i] != kNotReached)
        timings.of(edit.is_stroke, static_cast<EditStage>(i)).add(durations[i]);

  const bool is_slow = slow_after.count() > 0 && now - trace.arrived >= slow_after;
  const bool has_failed = why && is_server_failure(why->code);
  const auto level = is_slow || has_failed ? log::Level::info : log::Level::debug;
  if (!log::is_enabled(level)) return;

  static constexpr std::array<std::string_view, kEditStages.size()> kFieldNames{
      "queue_ms", "compute_ms", "gpu_ms", "journal_ms", "total_ms"};
  std::vector<log::Field> fields{
      {"op", edit.op}, {"model", edit.model_id.number()}, {"layer", edit.layer_id.number()}};
  for (std::size_t i = 0; i < durations.size(); ++i)
    if (durations[i] != kNotReached) fields.push_back({kFieldNames[i], ms(durations[i])});
  if (trace.paint_ms > 0) fields.push_back({"paint_ms", trace.paint_ms});
  if (why) fields.push_back({"problem", name(why->code)});
  const TraceScope scope(trace.id);
  log::write(level,
             has_failed ? "edit failed"
             : why      ? "edit refused"
             : is_slow  ? "slow edit"
                        : "edit saved",
             fields);
}

}  // namespace strata::room
