#include "domain/layers/layer.h"

#include <nlohmann/json.hpp>

namespace strata {

nlohmann::json to_json(const LayerAnalysis& analysis) {
  return {
      {"name", analysis.name}, {"step", analysis.step}, {"of", analysis.of}, {"job", analysis.job}};
}

nlohmann::json to_json(const Layer& layer) {
  nlohmann::json json{{"id", layer.id},
                      {"model", layer.model_id},
                      {"name", layer.name},
                      {"slug", layer.slug},
                      {"kind", layer.kind == LayerKind::database ? "database" : "numeric"},
                      {"type", name(layer.type)},
                      {"resolution", layer.resolution},
                      {"unit", layer.unit},
                      {"description", layer.description},
                      {"labels", layer.labels},
                      {"descriptions", layer.descriptions},
                      {"palette", to_json(layer.palette)},
                      {"opacity", layer.opacity},
                      {"visible", layer.visible},
                      {"locked", layer.locked},
                      {"review", layer.review},
                      {"visibility", name(layer.visibility)},
                      {"order", layer.order},
                      {"sequence", layer.sequence}};
  if (layer.blend != LayerBlend::normal) json["blend"] = name(layer.blend);
  if (layer.group) json["group"] = *layer.group;
  if (layer.origin) {
    json["computed"] = *layer.origin == LayerOrigin::shape ? "shape" : "expression";
    json["edited_by_hand"] = layer.edited_by_hand;
  }
  if (layer.table) json["table"] = *layer.table;
  if (layer.formula) {
    nlohmann::json inputs = nlohmann::json::array();
    for (const auto& input : layer.formula->inputs) inputs.push_back(input.slug);
    json["expression"] = layer.formula->expression;
    json["recompute"] = layer.formula->automatic ? "automatic" : "manual";
    json["inputs"] = std::move(inputs);
    json["stale"] = layer.formula->stale;
    if (layer.formula->computed_sequence > 0)
      json["computed_sequence"] = layer.formula->computed_sequence;
  }
  if (layer.analysis) json["analysis"] = to_json(*layer.analysis);
  return json;
}

}  // namespace strata
