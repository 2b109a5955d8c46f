#pragma once

#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "app/strokes/stroke_book.h"
#include "app/strokes/tool_shelf.h"
#include "domain/layers/layer.h"
#include "domain/scene/model.h"
#include "jobs/job_queue.h"
#include "protocol/parse.h"
#include "query/sampling/values.h"
#include "query/statistics/statistics.h"
#include "room/room.h"
#include "store/journal/journal.h"
#include "store/people/groups.h"

// Between the protocol's values and the domain's. Values outside a layer's type are refused, not
// clamped.
namespace strata::net {

// Millimetres on the object in the model's unit.
double in_model_units(double millimetres, Unit unit);
double in_millimetres(double length, Unit unit);

// Whether the brush is a tool of the site, so that `find_tool` will be called.
bool names_tool(const protocol::Edit& edit);
bool names_tool(const protocol::StrokeBegin& begin);

// `edit` for the layer; its `record` is the edit as asked, with a tool's id in place of its slug. A
// tool that is not there is refused (422, `shape`); without `find_tool`, any.
Result<room::EditRequest> edit_request(const protocol::Edit& edit, const Layer& layer,
                                       const Model& model, const Uuid& id, Author author,
                                       const app::FindTool& find_tool = {});
Result<app::StrokeTool> stroke_tool(const protocol::StrokeBegin& begin, const Layer& layer,
                                    const Model& model, const app::FindTool& find_tool = {});
room::EditRequest batch_request(app::StrokeBook::Batch batch, const Uuid& stroke, const Uuid& id,
                                int n, Author author);

room::Place place_of(const protocol::SurfacePlace& place);

// The looks that a view asks for; 404 or 422 with the field's name for one that is not there or
// comes twice.
Result<std::vector<room::LookView>> look_views(const room::Room& room,
                                               const std::vector<protocol::LookShown>& asked);
// What a view shows; refused as those, with the fields of layers, looks and light.
Result<room::ViewSettings> view_settings(
    const room::Room& room, const std::vector<protocol::LayerOverride>& layers,
    const std::optional<std::vector<protocol::LookShown>>& looks,
    const std::optional<Light>& light);
Result<Background> background_of(const std::optional<protocol::Background>& asked);

// Of a layer of records, for `field`; the filter's columns are found when it is first drawn.
Result<room::Highlight> highlight_of(const protocol::Highlight& asked, const Layer& layer,
                                     const std::string& field);

// Where the path of a stroke's batch ended, from its journal record; nothing when the record is of
// another kind.
std::optional<app::StrokeBook::End> end_of_path(const nlohmann::json& record);

protocol::SurfacePoint to_protocol(const query::SurfacePoint& point);
protocol::Picked to_picked(const query::SurfacePoint& point, const std::optional<std::string>& id);
nlohmann::json bounds_json(const glm::dvec3& low, const glm::dvec3& high);
nlohmann::json to_json(const query::Statistics& statistics);
nlohmann::json to_json(const room::SelectedArea& area);
nlohmann::json to_json(const query::CrossTable& table);
nlohmann::json to_json(const query::Profile& profile, Unit unit);
// Areas in m²: a line a row's value, a column a column's, `-` where a layer has none; the corner
// names both layers.
std::string cross_table_csv(const query::CrossTable& table, const std::string& rows,
                            const std::string& columns);
nlohmann::json to_json(const jobs::JobStatus& job);
nlohmann::json to_json(const store::ProjectGroup& group);
nlohmann::json to_json(const store::JournalRow& row);
nlohmann::json to_json(const store::ReviewQueue& queue);
std::string utc_text(std::chrono::system_clock::time_point time);  // RFC 3339 with milliseconds

// Answers of many points in the formats of GET …/position and POST …/positions. `layers`: slugs,
// one column each.
std::string points_csv(const std::vector<query::SurfacePoint>& points,
                       const std::vector<std::string>& layers);
// With a column `along_mm` before those of points.
std::string profile_csv(const query::Profile& profile, Unit unit,
                        const std::vector<std::string>& layers);
nlohmann::json point_coverage(const query::SurfacePoint& point, const std::vector<Layer>& layers,
                              const Model& model);

}  // namespace strata::net
