#include "domain/scene/model.h"

#include "domain/scene/up.h"

namespace strata {
namespace {

nlohmann::json vec3(const glm::dvec3& v) { return nlohmann::json::array({v.x, v.y, v.z}); }

}  // namespace

double metres_per(Unit unit) {
  switch (unit) {
    case Unit::mm: return 0.001;
    case Unit::cm: return 0.01;
    default: return 1.0;
  }
}

std::string_view name(Unit unit) {
  switch (unit) {
    case Unit::mm: return "mm";
    case Unit::cm: return "cm";
    default: return "m";
  }
}

std::optional<Unit> parse_unit(std::string_view text) {
  for (Unit unit : {Unit::mm, Unit::cm, Unit::m})
    if (name(unit) == text) return unit;
  return std::nullopt;
}

std::string_view name(ScaleReason reason) {
  switch (reason) {
    case ScaleReason::given: return "given";
    case ScaleReason::format: return "format";
    case ScaleReason::comment: return "comment";
    case ScaleReason::coordinates: return "coordinates";
    case ScaleReason::parts: return "parts";
    case ScaleReason::size: return "size";
    default: return "shape";
  }
}

std::optional<ScaleReason> parse_scale_reason(std::string_view text) {
  for (ScaleReason reason :
       {ScaleReason::given, ScaleReason::format, ScaleReason::comment, ScaleReason::coordinates,
        ScaleReason::size, ScaleReason::shape, ScaleReason::parts})
    if (name(reason) == text) return reason;
  return std::nullopt;
}

nlohmann::json to_json(const ScaleProposal& proposal) {
  nlohmann::json json{{"unit", name(proposal.unit)},
                      {"unit_reason", name(proposal.unit_reason)},
                      {"unit_confidence", proposal.unit_confidence},
                      {"up", proposal.up},
                      {"up_reason", name(proposal.up_reason)},
                      {"up_confidence", proposal.up_confidence}};
  if (!proposal.unit_comment.empty()) json["unit_comment"] = proposal.unit_comment;
  if (!proposal.up_comment.empty()) json["up_comment"] = proposal.up_comment;
  return json;
}

std::optional<ScaleProposal> scale_proposal_from_json(const nlohmann::json& json) {
  if (!json.is_object()) return std::nullopt;
  const auto text = [&](const char* member) { return json.value(member, std::string()); };
  const auto unit = parse_unit(text("unit"));
  const auto unit_reason = parse_scale_reason(text("unit_reason")),
             up_reason = parse_scale_reason(text("up_reason"));
  if (!unit || !unit_reason || !up_reason || !is_up(text("up"))) return std::nullopt;
  return ScaleProposal{
      *unit,      *unit_reason, json.value("unit_confidence", 1.0), text("unit_comment"),
      text("up"), *up_reason,   json.value("up_confidence", 1.0),   text("up_comment")};
}

nlohmann::json to_json(const OpenEdges& edges, double metres_per_unit) {
  nlohmann::json longest = nlohmann::json::array();
  for (const double length : edges.longest) longest.push_back(length * metres_per_unit);
  return {
      {"loops", edges.loops}, {"length_m", edges.length * metres_per_unit}, {"longest_m", longest}};
}

nlohmann::json to_json(const SurfaceFromPoints& facts, double metres_per_unit) {
  return {{"points", facts.points},
          {"used", facts.used},
          {"point_spacing_m", facts.point_spacing * metres_per_unit},
          {"cell_m", facts.cell * metres_per_unit},
          {"gap_m", facts.gap * metres_per_unit},
          {"distance_median_m", facts.distance_median * metres_per_unit},
          {"distance_95_m", facts.distance_95 * metres_per_unit}};
}

std::optional<SurfaceFromPoints> surface_from_points_from_json(const nlohmann::json& json) {
  if (!json.is_object()) return std::nullopt;
  return SurfaceFromPoints{json.value("points", std::uint64_t{0}),
                           json.value("used", std::uint64_t{0}),
                           json.value("point_spacing_m", 0.0),
                           json.value("cell_m", 0.0),
                           json.value("gap_m", 0.0),
                           json.value("distance_median_m", 0.0),
                           json.value("distance_95_m", 0.0)};
}

std::optional<OpenEdges> open_edges_from_json(const nlohmann::json& json) {
  if (!json.is_object()) return std::nullopt;
  return OpenEdges{json.value("loops", std::uint64_t{0}), json.value("length_m", 0.0),
                   json.value("longest_m", std::vector<double>())};
}

nlohmann::json to_json(const Project& project) {
  return {{"id", project.id},
          {"name", project.name},
          {"slug", project.slug},
          {"description", project.description},
          {"require_if_match", project.require_if_match}};
}

nlohmann::json to_json(const AtlasReport& atlas, double metres_per_unit) {
  const double square_metres = metres_per_unit * metres_per_unit;
  nlohmann::json sizes = nlohmann::json::array();
  for (const auto& size : atlas.texel_sizes)
    sizes.push_back({{"resolution", size.resolution},
                     {"area_mean_m2", size.area_mean * square_metres},
                     {"area_max_m2", size.area_max * square_metres}});
  nlohmann::json limits = nlohmann::json::array();
  for (const auto& limit : atlas.limits)
    limits.push_back({{"code", limit.code}, {"text", limit.text}});
  return {{"source", atlas.source},
          {"lowest_resolution", atlas.lowest_resolution},
          {"charts", atlas.charts},
          {"coverage", atlas.coverage},
          {"overlap", atlas.overlap},
          {"stretch_mean", atlas.stretch_mean},
          {"stretch_p99", atlas.stretch_p99},
          {"texel_area_max_m2", atlas.texel_area_max * square_metres},
          {"texel_sizes", sizes},
          {"limits", limits}};
}

AtlasReport atlas_from_json(const nlohmann::json& json) {
  AtlasReport atlas;
  atlas.source = json.value("source", std::string("made"));
  atlas.lowest_resolution = json.value("lowest_resolution", 2048);
  atlas.charts = json.value("charts", 0);
  atlas.coverage = json.value("coverage", 0.0);
  atlas.overlap = json.value("overlap", 0.0);
  atlas.stretch_mean = json.value("stretch_mean", 0.0);
  atlas.stretch_p99 = json.value("stretch_p99", 0.0);
  atlas.texel_area_max = json.value("texel_area_max_m2", 0.0);  // stored with metres_per_unit = 1
  for (const auto& size : json.value("texel_sizes", nlohmann::json::array()))
    atlas.texel_sizes.push_back({size.value("resolution", 0), size.value("area_mean_m2", 0.0),
                                 size.value("area_max_m2", 0.0)});
  for (const auto& limit : json.value("limits", nlohmann::json::array()))
    atlas.limits.push_back(
        {limit.value("code", std::string()), limit.value("text", std::string())});
  return atlas;
}

nlohmann::json to_json(const Model& model, const std::string& project_slug) {
  nlohmann::json repairs = nlohmann::json::array();
  for (const auto& repair : model.repairs)
    repairs.push_back({{"what", repair.what}, {"count", repair.count}});
  nlohmann::json files = nlohmann::json::array();
  for (const auto& file : model.source_files)
    files.push_back({{"name", file.name}, {"sha256", file.sha256}, {"bytes", file.bytes}});
  nlohmann::json json = {
      {"id", model.id},
      {"name", model.name},
      {"slug", model.slug},
      {"project", project_slug},
      {"unit", name(model.unit)},
      {"unit_assumed", model.unit_assumed},
      {"scale_verified", model.scale_verified},
      {"up", model.up},
      {"north", model.north},
      {"crs", model.crs},
      {"origin", vec3(model.origin)},
      {"triangles", model.triangles},
      {"vertices", model.vertices},
      {"bounds", {{"min", vec3(model.bounds_min)}, {"max", vec3(model.bounds_max)}}},
      {"area_m2", model.area_m2()},
      {"atlas", to_json(model.atlas, model.metres())},
      {"repairs", repairs},
      {"source_files", files},
      {"default_resolution", model.default_resolution},
      {"inventory_number", model.inventory_number},
      {"owner", model.owner},
      {"creator", model.creator},
      {"captured", model.captured},
      {"method", model.method},
      {"accuracy", model.accuracy},
      {"processing", model.processing},
      {"rights_uri", model.rights_uri},
      {"credit", model.credit},
      {"source_download", name(model.source_download)},
      {"sequence", model.sequence}};
  if (model.object) {
    json["object"] = *model.object;
    json["survey_date"] = model.survey_date;
  }
  if (model.proposal) json["proposal"] = to_json(*model.proposal);
  if (model.open_edges) json["open_edges"] = to_json(*model.open_edges, model.metres());
  if (model.from_points) json["from_points"] = to_json(*model.from_points, model.metres());
  if (!model.parts.empty()) json["parts"] = to_json(model.parts, model.metres());
  return json;
}

}  // namespace strata
