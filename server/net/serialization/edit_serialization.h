#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>

#include "app/strokes/brush_shape_cache.h"
#include "app/strokes/stroke_tracker.h"
#include "core/error.h"
#include "core/uuid.h"
#include "protocol/parse.h"
#include "room/edit.h"
#include "room/place.h"

namespace strata {
struct Layer;
struct Model;
}  // namespace strata

// Converts edits between the protocol and the domain. Values outside a layer's type are refused,
// not clamped.
namespace strata::net {

// Whether the brush is a tool of the site, so that the conversion calls `find_tool`.
bool names_tool(const protocol::Edit& edit);
bool names_tool(const protocol::StrokeBegin& begin);

// Converts `edit` for the layer; its `record` is the request with a tool's id instead of its slug.
// Refuses a missing tool (invalid, `shape`); without `find_tool`, every tool.
Result<room::EditRequest> edit_request(const protocol::Edit& edit, const Layer& layer,
                                       const Model& model, const Uuid& id, Author author,
                                       const app::FindTool& find_tool = {});
Result<app::StrokeTool> stroke_tool(const protocol::StrokeBegin& begin, const Layer& layer,
                                    const Model& model, const app::FindTool& find_tool = {});
room::EditRequest batch_request(app::StrokeTracker::Batch batch, const Uuid& stroke, const Uuid& id,
                                int n, Author author);

// Returns the end of the path of a stroke's batch, from its journal record; nothing if the record
// is of another kind.
std::optional<app::StrokeTracker::End> end_of_path(const nlohmann::json& record);

room::Place place_of(const protocol::SurfacePlace& place);
// Refused (invalid, `steps`): too many points.
constexpr std::size_t kMaxOutlinePoints = 16384;  // of an outline and its steps together
Result<room::Outline> outline_of(const Camera& camera, const protocol::Outline& path, bool through,
                                 const std::optional<std::vector<protocol::OutlineStep>>& steps);

}  // namespace strata::net
