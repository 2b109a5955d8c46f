#include "net/api/linked/iiif_manifest.h"

#include <algorithm>
#include <cmath>
#include <string_view>

#include "core/text/percent.h"
#include "domain/layers/layer.h"
#include "domain/scene/model.h"
#include "net/api/linked/scene_frame.h"
#include "vocabulary/rdf.h"

namespace strata::net {
namespace {

// IIIF names licenses by the address with http, which identifies them.
std::string rights_of(const std::string& uri) {
  for (const std::string_view host : {"//creativecommons.org/", "//rightsstatements.org/"})
    if (uri.starts_with("https:" + std::string(host))) return "http" + uri.substr(5);
  return uri;
}

// IIIF groups texts by language. Names and descriptions in Strata have no stated language.
nlohmann::json texts(const std::string& text) { return {{"none", {text}}}; }
nlohmann::json english(const char* text) { return {{"en", {text}}}; }

nlohmann::json point(const glm::dvec3& place) {
  return {{"type", "PointSelector"}, {"x", place.x}, {"y", place.y}, {"z", place.z}};
}

nlohmann::json painting(const std::string& id, nlohmann::json body, nlohmann::json target) {
  return {{"id", id},
          {"type", "Annotation"},
          {"motivation", {"painting"}},
          {"body", std::move(body)},
          {"target", std::move(target)}};
}

nlohmann::json page_of(const std::string& id, nlohmann::json items) {
  return {{"id", id}, {"type", "AnnotationPage"}, {"items", std::move(items)}};
}

class Manifest {
 public:
  Manifest(const LinkedAddresses& addresses, const Model& model)
      : addresses_(addresses), model_(model), frame_(model) {}

  nlohmann::json write(const std::vector<ManifestView>& views, const std::vector<Layer>& layers,
                       bool with_surface) const {
    nlohmann::json json{{"@context", "http://iiif.io/api/presentation/4/context.json"},
                        {"id", addresses_.manifest(model_.id)},
                        {"type", "Manifest"},
                        {"label", texts(model_.name)},
                        {"metadata", metadata()},
                        {"items", nlohmann::json::array()},
                        {"homepage",
                         {{{"id", addresses_.page(model_)},
                           {"type", "Text"},
                           {"label", english("The model in Strata")},
                           {"format", "text/html"}}}},
                        {"seeAlso",
                         {{{"id", addresses_.model(model_.id)},
                           {"type", "Dataset"},
                           {"label", english("Description in Linked Art")},
                           {"format", "application/ld+json"},
                           {"profile", "https://linked.art/ns/v1/linked-art.json"}}}},
                        {"annotations", annotation_pages(layers)}};
    if (!model_.credit.empty())
      json["requiredStatement"] = {{"label", english("Attribution")},
                                   {"value", texts(model_.credit)}};
    if (is_iri(model_.rights_uri)) json["rights"] = rights_of(model_.rights_uri);
    json["items"].push_back(scene(views, with_surface));
    for (const ManifestView& view : views) json["items"].push_back(canvas(view));
    return json;
  }

 private:
  nlohmann::json metadata() const {
    nlohmann::json list = nlohmann::json::array();
    const auto add = [&](const char* label, const std::string& value) {
      if (!value.empty()) list.push_back({{"label", english(label)}, {"value", texts(value)}});
    };
    add("Inventory number", model_.inventory_number);
    add("Owner", model_.owner);
    add("Creator", model_.creator);
    add("Captured", model_.captured);
    add("Method", model_.method);
    add("Accuracy", model_.accuracy);
    return list;
  }

  nlohmann::json annotation_pages(const std::vector<Layer>& layers) const {
    nlohmann::json pages{{{"id", addresses_.comments_of(model_.id)}, {"type", "AnnotationPage"}}};
    for (const Layer& layer : layers)
      pages.push_back({{"id", addresses_.annotations(layer)}, {"type", "AnnotationPage"}});
    return pages;
  }

