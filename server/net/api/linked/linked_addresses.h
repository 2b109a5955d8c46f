#pragma once

#include <cstdint>
#include <string>

#include "core/ids.h"

namespace strata {
struct Layer;
struct Model;
struct Table;
}  // namespace strata

namespace strata::net {

struct Request;
struct RouteContext;

// The stable addresses of the entities of a site, which are also their identifiers in linked data.
// They contain ids, which never change, and no names.
class LinkedAddresses {
 public:
  LinkedAddresses(const RouteContext& context, const Request& request);

  const std::string& site() const { return site_; }  // "https://host"
  std::string catalog() const { return site_ + "/id"; }
  std::string model(ModelId id) const;
  std::string layer(const Layer& layer) const;
  std::string object(ProjectId project, ObjectId id) const;
  std::string table(TableId id) const;
  std::string record(TableId table, std::int64_t key) const;
  std::string comment(CommentId id) const;
  // The physical object of a model that belongs to no object of the project.
  std::string object_of(const Model& model) const;

  // The IIIF manifest of a model and the scene in it.
  std::string manifest(ModelId id) const { return model(id) + "/manifest"; }
  std::string scene(ModelId id) const { return manifest(id) + "#scene"; }
  // All annotations of a model, those of its comments, and those of a layer.
  std::string annotations(ModelId id) const { return model(id) + "/annotations"; }
  std::string comments_of(ModelId id) const { return model(id) + "/comments"; }
  std::string annotations(const Layer& layer) const { return this->layer(layer) + "/annotations"; }

  // The page, the API and the collections for GIS programs. They contain slugs, as users know them.
  std::string page(const Model& model) const;
  std::string api(const Model& model) const;
  std::string api(const Table& table) const;
  std::string gis(const Model& model) const;
  std::string gis(const Model& model, const Layer& layer) const;

 private:
  std::string site_;
};

}  // namespace strata::net
