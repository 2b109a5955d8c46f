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

// Converts edits between the protocol and the domain. Refuses values outside the type of the layer
// instead of clamping them.
namespace strata::net {

// Returns whether the brush is a tool of the site. The conversion then calls `find_tool`.
bool names_tool(const protocol::Edit& edit);
bool names_tool(const protocol::StrokeBegin& begin);

// Converts `edit` to an edit of the layer. Its `record` is the request, with the id of the tool
// instead of the slug. Refuses a missing tool (invalid, `shape`). Without `find_tool`, refuses
// every tool.
Result<room::EditRequest> edit_request(const protocol::Edit& edit, const Layer& layer,
                                       const Model& model, const Uuid& id, Author author,
                                       const app::FindTool& find_tool = {});
Result<app::StrokeTool> stroke_tool(const protocol::StrokeBegin& begin, const Layer& layer,
                                    const Model& model, const app::FindTool& find_tool = {});
room::EditRequest batch_request(app::StrokeTracker::Batch batch, const Uuid& stroke, const Uuid& id,
                                int n, Author author);

// Returns the end of the path of a stroke's batch from the journal record of the batch. Returns
// nothing for a record of a different kind.
std::optional<app::StrokeTracker::End> end_of_path(const nlohmann::json& record);

room::Place place_of(const protocol::SurfacePlace& place);
// `outline_of` refuses too many points (invalid, `steps`).
constexpr std::size_t kMaxOutlinePoints = 16384;  // of an outline and its steps in total
Result<room::Outline> outline_of(const Camera& camera, const protocol::Outline& path, bool through,
                                 const std::optional<std::vector<protocol::OutlineStep>>& steps);

}  // namespace strata::net
