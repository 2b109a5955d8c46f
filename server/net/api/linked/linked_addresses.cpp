#include "net/api/linked/linked_addresses.h"

#include "domain/layers/layer.h"
#include "domain/scene/model.h"
#include "domain/tables/table.h"
#include "net/api/route_context.h"
#include "net/http/origin.h"
#include "net/transport/server_options.h"

namespace strata::net {

LinkedAddresses::LinkedAddresses(const RouteContext& context, const Request& request)
    : site_(own_origin(request, context.options.allowed_origins)) {}

std::string LinkedAddresses::model(ModelId id) const {
  return catalog() + "/models/" + to_string(id);
}

std::string LinkedAddresses::layer(const Layer& layer) const {
  return model(layer.model_id) + "/layers/" + to_string(layer.id);
}

std::string LinkedAddresses::object(ProjectId project, ObjectId id) const {
  return catalog() + "/projects/" + to_string(project) + "/objects/" + to_string(id);
}

std::string LinkedAddresses::table(TableId id) const {
  return catalog() + "/tables/" + to_string(id);
}

std::string LinkedAddresses::record(TableId table, std::int64_t key) const {
  return this->table(table) + "/records/" + std::to_string(key);
}

std::string LinkedAddresses::comment(CommentId id) const {
  return catalog() + "/comments/" + to_string(id);
}

std::string LinkedAddresses::object_of(const Model& model) const {
  return model.object ? object(model.project_id, *model.object) : this->model(model.id) + "#object";
}

std::string LinkedAddresses::page(const Model& model) const {
  return site_ + "/models/" + model.slug;
}

std::string LinkedAddresses::api(const Model& model) const {
  return site_ + "/api/v1/models/" + model.slug;
}

std::string LinkedAddresses::api(const Table& table) const {
  return site_ + "/api/v1/tables/" + table.slug;
}

std::string LinkedAddresses::gis(const Model& model) const {
  return site_ + "/ogc/collections/" + model.slug;
}

std::string LinkedAddresses::gis(const Model& model, const Layer& layer) const {
  return gis(model) + "." + layer.slug;
}

}  // namespace strata::net
