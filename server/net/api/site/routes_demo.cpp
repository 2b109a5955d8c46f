#include "net/api/site/routes_demo.h"

#include "app/demo/demo_story.h"
#include "app/template_registry.h"
#include "domain/people/role.h"
#include "jobs/demo.h"
#include "jobs/job_queue.h"
#include "net/api/route_help.h"
#include "net/api/routes.h"
#include "room/rooms.h"
#include "store/content/projects.h"
#include "store/store.h"

namespace strata::net {
namespace {

// Requires an existing demo project. Otherwise, this route could create one.
Result<Response> reset_demo(const RouteContext& context, const Request& request) {
  const auto project = STRATA_TRY(context.store.projects().find(jobs::kDemoProject));
  const auto job = STRATA_TRY(context.jobs.add(
      project.id,
      // Copies the templates because the job may run after the context is destroyed.
      [&store = context.store, &rooms = context.rooms,
       templates = context.templates](Progress& progress) -> Result<jobs::JobResult> {
        STRATA_TRY(app::erase_demo_story(store, [&rooms](ModelId model) { rooms.forget(model); }));
        const auto made = STRATA_TRY(app::make_demo_story(store, templates, progress));
        // A room that was opened while the story was created does not contain all of it.
        rooms.forget(made.model.id);
        return jobs::JobResult(made.model.id);
      },
      request.user()));
  return job_response(context, job);
}

}  // namespace

void add_demo_routes(Router& router, const RouteContext& context) {
  router.add({.method = Method::post,
              .pattern = "/api/v1/demo/reset",
              .handler = answering(
                  [&context](const Request& request) { return reset_demo(context, request); }),
              .role = Role::administrator});
}

}  // namespace strata::net
