#include "net/api/addressed.h"

#include "net/api/route_context.h"
#include "net/http/router.h"
#include "room/rooms.h"
#include "store/content/layers.h"
#include "store/content/models.h"
#include "store/content/projects.h"
#include "store/store.h"
#include "store/tables/tables.h"

namespace strata::net {

Result<Project> stored_project(const RouteContext& context, const Request& request) {
  return context.store.projects().find(request.param("project"));
}

Result<Model> stored_model(const RouteContext& context, const Request& request) {
  return context.store.models().find(request.param("model"));
}

Result<Layer> stored_layer(const RouteContext& context, const Request& request) {
  auto model = STRATA_TRY(stored_model(context, request));
  return context.store.layers().find(model.id, request.param("layer"), request.role());
}

Result<Table> stored_table(const RouteContext& context, const Request& request) {
  return context.store.tables().find(request.param("table"), request.role());
}

Result<std::shared_ptr<room::Room>> open_room(const RouteContext& context, const Request& request) {
  return context.rooms.open(request.param("model"), request.role());
}

}  // namespace strata::net
