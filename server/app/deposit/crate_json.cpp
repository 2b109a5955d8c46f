#include "app/deposit/crate_json.h"

#include <stdexcept>
#include <string>

#include "app/deposit/crate_json_values.h"
#include "domain/layers/layer_blend.h"
#include "domain/layers/value_type.h"
#include "domain/people/role.h"
#include "domain/people/visibility.h"

namespace strata::app::crate {
namespace {

using nlohmann::json;

// The texts about a model, with their names in the JSON.
constexpr std::pair<const char*, std::string Model::*> kModelTexts[] = {
    {"name", &Model::name},
    {"slug", &Model::slug},
    {"up", &Model::up},
    {"north", &Model::north},
    {"crs", &Model::crs},
    {"inventory_number", &Model::inventory_number},
    {"owner", &Model::owner},
    {"creator", &Model::creator},
    {"captured", &Model::captured},
    {"method", &Model::method},
    {"accuracy", &Model::accuracy},
    {"processing", &Model::processing},
    {"rights_uri", &Model::rights_uri},
    {"credit", &Model::credit},
    {"survey_date", &Model::survey_date}};

}  // namespace

json to_crate(const Model& model) {
  json all{{"id", model.id},
           {"unit", name(model.unit)},
           {"unit_assumed", model.unit_assumed},
           {"scale_verified", model.scale_verified},
           {"origin", of(model.origin)},
           {"bounds_min", of(model.bounds_min)},
           {"bounds_max", of(model.bounds_max)},
           {"triangles", model.triangles},
           {"vertices", model.vertices},
           {"area", model.area},
           {"atlas", to_json(model.atlas, 1.0)},
           {"default_resolution", model.default_resolution},
           {"source_download", name(model.source_download)},
           {"proposal", model.proposal ? to_json(*model.proposal) : json()},
           {"open_edges", model.open_edges ? to_json(*model.open_edges, 1.0) : json()},
           {"from_points", model.from_points ? to_json(*model.from_points, 1.0) : json()},
           {"parts", model.parts.empty() ? json() : to_json(model.parts, 1.0)},
           {"repairs", json::array()}};
  for (const auto& [member, text] : kModelTexts) all[member] = model.*text;
  for (const Repair& repair : model.repairs)
    all["repairs"].push_back({{"what", repair.what}, {"count", repair.count}});
  return all;
}

Model model_of(const json& all) {
  Model model;
  model.id = all.at("id").get<ModelId>();
  model.unit = named(all.at("unit"), parse_unit);
  model.unit_assumed = all.at("unit_assumed").get<bool>();
  model.scale_verified = all.at("scale_verified").get<bool>();
  model.origin = vec3_of(all.at("origin"));
  model.bounds_min = vec3_of(all.at("bounds_min"));
  model.bounds_max = vec3_of(all.at("bounds_max"));
  model.triangles = all.at("triangles").get<std::uint64_t>();
  model.vertices = all.at("vertices").get<std::uint64_t>();
  model.area = all.at("area").get<double>();
  model.atlas = atlas_from_json(all.at("atlas"));
  model.default_resolution = all.at("default_resolution").get<int>();
  model.source_download = named(all.at("source_download"), parse_role);
  model.proposal = scale_proposal_from_json(all.at("proposal"));
  model.open_edges = open_edges_from_json(all.at("open_edges"));
  model.from_points = surface_from_points_from_json(all.value("from_points", json()));
  model.parts = model_parts_from_json(all.value("parts", json()));
  for (const auto& [member, text] : kModelTexts) model.*text = all.at(member).get<std::string>();
  for (const json& repair : all.at("repairs"))
    model.repairs.push_back(
        {repair.at("what").get<std::string>(), repair.at("count").get<std::uint64_t>()});
  return model;
}

json to_crate(const SurfaceImage& image) {
  return {{"id", image.id},
          {"name", image.name},
          {"slug", image.slug},
          {"description", image.description},
          {"media_type", image.media_type},
          {"width", image.width},
          {"height", image.height},
          {"opacity", image.opacity},
          {"visible", image.visible},
          {"order", image.order}};
}

SurfaceImage surface_image_of(const json& all) {
  SurfaceImage image;
  image.id = all.at("id").get<SurfaceImageId>();
  image.name = all.at("name").get<std::string>();
  image.slug = all.at("slug").get<std::string>();
  image.description = all.at("description").get<std::string>();
  image.media_type = all.at("media_type").get<std::string>();
  image.width = all.at("width").get<int>();
  image.height = all.at("height").get<int>();
  image.opacity = all.at("opacity").get<double>();
  image.visible = all.at("visible").get<bool>();
  image.order = all.at("order").get<int>();
  return image;
}

json to_crate(const Layer& layer) {
  json all{{"id", layer.id},
           {"name", layer.name},
           {"slug", layer.slug},
           {"kind", layer.kind == LayerKind::database ? "database" : "numeric"},
           {"type", name(layer.type)},
           {"resolution", layer.resolution},
           {"unit", layer.unit},
           {"description", layer.description},
           {"labels", layer.labels},
           {"descriptions", layer.descriptions},
           {"group", optional(layer.group)},
           {"palette", to_json(layer.palette)},
           {"palette_of_terms", layer.palette_of_terms},
           {"opacity", layer.opacity},
           {"blend", name(layer.blend)},
           {"visible", layer.visible},
           {"locked", layer.locked},
           {"review", layer.review},
           {"visibility", name(layer.visibility)},
           {"order", layer.order},
           {"table", optional(layer.table)},
           {"edited_by_hand", layer.edited_by_hand}};
  if (layer.origin) all["origin"] = *layer.origin == LayerOrigin::shape ? "shape" : "expression";
  if (!layer.formula) return all;
  all["formula"] = {{"expression", layer.formula->expression},
                    {"automatic", layer.formula->automatic},
                    {"inputs", json::array()}};
  for (const auto& input : layer.formula->inputs)
    all["formula"]["inputs"].push_back(
        {{"slug", input.slug}, {"layer", optional(input.layer)}, {"table", optional(input.table)}});
  return all;
}

Layer layer_of(const json& all) {
  Layer layer;
  layer.id = all.at("id").get<LayerId>();
  layer.name = all.at("name").get<std::string>();
  layer.slug = all.at("slug").get<std::string>();
  layer.kind = all.at("kind") == "database" ? LayerKind::database : LayerKind::numeric;
  layer.type = named(all.at("type"), parse_value_type);
  layer.resolution = all.at("resolution").get<int>();
  layer.unit = all.at("unit").get<std::string>();
  layer.description = all.at("description").get<std::string>();
  layer.labels = all.at("labels").get<Labels>();
  layer.descriptions = all.at("descriptions").get<Labels>();
  layer.group = optional_at<std::string>(all, "group");
  auto palette = palette_from_json(all.at("palette"));
  if (!palette) throw std::domain_error(palette.error().detail);
  layer.palette = std::move(*palette);
  layer.palette_of_terms = all.at("palette_of_terms").get<bool>();
  layer.opacity = all.at("opacity").get<double>();
  layer.blend = named(all.at("blend"), parse_layer_blend);
  layer.visible = all.at("visible").get<bool>();
  layer.locked = all.at("locked").get<bool>();
  layer.review = all.at("review").get<bool>();
  layer.visibility = named(all.at("visibility"), parse_visibility);
  layer.order = all.at("order").get<int>();
  layer.table = optional_at<TableId>(all, "table");
  layer.edited_by_hand = all.at("edited_by_hand").get<bool>();
  if (const auto origin = optional_at<std::string>(all, "origin"))
    layer.origin = *origin == "shape" ? LayerOrigin::shape : LayerOrigin::expression;
  if (const auto formula = all.find("formula"); formula != all.end()) {
    layer.formula.emplace();
    layer.formula->expression = formula->at("expression").get<std::string>();
    layer.formula->automatic = formula->at("automatic").get<bool>();
    for (const json& input : formula->at("inputs"))
      layer.formula->inputs.push_back({input.at("slug").get<std::string>(),
                                       optional_at<LayerId>(input, "layer"),
                                       optional_at<TableId>(input, "table")});
  }
  return layer;
}

json to_crate(const Table& table) {
  json all{{"id", table.id},
           {"name", table.name},
           {"slug", table.slug},
           {"labels", table.labels},
           {"description", table.description},
           {"title_column", nullptr},
           {"columns", json::array()}};
  for (const Column& column : table.columns) {
    if (table.title_column == column.id) all["title_column"] = column.slug;
    all["columns"].push_back({{"id", column.id},
                              {"name", column.name},
                              {"slug", column.slug},
                              {"labels", column.labels},
                              {"kind", name(column.kind)},
                              {"unit", column.unit},
                              {"required", column.required},
                              {"unique", column.unique},
                              {"default", column.default_value},
                              {"comment", column.comment},
                              {"choices", column.choices},
                              {"target", optional(column.target)},
                              {"minimum", optional(column.minimum)},
                              {"maximum", optional(column.maximum)},
                              {"order", column.order},
                              {"visibility", name(column.visibility)}});
  }
  return all;
}

Table table_of(const json& all) {
  Table table;
  table.id = all.at("id").get<TableId>();
  table.name = all.at("name").get<std::string>();
  table.slug = all.at("slug").get<std::string>();
  table.labels = all.at("labels").get<Labels>();
  table.description = all.at("description").get<std::string>();
  for (const json& each : all.at("columns")) {
    Column column;
    column.id = each.at("id").get<ColumnId>();
    column.name = each.at("name").get<std::string>();
    column.slug = each.at("slug").get<std::string>();
    column.labels = each.at("labels").get<Labels>();
    column.kind = named(each.at("kind"), parse_column_kind);
    column.unit = each.at("unit").get<std::string>();
    column.required = each.at("required").get<bool>();
    column.unique = each.at("unique").get<bool>();
    column.default_value = each.at("default");
    column.comment = each.at("comment").get<std::string>();
    column.choices = each.at("choices").get<std::vector<std::string>>();
    column.target = optional_at<TableId>(each, "target");
    column.minimum = optional_at<double>(each, "minimum");
    column.maximum = optional_at<double>(each, "maximum");
    column.order = each.at("order").get<int>();
    column.visibility = named(each.at("visibility"), parse_visibility);
    table.columns.push_back(std::move(column));
  }
  return table;
}

}  // namespace strata::app::crate
