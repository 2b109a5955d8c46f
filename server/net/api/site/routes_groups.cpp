// Groups of users, and their roles in projects.
#include "domain/people/role.h"
#include "net/api/addressed.h"
#include "net/api/route_help.h"
#include "net/api/routes.h"
#include "net/auth/project_authorization.h"
#include "net/http/page.h"
#include "net/serialization/group_serialization.h"
#include "net/transport/server_options.h"
#include "store/people/groups.h"
#include "store/store.h"

namespace strata::net {
namespace {

using store::GroupDetail;

nlohmann::json to_json(const GroupDetail& group) {
  nlohmann::json members = nlohmann::json::array(), projects = nlohmann::json::array();
  for (const auto& [user, full_name] : group.members)
    members.push_back({{"user", user}, {"full_name", full_name}});
  for (const auto& [slug, project, role] : group.projects)
    projects.push_back({{"project", slug}, {"name", project}, {"role", std::string(name(role))}});
  return {{"id", group.group.id},
          {"name", group.group.name},
          {"members", std::move(members)},
          {"projects", std::move(projects)},
          {"losing", group.losing}};
}

Result<Response> list_groups(const RouteContext& context, const Request& request) {
  const auto page = STRATA_TRY(page_of(request));
  const auto groups = STRATA_TRY(context.store.groups().all());
  nlohmann::json list = nlohmann::json::array();
  const int total = static_cast<int>(groups.size());
  const auto part =
      STRATA_TRY(slice_by_name(page, groups, context.store, [](const store::Group& group) {
        return store::NamedId{group.name, group.id.number()};
      }));
  for (std::size_t i = part.begin; i < part.end; ++i) {
    const auto& [id, group, people, projects] = groups[i];
    list.push_back({{"id", id}, {"name", group}, {"people", people}, {"projects", projects}});
  }
  Response response = json_response({{"groups", std::move(list)}, {"total", total}});
  add_page_links(response, request, page, part.last);
  return response;
}

Result<Response> create_group(const RouteContext& context, const Request& request) {
  auto body = STRATA_TRY(body_of<protocol::GroupCreate>(request));
  const auto made = STRATA_TRY(
      context.store.groups().create(body.name, body.members.value_or(std::vector<std::string>())));
  return json_response(to_json(made), 201)
      .with("Location", "/api/v1/groups/" + to_string(made.group.id));
}

Result<Response> show_group(const RouteContext& context, const Request& request) {
  const auto id = STRATA_TRY(id_of<GroupId>(request, "group"));
  const auto group = STRATA_TRY(context.store.groups().group(id));
  return json_response(to_json(group));
}

Result<Response> change_group(const RouteContext& context, const Request& request) {
  auto body = STRATA_TRY(body_of<protocol::GroupPatch>(request));
  const auto id = STRATA_TRY(id_of<GroupId>(request, "group"));
  const store::GroupChange change{body.name, body.add.value_or(std::vector<std::string>()),
                                  body.remove.value_or(std::vector<std::string>())};
  const auto changed = STRATA_TRY(context.store.groups().change(id, change, request.user()));
  roles_changed(context, changed.people);
  return json_response(to_json(changed.now));
}

Result<Response> delete_group(const RouteContext& context, const Request& request) {
  const auto id = STRATA_TRY(id_of<GroupId>(request, "group"));
  const auto people = STRATA_TRY(context.store.groups().remove(id, request.user()));
  roles_changed(context, people);
  return empty_response(204);
}

Result<Response> put_role(const RouteContext& context, const Request& request) {
  const auto body = STRATA_TRY(body_of<protocol::MemberPut>(request));
  const auto project = STRATA_TRY(stored_project(context, request));
  const auto id = STRATA_TRY(id_of<GroupId>(request, "group"));
  const Role role = parse_role(protocol::name(body.role)).value_or(Role::viewer);
  const auto put = STRATA_TRY(context.store.groups().put(project.id, id, role, request.user()));
  roles_changed(context, put.people);
  return json_response(net::to_json(put.now));
}

Result<Response> take_role(const RouteContext& context, const Request& request) {
  const auto project = STRATA_TRY(stored_project(context, request));
  const auto id = STRATA_TRY(id_of<GroupId>(request, "group"));
  const auto people = STRATA_TRY(context.store.groups().take(project.id, id, request.user()));
  roles_changed(context, people);
  return empty_response(204);
}

}  // namespace

void add_group_routes(Router& router, const RouteContext& context) {
  const auto add = [&](Method method, std::string pattern,
                       Result<Response> (*answer)(const RouteContext&, const Request&),
                       std::vector<std::string> query = {}) {
    const bool has_body =
        method == Method::post || method == Method::patch || method == Method::put;
    router.add({.method = method,
                .pattern = std::move(pattern),
                .handler = answering([&context, answer](const Request& request) {
                  return answer(context, request);
                }),
                .role = Role::administrator,
                .query = std::move(query),
                .check = method != Method::get ? std::function(check_no_script) : nullptr,
                .body = has_body ? BodyKind::memory : BodyKind::none,
                .max_body = has_body ? context.options.max_json_bytes : 0});
  };
  const std::string groups = "/api/v1/groups", group = groups + "/{group}",
                    in_project = "/api/v1/projects/{project}/groups/{group}";
  add(Method::get, groups, list_groups, {"limit", "offset", "after"});
  add(Method::post, groups, create_group);
  add(Method::get, group, show_group);
  add(Method::patch, group, change_group);
  add(Method::remove, group, delete_group);
  add(Method::put, in_project, put_role);
  add(Method::remove, in_project, take_role);
}

}  // namespace strata::net
