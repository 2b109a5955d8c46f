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
// Checks that the text is a year, a month or a day. The error names `field`.
Result<void> check_survey_date(const std::string& date, const std::string& field);

// Returns whether a survey can be from the period. Each text is a year, a month or a day. The
// period contains all of its last year or month. An empty limit does not limit the period. A survey
// of the year 2019 can be from a period that begins in May 2019.
bool may_be_within(const std::string& date, const std::string& from, const std::string& to);

}  // namespace strata
