#include "net/serialization/job_serialization.h"

#include "jobs/job_queue.h"
#include "protocol/problem.h"

namespace strata::net {

nlohmann::json to_json(const jobs::JobStatus& job) {
  static constexpr const char* kStates[] = {"queued", "running", "done", "failed", "cancelled"};
  nlohmann::json json{{"id", job.id},
                      {"state", kStates[static_cast<int>(job.state)]},
                      {"progress", job.progress},
                      {"message", job.message}};
  if (job.problem) json["problem"] = protocol::problem_body(*job.problem);
  if (!job.result) return json;
  if (job.result->model != ModelId(0)) json["model"] = job.result->model;
  if (!job.result->layers.empty()) json["layers"] = job.result->layers;
  if (job.result->image) json["look"] = *job.result->image;
  if (const auto& report = job.result->report; !report.is_null())
    json[job.kind == jobs::JobKind::regions    ? "cleanup"
         : job.kind == jobs::JobKind::changes  ? "changes"
         : job.kind == jobs::JobKind::analysis ? "analysis"
                                               : "report"] = report;
  if (const auto& file = job.result->file) {
    json["file"] = {{"name", file->name}, {"media_type", file->media_type}, {"bytes", file->bytes}};
    if (file->triangles) json["file"]["triangles"] = *file->triangles;
  }
  return json;
}

}  // namespace strata::net