  // Without the surface, the scene still has the cameras, and the annotations refer to it.
  nlohmann::json scene(const std::vector<ManifestView>& views, bool with_surface) const {
    const std::string id = addresses_.scene(model_.id), manifest = addresses_.manifest(model_.id);
    const nlohmann::json whole{{"id", id}, {"type", "Scene"}};
    nlohmann::json surface{{"id", addresses_.api(model_) + "/surface.glb"},
                           {"type", "Model"},
                           {"label", texts(model_.name)},
                           {"format", "model/gltf-binary"}};
    const glm::dvec3 moved = frame_.world_origin();
    if (moved != glm::dvec3(0))
      surface = {
          {"id", manifest + "#surface"},
          {"type", "SpecificResource"},
          {"source", std::move(surface)},
          {"transform",
           {{{"type", "TranslateTransform"}, {"x", moved.x}, {"y", moved.y}, {"z", moved.z}}}}};
    nlohmann::json items = nlohmann::json::array();
    if (with_surface) items.push_back(painting(manifest + "#model", std::move(surface), whole));
    for (const ManifestView& view : views) {
      items.push_back(camera(view));
      if (&view != &views.front()) items.back()["behavior"] = {"hidden"};
    }
    return {{"id", id},
            {"type", "Scene"},
            {"label", texts(model_.name)},
            {"spatialScale", {{"type", "Quantity"}, {"quantityValue", 1.0}, {"unit", "m"}}},
            {"items", {page_of(manifest + "#painting", std::move(items))}}};
  }

  nlohmann::json camera(const ManifestView& view) const {
    const std::string name = "#camera-" + percent_encode(view.slug),
                      manifest = addresses_.manifest(model_.id);
    const glm::dmat4 to_world = glm::inverse(view.camera.view);
    const glm::dvec3 forward = -glm::normalize(glm::dvec3(to_world[2]));
    const glm::dvec3 center = (model_.bounds_min + model_.bounds_max) / 2.0;
    const double diagonal = glm::length(model_.bounds_max - model_.bounds_min);
    glm::dvec3 eye(to_world[3]);
    nlohmann::json body{{"id", manifest + name + "-body"}, {"label", texts(view.name)}};
    if (is_orthographic(view.camera)) {
      body["type"] = "OrthographicCamera";
      body["viewHeight"] = 2 / view.camera.projection[1][1] * model_.metres();
      // Moves the camera outside of the model, which does not change the picture.
      eye -= forward * (glm::dot(eye - center, forward) + diagonal);
    } else {
      body["type"] = "PerspectiveCamera";
      body["fieldOfView"] = glm::degrees(2 * std::atan(1 / view.camera.projection[1][1]));
    }
    const double distance = std::max(glm::dot(center - eye, forward), diagonal / 100);
    body["lookAt"] = point(frame_.place(eye + forward * distance));
    return painting(manifest + name, std::move(body),
                    {{"id", manifest + name + "-place"},
                     {"type", "SpecificResource"},
                     {"source", {{"id", addresses_.scene(model_.id)}, {"type", "Scene"}}},
                     {"selector", {point(frame_.place(eye))}}});
  }

  nlohmann::json canvas(const ManifestView& view) const {
    const std::string id = addresses_.manifest(model_.id) + "#view-" + percent_encode(view.slug);
    nlohmann::json json{
        {"id", id},
        {"type", "Canvas"},
        {"label", texts(view.name)},
        {"width", view.camera.width},
        {"height", view.camera.height},
        {"items",
         {page_of(id + "-page", {painting(id + "-picture",
                                          {{"id", addresses_.api(model_) + "/views/" +
                                                      percent_encode(view.slug) + "/picture"},
                                           {"type", "Image"},
                                           {"format", "image/jpeg"},
                                           {"width", view.camera.width},
                                           {"height", view.camera.height}},
                                          {{"id", id}, {"type", "Canvas"}})})}}};
    if (!view.text.empty()) json["summary"] = texts(view.text);
    return json;
  }

  const LinkedAddresses& addresses_;
  const Model& model_;
  const SceneFrame frame_;
};

}  // namespace

nlohmann::json iiif_manifest(const LinkedAddresses& addresses, const Model& model,
                             const std::vector<ManifestView>& views,
                             const std::vector<Layer>& layers, bool with_surface) {
  return Manifest(addresses, model).write(views, layers, with_surface);
}

}  // namespace strata::net
