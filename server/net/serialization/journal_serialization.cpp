#include "net/serialization/journal_serialization.h"

#include "core/text/timestamp.h"
#include "core/uuid.h"
#include "store/journal/journal.h"

namespace strata::net {

nlohmann::json to_json(const store::JournalRow& row) {
  nlohmann::json json{{"sequence", row.sequence},
                      {"id", to_string(row.id)},
                      {"stroke", to_string(row.stroke)},
                      {"user", row.user},
                      {"op", row.op},
                      {"time", utc_text(row.time)},
                      {"in_force", row.in_force}};
  if (row.answer.is_object())
    for (const char* member : {"texels_changed", "area_m2"})
      if (auto found = row.answer.find(member); found != row.answer.end()) json[member] = *found;
  for (const char* member : {"recipe", "expression", "shape", "max_angle_deg", "depth_bias"})
    if (auto found = row.record.find(member); found != row.record.end()) json[member] = *found;
  if (row.op == "checkpoint") {
    nlohmann::json people = nlohmann::json::array();
    for (const nlohmann::json& person : row.record.at("people"))
      people.push_back({{"user", person.at("user")}, {"edits", person.at("edits")}});
    json["people"] = std::move(people);
  }
  if (row.review != Review::none) json["review"] = name(row.review);
  if (row.reviewer) {
    json["reviewer"] = {{"user", row.reviewer->user}, {"time", utc_text(row.reviewer->time)}};
    if (!row.reviewer->reason.empty()) json["reviewer"]["reason"] = row.reviewer->reason;
  }
  return json;
}

nlohmann::json to_json(const store::ReviewQueue& queue) {
  nlohmann::json strokes = nlohmann::json::array(), people = nlohmann::json::array();
  for (const auto& stroke : queue.strokes) {
    strokes.push_back({{"sequence", stroke.sequence},
                       {"last", stroke.last},
                       {"stroke", to_string(stroke.stroke)},
                       {"user", stroke.user},
                       {"op", stroke.op},
                       {"begun", utc_text(stroke.begun)},
                       {"time", utc_text(stroke.time)},
                       {"texels_changed", stroke.texels},
                       {"area_m2", stroke.area_m2}});
    if (auto camera = stroke.record.find("camera"); camera != stroke.record.end())
      strokes.back()["camera"] = *camera;
  }
  for (const auto& person : queue.people)
    people.push_back({{"user", person.user}, {"strokes", person.strokes}});
  return {{"strokes", std::move(strokes)}, {"total", queue.total}, {"people", std::move(people)}};
}

}  // namespace strata::net
