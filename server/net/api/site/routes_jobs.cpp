#include "jobs/job_queue.h"
#include "net/api/route_help.h"
#include "net/api/routes.h"
#include "net/http/page.h"
#include "net/serialization/job_serialization.h"

namespace strata::net {
namespace {

Result<jobs::JobStatus> find_job(const RouteContext& context, const Request& request) {
  auto id = parse_integer(request.param("job"), 1, INT64_MAX, "job");
  auto status = id ? context.jobs.status(JobId(*id)) : std::nullopt;
  if (!status)
    return fail(ErrorCode::not_found, "Job not found",
                "There is no job with this id, or it ended long ago.", "job");
  return *status;
}

bool is_own(const jobs::JobStatus& job, const Principal& who) {
  return !job.user.empty() && job.user == who.user;
}

// Returns the job as visible to `who`. The report or problem of a job may name layers that only
// curators can see, so only curators and the user who started the job get it. Only the user who
// requested a file gets it because it may contain data that is invisible to other users.
nlohmann::json job_json(jobs::JobStatus job, const Principal& who) {
  if (job.result && !is_own(job, who)) job.result->file.reset();
  if (!sees(who.roles.in(job.project), Visibility::curators) && !is_own(job, who)) {
    if (job.result) job.result->report = nullptr;
    if (job.problem)
      job.problem = Error{
          job.problem->code, job.problem->title, "Curators of the project can see the reason.", {}};
  }
  return net::to_json(job);
}

bool is_over(const jobs::JobStatus& job) {
  return job.state != jobs::JobState::queued && job.state != jobs::JobState::running;
}

}  // namespace

void add_job_routes(Router& router, const RouteContext& context) {
  router.add({.method = Method::get,
              .pattern = "/api/v1/jobs",
              .handler = answering([&context](const Request& request) -> Result<Response> {
                auto page = STRATA_TRY(page_of(request));
                auto all = context.jobs.all();
                std::erase_if(
                    all, [&](const auto& job) { return !request.principal->sees(job.project); });
                nlohmann::json list = nlohmann::json::array();
                const int total = static_cast<int>(all.size());
                const auto part = STRATA_TRY(slice_by(
                    page, all, [](const auto& job) { return NumberKey{-job.id.number()}; }));
                for (std::size_t i = part.begin; i < part.end; ++i)
                  list.push_back(job_json(all[i], *request.principal));
                Response response = json_response({{"jobs", list}, {"total", total}});
                add_page_links(response, request, page, part.last);
                return response;
              }),
              .role = Role::guest,
              .query = {"limit", "offset", "after"}});
  router.add({.method = Method::get,
              .pattern = "/api/v1/jobs/{job}",
              .handler = answering([&context](const Request& request) -> Result<Response> {
                auto job = STRATA_TRY(find_job(context, request));
                return json_response(job_json(job, *request.principal));
              })});
  router.add({.method = Method::remove,
              .pattern = "/api/v1/jobs/{job}",
              .handler = answering([&context](const Request& request) -> Result<Response> {
                auto job = STRATA_TRY(find_job(context, request));
                if (request.role() < Role::curator && !is_own(job, *request.principal))
                  return fail(ErrorCode::forbidden, "Not allowed",
                              "Only the person who started a job, and curators, can cancel it.",
                              "job");
                if (is_over(job) || !context.jobs.cancel(job.id))
                  return fail(ErrorCode::conflict, "Job has ended",
                              "The job has ended, so it cannot be canceled.", "job");
                auto now = context.jobs.status(job.id);
                return json_response(job_json(now.value_or(job), *request.principal));
              })});
  router.add({.method = Method::get,
              .pattern = "/api/v1/jobs/{job}/file",
              .handler = answering([&context](const Request& request) -> Result<Response> {
                auto job = STRATA_TRY(find_job(context, request));
                if (!is_over(job) && is_own(job, *request.principal))
                  return fail(ErrorCode::conflict, "Job not finished",
                              "The job is still running. Try again when it has finished.", "job");
                if (!is_own(job, *request.principal) || !job.result || !job.result->file)
                  return fail(ErrorCode::not_found, "File not found",
                              "This job has no file for you, or the server has deleted the file.",
                              "job");
                return file_response(job.result->file);
              }),
              // The state is the job number because a job creates only one file and job numbers are
              // never reused.
              .state = [](const Request& request) { return std::optional(request.param("job")); }});
}

}  // namespace strata::net
