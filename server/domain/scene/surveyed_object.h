#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/ids.h"

namespace strata {

// One survey of an object: the model that was made of it at that time.
struct Survey {
  ModelId model = 0;
  std::string slug, name;  // of the model
  std::string date;        // "2019", "2019-05" or "2019-05-01"
};

// A physical object, such as a bust, that was surveyed at several times. The object and its models
// are in the same project.
struct SurveyedObject {
  ObjectId id = 0;
  ProjectId project_id = 0;
  std::string name;  // unique in the project, ignoring case
  std::int64_t version = 1;
  std::vector<Survey> surveys{};  // sorted by date; a year comes before its months
};

nlohmann::json to_json(const SurveyedObject& object);

// Checks that a model has both an object and the date of its survey, or neither, and that the date
// is a year, a month or a day. Returns an `invalid` error that names `object` or `survey_date`.
Result<void> check_survey(bool has_object, const std::string& date);

}  // namespace strata
