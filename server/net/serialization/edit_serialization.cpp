#include "net/serialization/edit_serialization.h"

#include <utility>

#include "domain/layers/layer.h"
#include "domain/scene/model.h"
#include "domain/scene/units.h"
#include "expression/expression_parser.h"
#include "protocol/parse.h"

namespace strata::net {
namespace {

Result<std::uint32_t> value_bits(const Layer& layer, double value, bool erase) {
  if (erase) return 0u;
  auto bits = encode_value(layer.type, value);
  if (!bits) {
    Error problem = bits.error();
    problem.field = "value";
    if (layer.kind == LayerKind::database && value > highest_value(layer.type))
      problem = {ErrorCode::invalid, "Key too large",
                 layer.name + " can store keys up to " +
                     std::to_string(static_cast<std::int64_t>(highest_value(layer.type))) + " (" +
                     std::string(name(layer.type)) +
                     "). For larger keys, use a layer of a wider type, up to u32.",
                 "value"};
    return tl::unexpected(std::move(problem));
  }
  return *bits;
}

bool is_tool(const protocol::ToolShape& shape) {
  const auto* word = std::get_if<std::string>(&shape);
  return !word || (*word != "disc" && *word != "square");
}

// Returns an empty tool for discs and squares.
Result<app::FoundTool> tool_of(const protocol::ToolShape& shape, const app::FindTool& find_tool) {
  if (!is_tool(shape)) return app::FoundTool{};
  const std::string ref = protocol::to_ref(shape);
  Result<app::FoundTool> found = find_tool ? find_tool(ref) : fail(ErrorCode::not_found, {}, {});
  if (found || found.error().code != ErrorCode::not_found) return found;
  return fail(ErrorCode::invalid, "Unknown tool",
              "There is no tool `" + ref.substr(0, 100) +
                  "`. `shape` must be disc, square, or a tool from /api/v1/tools.",
              "shape");
}

// Reads the members for the brush, which EditStroke and StrokeBegin share.
template <class Stroke>
Result<StrokeBatch> brush_of(const Stroke& stroke, const Layer& layer, const Model& model,
                             const app::FoundTool& tool) {
  auto bits = STRATA_TRY(value_bits(layer, stroke.value, stroke.erase));
  StrokeBatch batch;
  batch.camera = stroke.camera;
  batch.shape = tool.shape                                      ? ToolShape::texture
                : stroke.shape == protocol::ToolShape("square") ? ToolShape::square
                                                                : ToolShape::disc;
  batch.texture = tool.shape;
  if (stroke.radius_px)
    batch.radius_px = *stroke.radius_px;
  else if (stroke.radius_mm)
    batch.radius_world = in_model_units(*stroke.radius_mm, model.unit);
  batch.through = stroke.through;
  batch.fixed_depth_bias = stroke.depth_bias;
  batch.max_angle_deg = stroke.max_angle_deg;
  batch.erase = stroke.erase;
  batch.value_bits = bits;
  return batch;
}

Result<room::FillEdit> fill_of(const protocol::EditFill& body, const Layer& layer) {
  using Mode = protocol::EditFillMode;
  auto bits = STRATA_TRY(value_bits(layer, body.value, body.erase));
  room::FillEdit fill;
  fill.erase = body.erase;
  fill.value_bits = bits;
  if (body.mode == Mode::where) {
    if (!body.where)
      return fail(ErrorCode::invalid, "Member missing",
                  "The mode `where` requires a condition, not a position.", "where");
    auto condition = STRATA_TRY(query::parse_condition(*body.where, "where"));
    if (condition.op != Expression::Op::truth || condition.number == 0)
      fill.region = room::FillEdit::Where{std::move(condition)};
    return fill;
  }
  if (!body.at)
    return fail(ErrorCode::invalid, "Member missing",
                "This mode requires `at`, the position where the fill begins.", "at");
  room::Place place = place_of(*body.at);
  if (body.mode == Mode::island)
    fill.region = room::FillEdit::Island{std::move(place)};
  else
    fill.region = room::FillEdit::Connected{std::move(place)};
  return fill;
}

}  // namespace

room::Place place_of(const protocol::SurfacePlace& place) {
  if (place.point) return *place.point;
  return room::PixelPlace{*place.camera, *place.x, *place.y};
}

Result<room::Outline> outline_of(const Camera& camera, const protocol::Outline& path, bool through,
                                 const std::optional<std::vector<protocol::OutlineStep>>& steps) {
  room::Outline outline{camera, path, through};
  std::size_t points = path.size();
  for (const auto& step : steps.value_or(std::vector<protocol::OutlineStep>{})) {
    using Combine = protocol::Combination;
    const room::Combination combination =
        step.combine == Combine::subtract    ? room::Combination::subtract
        : step.combine == Combine::intersect ? room::Combination::intersect
                                             : room::Combination::add;
    points += step.path.size();
    outline.steps.push_back({combination, step.camera, step.path, step.through});
  }
  if (points > kMaxOutlinePoints)
    return fail(ErrorCode::invalid, "Too many points",
                "The outlines of a selection can have at most " +
                    std::to_string(kMaxOutlinePoints) + " points in total. Draw simpler outlines.",
                "steps");
  return outline;
}

bool names_tool(const protocol::Edit& edit) {
  const auto* stroke = std::get_if<protocol::EditStroke>(&edit);
  return stroke && is_tool(stroke->shape);
}

bool names_tool(const protocol::StrokeBegin& begin) { return is_tool(begin.shape); }

Result<room::EditRequest> edit_request(const protocol::Edit& edit, const Layer& layer,
                                       const Model& model, const Uuid& id, Author author,
                                       const app::FindTool& find_tool) {
  room::EditRequest request{id, std::move(author), layer.id};
  request.record = protocol::to_json(edit);
  if (const auto* stroke = std::get_if<protocol::EditStroke>(&edit)) {
    auto tool = tool_of(stroke->shape, find_tool);
    if (!tool) return tl::unexpected(tool.error());
    auto batch = STRATA_TRY(brush_of(*stroke, layer, model, *tool));
    if (tool->shape) request.record["shape"] = tool->id;
    batch.path.assign(stroke->path.begin(), stroke->path.end());
    if (stroke->widths) batch.widths.assign(stroke->widths->begin(), stroke->widths->end());
    request.edit = room::StrokeEdit{std::move(batch), id, 0};
    return request;
  }
  if (const auto* polygon = std::get_if<protocol::EditPolygon>(&edit)) {
    auto bits = value_bits(layer, polygon->value, polygon->erase);
    if (!bits) return tl::unexpected(bits.error());
    auto outline =
        STRATA_TRY(outline_of(polygon->camera, polygon->path, polygon->through, polygon->steps));
    request.edit = room::PolygonEdit{polygon->erase, *bits, std::move(outline)};
    return request;
  }
  auto fill = STRATA_TRY(fill_of(std::get<protocol::EditFill>(edit), layer));
  request.edit = std::move(fill);
  return request;
}

Result<app::StrokeTool> stroke_tool(const protocol::StrokeBegin& begin, const Layer& layer,
                                    const Model& model, const app::FindTool& find_tool) {
  auto found = STRATA_TRY(tool_of(begin.shape, find_tool));
  auto batch = STRATA_TRY(brush_of(begin, layer, model, found));
  app::StrokeTool tool;
  tool.layer_id = layer.id;
  tool.batch = std::move(batch);
  tool.record = protocol::to_json(begin);
  tool.record["op"] = "stroke";
  if (found.shape) tool.record["shape"] = found.id;
  tool.trace = continued_trace(begin.traceparent.value_or("")).trace;
  for (const char* member : {"id", "layer", "stroke", "traceparent"}) tool.record.erase(member);
  return tool;
}

room::EditRequest batch_request(app::StrokeTracker::Batch batch, const Uuid& stroke, const Uuid& id,
                                int n, Author author) {
  room::EditRequest request{id, std::move(author), batch.tool.layer_id};
  request.record = std::move(batch.tool.record);
  request.record["n"] = n;
  request.trace = batch.tool.trace;
  nlohmann::json path = nlohmann::json::array();
  for (const auto& point : batch.path) path.push_back({point.x, point.y});
  request.record["path"] = std::move(path);
  if (!batch.widths.empty()) request.record["widths"] = batch.widths;
  batch.tool.batch.path = std::move(batch.path);
  batch.tool.batch.widths = std::move(batch.widths);
  request.edit = room::StrokeEdit{std::move(batch.tool.batch), stroke, n};
  return request;
}

std::optional<app::StrokeTracker::End> end_of_path(const nlohmann::json& record) {
  if (!record.is_object()) return std::nullopt;
  const auto path = record.find("path");
  if (path == record.end() || !path->is_array() || path->empty()) return std::nullopt;
  const auto& point = path->back();
  if (!point.is_array() || point.size() != 2 || !point[0].is_number() || !point[1].is_number())
    return std::nullopt;
  app::StrokeTracker::End end{{point[0].get<double>(), point[1].get<double>()}};
  const auto widths = record.find("widths");
  if (widths != record.end() && widths->is_array() && !widths->empty() &&
      widths->back().is_number())
    end.width = widths->back().get<double>();
  return end;
}

}  // namespace strata::net
