// The members of a project, and the users who can see it.
#include <set>

#include "domain/people/role.h"
#include "net/api/addressed.h"
#include "net/api/route_help.h"
#include "net/api/routes.h"
#include "net/auth/auth.h"
#include "net/http/page.h"
#include "net/live/close_codes.h"
#include "net/live/live_sockets.h"
#include "net/serialization/group_serialization.h"
#include "net/serialization/people_serialization.h"
#include "net/transport/server_options.h"
#include "store/content/projects.h"
#include "store/people/accounts.h"
#include "store/people/groups.h"
#include "store/people/members.h"
#include "store/people/people.h"
#include "store/store.h"

namespace strata::net {
namespace {

nlohmann::json to_json(const store::Membership& member) {
  nlohmann::json json{{"user", member.person.name},
                      {"full_name", member.person.full_name},
                      {"role", std::string(name(member.role))}};
  add_color(json, member.person);
  return json;
}

Result<Response> list_members(const RouteContext& context, const Request& request) {
  const auto page = STRATA_TRY(page_of(request));
  const auto project = STRATA_TRY(stored_project(context, request));
  const auto members = STRATA_TRY(context.store.members().of_project(project.id));
  const auto with_role = STRATA_TRY(context.store.groups().of_project(project.id));
  nlohmann::json list = nlohmann::json::array(), groups = nlohmann::json::array();
  for (const store::ProjectGroup& group : with_role) groups.push_back(net::to_json(group));
  const int total = static_cast<int>(members.size());
  const auto part =
      slice_by_name(page, members, context.store, [](const store::Membership& member) {
        return store::NamedId{member.person.name, member.person.id.number()};
      });
  if (!part) return tl::unexpected(part.error());
  for (std::size_t i = part->begin; i < part->end; ++i) list.push_back(to_json(members[i]));
  Response response = json_response(
      {{"members", std::move(list)}, {"groups", std::move(groups)}, {"total", total}});
  add_page_links(response, request, page, part->last);
  return response;
}

// Leaves out users whose accounts are disabled.
Result<Response> list_people(const RouteContext& context, const Request& request) {
  const auto page = STRATA_TRY(page_of(request));
  const auto project = STRATA_TRY(stored_project(context, request));
  const auto roles = STRATA_TRY(context.store.groups().people_with_role(project.id));
  auto people = STRATA_TRY(context.store.accounts().all());
  const std::set<PersonId> with_role(roles.begin(), roles.end());
  std::erase_if(people, [&](const store::Person& person) {
    return person.disabled || (person.role < Role::viewer && !with_role.contains(person.id));
  });
  const auto part =
      STRATA_TRY(slice_by_name(page, people, context.store, [](const store::Person& person) {
        return store::NamedId{person.name, person.id.number()};
      }));
  nlohmann::json list = nlohmann::json::array();
  for (std::size_t i = part.begin; i < part.end; ++i) {
    const store::Person& person = people[i];
    list.push_back({{"user", person.name}, {"full_name", person.full_name}});
    add_color(list.back(), person);
  }
  Response response = json_response({{"people", std::move(list)}, {"total", people.size()}});
  add_page_links(response, request, page, part.last);
  return response;
}

Result<Response> put_member(const RouteContext& context, const Request& request) {
  const auto body = STRATA_TRY(body_of<protocol::MemberPut>(request));
  const auto project = STRATA_TRY(stored_project(context, request));
  const Role role = parse_role(protocol::name(body.role)).value_or(Role::viewer);
  const auto member =
      context.store.members().put(project.id, request.param("user"), role, request.user());
  if (!member) return tl::unexpected(member.error());
  roles_changed(context, {member->person.name});
  return json_response(to_json(*member));
}

Result<Response> remove_member(const RouteContext& context, const Request& request) {
  const auto project = STRATA_TRY(stored_project(context, request));
  const auto person = STRATA_TRY(context.store.accounts().find(request.param("user")));
  STRATA_TRY(context.store.members().remove(project.id, person.name, request.user()));
  roles_changed(context, {person.name});
  return empty_response(204);
}

}  // namespace

void roles_changed(const RouteContext& context, const std::vector<std::string>& people) {
  context.auth.forget();
  for (const std::string& user : people)
    context.live_sockets.close_user(user, kClosePolicy, "your role was changed");
}

void add_member_routes(Router& router, const RouteContext& context) {
  const std::string members = "/api/v1/projects/{project}/members";
  router.add({.method = Method::get,
              .pattern = members,
              .handler = answering(
                  [&context](const Request& request) { return list_members(context, request); }),
              .role = Role::curator,
              .query = {"limit", "offset", "after"}});
  router.add({.method = Method::get,
              .pattern = "/api/v1/projects/{project}/people",
              .handler = answering(
                  [&context](const Request& request) { return list_people(context, request); }),
              .role = Role::annotator,
              .query = {"limit", "offset", "after"}});
  router.add({.method = Method::put,
              .pattern = members + "/{user}",
              .handler = answering(
                  [&context](const Request& request) { return put_member(context, request); }),
              .role = Role::administrator,
              .check = check_no_script,
              .body = BodyKind::memory,
              .max_body = context.options.max_json_bytes});
  router.add({.method = Method::remove,
              .pattern = members + "/{user}",
              .handler = answering(
                  [&context](const Request& request) { return remove_member(context, request); }),
              .role = Role::administrator,
              .check = check_no_script});
}

}  // namespace strata::net
