#include "net/api/linked/web_annotation.h"

#include <algorithm>

#include "core/text/percent.h"
#include "core/text/timestamp.h"
#include "domain/layers/layer.h"
#include "domain/scene/model.h"

namespace strata::net {
namespace {

nlohmann::json in_scene(const LinkedAddresses& addresses, ModelId model, nlohmann::json selector) {
  nlohmann::json target{{"type", "SpecificResource"},
                        {"source",
                         {{"id", addresses.scene(model)},
                          {"type", "Scene"},
                          {"partOf", {{"id", addresses.manifest(model)}, {"type", "Manifest"}}}}}};
  if (!selector.is_null()) target["selector"] = nlohmann::json::array({std::move(selector)});
  return target;
}

nlohmann::json point_selector(const glm::dvec3& place) {
  return {{"type", "PointSelector"}, {"x", place.x}, {"y", place.y}, {"z", place.z}};
}

nlohmann::json plain_text(std::string value) {
  return {{"type", "TextualBody"}, {"value", std::move(value)}, {"format", "text/plain"}};
}

const app::FeatureValue* value_of(const AnnotatedFeature& annotated, const char* field) {
  const auto& fields = annotated.table.fields;
  const auto found = std::ranges::find(fields, field, &app::FeatureField::name);
  return found == fields.end()
             ? nullptr
             : &annotated.feature.values[static_cast<std::size_t>(found - fields.begin())];
}

std::string name_of(const AnnotatedFeature& annotated) {
  const app::FeatureValue* name = value_of(annotated, "name");
  const auto* text = name ? std::get_if<std::string>(name) : nullptr;
  return text ? *text : annotated.feature.id;
}

nlohmann::json selector_of(const AnnotatedFeature& annotated, const SceneFrame& frame) {
  if (annotated.table.kind == app::FeatureKind::points)
    return point_selector(frame.place(annotated.feature.geometry.front().rings.front().front()));
  std::string text = scene_wkt(annotated.feature, annotated.table.kind, frame);
  if (text.empty()) return nullptr;
  return {{"type", "WktSelector"}, {"value", std::move(text)}};
}

}  // namespace

std::string annotation_name(const app::FeatureTable& table, const app::Feature& feature) {
  return table.name + "." + feature.id;
}

nlohmann::json feature_annotation(const LinkedAddresses& addresses, const SceneFrame& frame,
                                  const AnnotatedFeature& annotated) {
  const auto& [model, layer, table, feature] = annotated;
  nlohmann::json body = plain_text(name_of(annotated));
  body["purpose"] = "tagging";
  nlohmann::json json{
      {"id", addresses.annotations(layer) + "/" + percent_encode(annotation_name(table, feature))},
      {"type", "Annotation"},
      {"motivation", "describing"},
      {"target", in_scene(addresses, model.id, selector_of(annotated, frame))}};
  const app::FeatureValue* key = value_of(annotated, "key");
  if (const auto* number = key ? std::get_if<std::int64_t>(key) : nullptr; number && layer.table)
    json["body"] = {{{"id", addresses.record(*layer.table, *number)}, {"type", "Dataset"}},
                    std::move(body)};
  else
    json["body"] = std::move(body);
  json["seeAlso"] = {{{"id", addresses.gis(model, layer) + "/items/" + feature.id},
                      {"format", "application/geo+json"}},
                     {{"id", addresses.api(model) + "/layers/" + layer.slug + "/texels.tif"},
                      {"type", "Image"},
                      {"format", "image/tiff"}}};
  if (table.kind != app::FeatureKind::areas)
    json["seeAlso"][0]["id"] = addresses.gis(model, layer) + "." +
                               table.name.substr(table.name.find('_') + 1) + "/items/" + feature.id;
  return json;
}

nlohmann::json comment_annotation(const LinkedAddresses& addresses, const SceneFrame& frame,
                                  const store::Comment& comment, const std::string& author) {
  nlohmann::json json{{"id", addresses.comment(comment.id)},
                      {"type", "Annotation"},
                      {"motivation", comment.thread ? "replying" : "commenting"},
                      {"body", plain_text(comment.text)},
                      {"created", utc_text(comment.time)}};
  if (comment.edited) json["modified"] = utc_text(*comment.edited);
  if (!author.empty()) json["creator"] = {{"type", "Person"}, {"name", author}};
  if (comment.thread)
    json["target"] = addresses.comment(*comment.thread);
  else
    json["target"] =
        in_scene(addresses, comment.model_id, point_selector(frame.place(comment.place->position)));
  if (comment.table_id && comment.record)
    json["seeAlso"] = {
        {{"id", addresses.record(*comment.table_id, *comment.record)}, {"type", "Dataset"}}};
  return json;
}

}  // namespace strata::net
