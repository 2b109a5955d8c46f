#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "app/records/sheet.h"
#include "app/services.h"
#include "core/error.h"
#include "domain/layers/layer.h"
#include "domain/people/role.h"
#include "domain/scene/surveyed_object.h"
#include "query/statistics/statistics.h"
#include "room/queries.h"

// The statistics of one layer in each survey of an object.
namespace strata::app {

// A class of the layer, or a record whose key is painted.
struct SurveyClass {
  std::int64_t key = 0;
  std::string name;  // of the record, or the label in the legend, or else the key
  std::uint64_t texels = 0;
  double area_m2 = 0;
  std::optional<std::uint64_t> pieces{};  // if requested
  std::optional<double> perimeter_m{};    // if requested
};

// The layer in one survey.
struct SurveyLayer {
  Layer layer;
  std::int64_t sequence = 0;     // of the model: the state that was counted
  double surface_m2 = 0;         // area of the whole model
  query::Statistics statistics;  // without the histogram and the keys
  // Sorted by key. nullopt if the values are not classes, and if the surveys have too many classes.
  std::optional<std::vector<SurveyClass>> classes{};

  double share() const;  // fraction of the whole surface
};

struct SurveyStatistics {
  Survey survey;
  std::optional<SurveyLayer> layer;  // nullopt if the role sees no such layer
};

struct SurveyStatisticsRequest {
  std::string layer;                  // the name or the slug
  room::StatisticsOptions options{};  // `seen` and `painted` have no effect
  std::string from{}, to{};           // the period (may_be_within)
  Role seen_by = Role::viewer;        // in the project of the object
  std::string language{};             // of the labels of terms
};

constexpr std::size_t kMaxSurveysAtOnce = 100;
// Different names of classes in all surveys together. With more, no survey lists its classes.
constexpr std::size_t kMaxSurveyClasses = 1024;

// Returns whether the values of the layer are classes or keys of records. Their mean has no
// meaning.
bool holds_classes(const Layer& layer);

// Returns the layer with this name or else with this slug, or nullptr.
const Layer* named_layer(const std::vector<Layer>& layers, const std::string& name);

// Returns the surveys in the period, sorted by date. Opens the models one after another, and only
// those where the layer is painted. Returns an `invalid` error that names `from` for too many
// surveys, and one that names `layer` if the role sees the layer in no survey. A layer that the
// role does not see and a missing layer have the same result. Blocks.
Result<std::vector<SurveyStatistics>> survey_statistics(const Services& services,
                                                        const SurveyedObject& object,
                                                        const SurveyStatisticsRequest& request);

// Returns a table with a row for each survey and a column of areas for each class. Cells of surveys
// without the layer are empty.
Sheet survey_statistics_sheet(const std::vector<SurveyStatistics>& surveys);

}  // namespace strata::app
