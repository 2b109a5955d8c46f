#include <array>
#include <string>

#include "app/deposit/crate_json.h"
#include "app/deposit/crate_json_values.h"
#include "core/text/timestamp.h"

namespace strata::app::crate {

using nlohmann::json;

json to_crate(const store::Photograph& photograph) {
  const photo::Calibration& calibration = photograph.posed.calibration;
  const photo::Pose& pose = photograph.posed.pose;
  json rotation = json::array();  // row by row
  for (glm::length_t y = 0; y < 3; ++y)
    for (glm::length_t x = 0; x < 3; ++x) rotation.push_back(pose.camera_from_world[x][y]);
  json all{{"id", photograph.id.number()},
           {"name", photograph.posed.name},
           {"rights_uri", photograph.rights_uri},
           {"rights_holder", photograph.rights_holder},
           {"calibration",
            {{"lens", photo::name(calibration.lens.model)},
             {"unit", calibration.unit == photo::CalibrationUnit::pixel ? "pixel" : "longest_side"},
             {"width", calibration.width},
             {"height", calibration.height},
             {"focal", {calibration.focal.x, calibration.focal.y}},
             {"offset", {calibration.offset.x, calibration.offset.y}},
             {"skew", calibration.skew},
             {"radial", calibration.lens.radial},
             {"tangential", calibration.lens.tangential}}},
           {"pose", {{"camera_from_world", rotation}, {"center", of(pose.center)}}}};
  if (const auto& original = photograph.original)
    all["original"] = {{"media_type", original->media_type},
                       {"width", original->width},
                       {"height", original->height}};
  return all;
}

store::Photograph photograph_of(const json& all) {
  store::Photograph photograph;
  photograph.posed.name = all.at("name").get<std::string>();
  photograph.rights_uri = all.at("rights_uri").get<std::string>();
  photograph.rights_holder = all.at("rights_holder").get<std::string>();
  const json& stored = all.at("calibration");
  photo::Calibration& calibration = photograph.posed.calibration;
  calibration.lens.model = named(stored.at("lens"), photo::lens_model_named);
  calibration.unit = stored.at("unit") == "pixel" ? photo::CalibrationUnit::pixel
                                                  : photo::CalibrationUnit::longest_side;
  calibration.width = stored.at("width").get<int>();
  calibration.height = stored.at("height").get<int>();
  calibration.focal = {stored.at("focal").at(0), stored.at("focal").at(1)};
  calibration.offset = {stored.at("offset").at(0), stored.at("offset").at(1)};
  calibration.skew = stored.at("skew").get<double>();
  calibration.lens.radial = stored.at("radial").get<std::array<double, 6>>();
  calibration.lens.tangential = stored.at("tangential").get<std::array<double, 4>>();
  photo::Pose& pose = photograph.posed.pose;
  const json& rotation = all.at("pose").at("camera_from_world");
  for (glm::length_t y = 0; y < 3; ++y)
    for (glm::length_t x = 0; x < 3; ++x)
      pose.camera_from_world[x][y] = rotation.at(static_cast<std::size_t>(y * 3 + x)).get<double>();
  pose.center = vec3_of(all.at("pose").at("center"));
  if (const auto original = all.find("original"); original != all.end()) {
    photograph.original.emplace();
    photograph.original->media_type = original->at("media_type").get<std::string>();
    photograph.original->width = original->at("width").get<int>();
    photograph.original->height = original->at("height").get<int>();
  }
  return photograph;
}

json to_crate(const store::NamedPart& part) {
  return {{"id", part.id},          {"slug", part.slug}, {"name", part.name},
          {"text", part.text},      {"user", part.user}, {"time", utc_text(part.time)},
          {"content", part.content}};
}

store::NamedPart named_part_of(const json& all) {
  store::NamedPart part;
  part.id = all.at("id").get<NamedPartId>();
  part.slug = all.at("slug").get<std::string>();
  part.name = all.at("name").get<std::string>();
  part.text = all.at("text").get<std::string>();
  part.user = all.at("user").get<std::string>();
  part.content = all.at("content");
  return part;
}

json to_crate(const store::Comment& comment) {
  json all{{"id", comment.id},
           {"thread", optional(comment.thread)},
           {"layer", optional(comment.layer_id)},
           {"table", optional(comment.table_id)},
           {"record", optional(comment.record)},
           {"text", comment.text},
           {"user", comment.user},
           {"time", utc_text(comment.time)},
           {"deleted", comment.deleted}};
  if (comment.place)
    all["place"] = {{"position", of(comment.place->position)},
                    {"normal", of(comment.place->normal)}};
  if (comment.resolved)
    all["resolved"] = {{"user", comment.resolved->user},
                       {"time", utc_text(comment.resolved->time)}};
  return all;
}

store::Comment comment_of(const json& all) {
  store::Comment comment;
  comment.id = all.at("id").get<CommentId>();
  comment.thread = optional_at<CommentId>(all, "thread");
  comment.layer_id = optional_at<LayerId>(all, "layer");
  comment.table_id = optional_at<TableId>(all, "table");
  comment.record = optional_at<std::int64_t>(all, "record");
  comment.text = all.at("text").get<std::string>();
  comment.user = all.at("user").get<std::string>();
  comment.deleted = all.at("deleted").get<bool>();
  if (const auto place = all.find("place"); place != all.end())
    comment.place =
        store::Comment::Place{vec3_of(place->at("position")), vec3_of(place->at("normal"))};
  if (const auto resolved = all.find("resolved"); resolved != all.end())
    comment.resolved = store::Comment::Resolution{resolved->at("user").get<std::string>(), {}};
  return comment;
}

}  // namespace strata::app::crate
