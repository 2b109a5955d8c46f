#pragma once

#include <memory>

#include "core/error.h"

namespace strata {
struct Layer;
struct Model;
struct Project;
struct Table;
}  // namespace strata
namespace strata::room {
class Room;
}  // namespace strata::room

namespace strata::net {

struct Request;
struct RouteContext;

// Return the entity that the address names, as visible to the caller's role. These functions read
// the database and open no room.
Result<Project> stored_project(const RouteContext& context, const Request& request);
Result<Model> stored_model(const RouteContext& context, const Request& request);
Result<Layer> stored_layer(const RouteContext& context, const Request& request);
Result<Table> stored_table(const RouteContext& context, const Request& request);
// Returns the room of the model that the address names. Opens the room if it is not open.
Result<std::shared_ptr<room::Room>> open_room(const RouteContext& context, const Request& request);

}  // namespace strata::net
