#include "net/auth/project_authorization.h"

#include <limits>

#include "domain/people/role.h"
#include "jobs/job_queue.h"
#include "store/content/comments.h"
#include "store/content/models.h"
#include "store/content/projects.h"
#include "store/people/kiosks.h"
#include "store/store.h"
#include "store/tables/attachments.h"
#include "store/tables/tables.h"

namespace strata::net {
namespace {

template <class T>
Result<ProjectId> project_id_of(const Result<T>& found) {
  if (!found) return tl::unexpected(found.error());
  return found->project_id;
}

struct Place {
  const char* param;  // a parameter in a route's pattern
  Result<ProjectId> (*project)(const RouteContext& context, const std::string& ref);
};

template <class Id>
Result<ProjectId> project_of(const std::string& ref,
                             const std::function<Result<ProjectId>(Id id)>& project) {
  const auto id = parse_integer(ref, 1, std::numeric_limits<std::int64_t>::max(), {});
  return id ? project(Id(*id)) : fail(ErrorCode::not_found, {}, {});
}

constexpr Place kProject = {
    "project", [](const RouteContext& context, const std::string& ref) -> Result<ProjectId> {
      const auto project = STRATA_TRY(context.store.projects().find(ref));
      return project.id;
    }};

// The path parameters that determine a project.
constexpr Place kPlaces[] = {
    kProject,
    {"model",
     [](const RouteContext& context, const std::string& ref) {
       return project_id_of(context.store.models().find(ref));
     }},
    {"table",
     [](const RouteContext& context, const std::string& ref) {
       return project_id_of(context.store.tables().find(ref, Role::owner));
     }},
    {"attachment",
     [](const RouteContext& context, const std::string& ref) {
       return project_of<AttachmentId>(ref, [&](AttachmentId id) -> Result<ProjectId> {
         const auto attachment =
             STRATA_TRY(context.store.attachments().find(id, {{}, Role::owner}));
         return project_id_of(
             context.store.tables().find(to_string(attachment.table_id), Role::owner));
       });
     }},
    {"comment",
     [](const RouteContext& context, const std::string& ref) {
       return project_of<CommentId>(ref, [&](CommentId id) -> Result<ProjectId> {
         const auto comment = STRATA_TRY(context.store.comments().comment(id, Role::owner));
         return project_id_of(context.store.models().find(to_string(comment.model_id)));
       });
     }},
    {"job",
     [](const RouteContext& context, const std::string& ref) {
       return project_of<JobId>(ref, [&](JobId id) -> Result<ProjectId> {
         const auto job = context.jobs.status(id);
         if (!job) return fail(ErrorCode::not_found, {}, {});
         return job->project;
       });
     }},
    {"kiosk",
     [](const RouteContext& context, const std::string& ref) {
       return project_of<KioskId>(ref, [&](KioskId id) -> Result<ProjectId> {
         return project_id_of(context.store.kiosks().kiosk(id));
       });
     }},
};

Result<void> enter(const RouteContext& context, Principal& who, const Place& place,
                   const std::string& ref, const std::string& field) {
  const auto project = place.project(context, ref);
  if (!project && project.error().code != ErrorCode::not_found)
    return tl::unexpected(project.error());
  // The response must not reveal whether an invisible project exists.
  if (!project || !who.sees(*project)) return no_such(place.param, ref, field);
  who.role = who.roles.in(*project);
  return {};
}

// Avoids the query for users with the same role in all projects.
bool depends_on_project(const Roles& roles) {
  return roles.everywhere == Role::guest ||
         (roles.everywhere < Role::curator && !roles.in_projects.empty());
}

}  // namespace

Result<std::optional<ProjectId>> addressed_project(const RouteContext& context,
                                                   const Request& request) {
  for (const Place& place : kPlaces) {
    const auto param = request.params.find(place.param);
    if (param == request.params.end()) continue;
    const auto project = place.project(context, param->second);
    if (!project && project.error().code == ErrorCode::not_found) return std::nullopt;
    if (!project) return tl::unexpected(project.error());
    return *project;
  }
  return std::nullopt;
}

Result<std::int64_t> number_of(const Request& request, const std::string& param) {
  const auto id =
      parse_integer(request.param(param), 1, std::numeric_limits<std::int64_t>::max(), {});
  return id ? id : no_such(param, request.param(param));
}

Result<void> enter_project(const RouteContext& context, Request& request, bool in_query) {
  Principal& who = *request.principal;
  if (!depends_on_project(who.roles)) return {};
  if (in_query)
    return enter(context, who, kProject, request.query_or("project", "default"), "project");
  for (const Place& place : kPlaces)
    if (const auto param = request.params.find(place.param); param != request.params.end())
      return enter(context, who, place, param->second, {});
  return {};
}

Result<void> check_seen(const RouteContext& context, const Request& request,
                        const std::string& project, const std::string& field) {
  Principal who = *request.principal;
  return enter(context, who, kProject, project, field);
}

}  // namespace strata::net
