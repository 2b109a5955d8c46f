#include "domain/scene/surveyed_object.h"

#include <algorithm>

#include "core/text/edtf.h"

namespace strata {
namespace {

// EDTF also allows seasons, intervals, approximate dates and long years.
bool is_survey_date(const std::string& date) {
  constexpr std::size_t kYear = 4, kMonth = 7, kDay = 10;
  constexpr std::string_view kLastMonth = "12";
  if (date.size() != kYear && date.size() != kMonth && date.size() != kDay) return false;
  if (date.find_first_not_of("0123456789-") != std::string::npos || date[0] == '-') return false;
  if (date.size() > kYear && date.substr(kYear + 1, 2) > kLastMonth) return false;
  return parse_edtf(date).has_value();
}

}  // namespace

nlohmann::json to_json(const SurveyedObject& object) {
  nlohmann::json surveys = nlohmann::json::array();
  for (const Survey& survey : object.surveys)
    surveys.push_back({{"model", survey.model},
                       {"slug", survey.slug},
                       {"name", survey.name},
                       {"date", survey.date}});
  return {{"id", object.id}, {"name", object.name}, {"surveys", std::move(surveys)}};
}

Result<void> check_survey(bool has_object, const std::string& date) {
  if (has_object && date.empty())
    return fail(ErrorCode::invalid, "Survey date missing",
                "A model of an object needs the date of its survey, such as 2019, 2019-05 or "
                "2019-05-01.",
                "survey_date");
  if (!has_object && !date.empty())
    return fail(ErrorCode::invalid, "Object missing",
                "Only a model of an object has a survey date. Also name the object.", "object");
  return date.empty() ? Result<void>() : check_survey_date(date, "survey_date");
}

Result<void> check_survey_date(const std::string& date, const std::string& field) {
  if (is_survey_date(date)) return {};
  return fail(ErrorCode::invalid, "Invalid survey date",
              "The date of a survey must be a year, a month or a day, such as 2019, 2019-05 or "
              "2019-05-01.",
              field);
}

bool may_be_within(const std::string& date, const std::string& from, const std::string& to) {
  // The parts that both dates have. ISO 8601 sorts dates of the same length as texts.
  const auto compare = [&date](const std::string& limit) {
    const std::size_t common = std::min(date.size(), limit.size());
    return date.compare(0, common, limit, 0, common);
  };
  return compare(from) >= 0 && compare(to) <= 0;
}

}  // namespace strata
