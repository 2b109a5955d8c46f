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

// What the address names, as the role of who asks sees it. From the store: reading needs no open
// room.
Result<Project> stored_project(const RouteContext& context, const Request& request);
Result<Model> stored_model(const RouteContext& context, const Request& request);
Result<Layer> stored_layer(const RouteContext& context, const Request& request);
Result<Table> stored_table(const RouteContext& context, const Request& request);
// The open room of the model that the address names; it is opened where it is not.
Result<std::shared_ptr<room::Room>> open_room(const RouteContext& context, const Request& request);

}  // namespace strata::net
