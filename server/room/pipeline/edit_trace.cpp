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

// Returns the durations of the stages. A stage that the edit did not reach has none.
std::array<std::optional<Clock::duration>, kEditStages.size()> stages(const EditTrace& trace,
                                                                      Clock::time_point now) {
  const auto until = [&](const EditTrace::Time& next) { return next.value_or(now); };
  std::array<std::optional<Clock::duration>, kEditStages.size()> durations;
  const auto set = [&](EditStage stage, Clock::duration duration) {
    durations[static_cast<std::size_t>(stage)] = duration;
  };
  set(EditStage::queue, until(trace.started) - trace.arrived);
  if (trace.computed && trace.started) set(EditStage::compute, *trace.computed - *trace.started);
  const auto on_gpu_from = trace.computed ? trace.computed : trace.started;
  if (on_gpu_from) set(EditStage::gpu, until(trace.painted) - *on_gpu_from);
  if (trace.submitted) set(EditStage::journal, now - *trace.submitted);
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
      if (durations[i]) timings.of(edit.is_stroke, static_cast<EditStage>(i)).add(*durations[i]);

  const bool is_slow = slow_after.count() > 0 && now - trace.arrived >= slow_after;
  const bool has_failed = why && is_server_failure(why->code);
  const auto level = is_slow || has_failed ? log::Level::info : log::Level::debug;
  if (!log::is_enabled(level)) return;

  static constexpr std::array<std::string_view, kEditStages.size()> kFieldNames{
      "queue_ms", "compute_ms", "gpu_ms", "journal_ms", "total_ms"};
  std::vector<log::Field> fields{
      {"op", edit.op}, {"model", edit.model_id.number()}, {"layer", edit.layer_id.number()}};
  for (std::size_t i = 0; i < durations.size(); ++i)
    if (durations[i]) fields.push_back({kFieldNames[i], ms(*durations[i])});
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
