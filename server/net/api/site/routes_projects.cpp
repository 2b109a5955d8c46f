#include "domain/people/role.h"
#include "net/api/addressed.h"
#include "net/api/route_help.h"
#include "net/api/routes.h"
#include "net/http/idempotency_store.h"
#include "net/http/page.h"
#include "net/transport/server_options.h"
#include "store/content/projects.h"
#include "store/people/groups.h"
#include "store/store.h"

namespace strata::net {
namespace {

// Returns the groups that give `who` a role in a project. Includes only roles above the user's role
// on the site and above the user's own role in the project. A token may have a lower role than
// these.
Result<std::map<ProjectId, nlohmann::json>> groups_that_give(const RouteContext& context,
                                                             const Principal& who) {
  std::map<ProjectId, nlohmann::json> groups;
  if (who.roles.in_projects.empty()) return groups;
  const auto given = STRATA_TRY(context.store.groups().roles_of(who.user));
  for (const store::GivenRole& role : given)
    if (role.role > who.roles.everywhere && role.role == who.roles.in(role.project_id))
      groups[role.project_id].push_back(role.group);
  return groups;
}

Result<Response> list_projects(const RouteContext& context, const Request& request) {
  auto page = STRATA_TRY(page_of(request));
  auto projects = STRATA_TRY(context.store.projects().all());
  std::erase_if(projects,
                [&](const Project& project) { return !request.principal->sees(project.id); });
  const auto groups = STRATA_TRY(groups_that_give(context, *request.principal));
  nlohmann::json list = nlohmann::json::array();
  const int total = static_cast<int>(projects.size());
  const auto part = slice_by(page, projects,
                             [](const Project& project) { return NumberKey{project.id.number()}; });
  if (!part) return tl::unexpected(part.error());
  for (std::size_t i = part->begin; i < part->end; ++i) {
    const Project& project = projects[i];
    list.push_back(to_json(project));
    list.back()["role"] = std::string(name(request.principal->roles.in(project.id)));
    if (const auto by = groups.find(project.id); by != groups.end())
      list.back()["groups"] = by->second;
  }
  Response response = json_response({{"projects", list}, {"total", total}});
  add_page_links(response, request, page, part->last);
  return response;
}

Result<Response> create_project(const RouteContext& context, const Request& request) {
  auto body = STRATA_TRY(body_of<protocol::ProjectCreate>(request));
  auto slug = STRATA_TRY(slug_of(body.slug, body.name));
  Project project;
  project.name = body.name;
  project.slug = slug;
  project.description = body.description;
  const auto answer = [](const Project& made) {
    return json_response(to_json(made), 201)
        .with("Location", "/api/v1/projects/" + made.slug)
        .with("ETag", etag_of(made.version));
  };
  auto created = context.store.projects().create(std::move(project),
                                                 idempotent_response<Project>(request, answer));
  if (!created) return tl::unexpected(created.error());
  return answer(*created);
}

Result<Response> change_project(const RouteContext& context, const Request& request) {
  auto project = STRATA_TRY(stored_project(context, request));
  STRATA_TRY(check_if_match(request, project.version));
  auto body = STRATA_TRY(body_of<protocol::ProjectPatch>(request));
  // Curators can change the settings for work in their project, but not its name and description.
  if ((body.name || body.description) && request.role() < Role::administrator)
    return fail(ErrorCode::forbidden, "Not allowed",
                "Only administrators can change the name and the description of a project.",
                body.name ? "name" : "description");
  if (body.require_if_match) project.require_if_match = *body.require_if_match;
  if (body.name) project.name = *body.name;
  if (body.description) project.description = *body.description;
  const auto answer = [](const Project& now) {
    return json_response(to_json(now)).with("ETag", etag_of(now.version));
  };
  auto changed = context.store.projects().update(std::move(project),
                                                 idempotent_response<Project>(request, answer));
  if (!changed) return tl::unexpected(changed.error());
  return answer(*changed);
}

}  // namespace

void add_project_routes(Router& router, const RouteContext& context) {
  router.add({.method = Method::get,
              .pattern = "/api/v1/projects",
              .handler = answering(
                  [&context](const Request& request) { return list_projects(context, request); }),
              .role = Role::guest,
              .query = {"limit", "offset", "after"}});
  router.add({.method = Method::post,
              .pattern = "/api/v1/projects",
              .handler = answering(
                  [&context](const Request& request) { return create_project(context, request); }),
              .role = Role::administrator,
              .body = BodyKind::memory,
              .max_body = context.options.max_json_bytes,
              .keeps_answer = true});
  router.add({.method = Method::get,
              .pattern = "/api/v1/projects/{project}",
              .handler = answering([&context](const Request& request) -> Result<Response> {
                auto project = STRATA_TRY(stored_project(context, request));
                return with_etag(json_response(to_json(project)), request, project.version);
              })});
  router.add({.method = Method::patch,
              .pattern = "/api/v1/projects/{project}",
              .handler = answering(
                  [&context](const Request& request) { return change_project(context, request); }),
              .role = Role::curator,
              .body = BodyKind::memory,
              .max_body = context.options.max_json_bytes,
              .keeps_answer = true,
              .needs_version = true});
  router.add(
      {.method = Method::remove,
       .pattern = "/api/v1/projects/{project}",
       .handler = answering([&context](const Request& request) -> Result<Response> {
         auto project = STRATA_TRY(stored_project(context, request));
         STRATA_TRY(check_if_match(request, project.version));
         STRATA_TRY(context.store.projects().remove(
             project.id, idempotent_response<>(request, [] { return empty_response(204); })));
         return empty_response(204);
       }),
       .role = Role::administrator,
       .keeps_answer = true,
       .needs_version = true});
}

}  // namespace strata::net
