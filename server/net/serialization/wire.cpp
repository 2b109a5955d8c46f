#include "net/serialization/wire.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>

#include "core/text/csv.h"
#include "expression/expression_parser.h"
#include "mesh/parallel.h"
#include "protocol/problem.h"

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
                 layer.name + " holds keys up to " +
                     std::to_string(static_cast<std::int64_t>(highest_value(layer.type))) + " (" +
                     std::string(name(layer.type)) +
                     "). Records beyond that are painted on a layer of a wider type, u32 at most.",
                 "value"};
    return tl::unexpected(std::move(problem));
  }
  return *bits;
}

bool is_tool(const protocol::ToolShape& shape) {
  const auto* word = std::get_if<std::string>(&shape);
  return !word || (*word != "disc" && *word != "square");
}

// Nothing for discs and squares.
Result<app::FoundTool> tool_of(const protocol::ToolShape& shape, const app::FindTool& find_tool) {
  if (!is_tool(shape)) return app::FoundTool{};
  const std::string ref = protocol::to_ref(shape);
  Result<app::FoundTool> found = find_tool ? find_tool(ref) : fail(ErrorCode::not_found, {}, {});
  if (found || found.error().code != ErrorCode::not_found) return found;
  return fail(ErrorCode::invalid, "Unknown tool",
              "There is no tool `" + ref.substr(0, 100) +
                  "`. `shape` is disc, square, or a tool listed at /api/v1/tools.",
              "shape");
}

// The brush members that EditStroke and StrokeBegin share.
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

Result<room::FillEdit> fill_of(const protocol::EditFill& asked, const Layer& layer) {
  using Mode = protocol::EditFillMode;
  auto bits = STRATA_TRY(value_bits(layer, asked.value, asked.erase));
  room::FillEdit fill;
  fill.erase = asked.erase;
  fill.value_bits = bits;
  if (asked.mode == Mode::where) {
    if (!asked.where)
      return fail(ErrorCode::invalid, "Member missing",
                  "Mode `where` needs a condition, not a place.", "where");
    auto condition = STRATA_TRY(query::parse_condition(*asked.where, "where"));
    if (condition.op != Expression::Op::truth || condition.number == 0)
      fill.region = room::FillEdit::Where{std::move(condition)};
    return fill;
  }
  if (!asked.at)
    return fail(ErrorCode::invalid, "Member missing", "This mode needs a place where it begins.",
                "at");
  room::Place place = place_of(*asked.at);
  if (asked.mode == Mode::island)
    fill.region = room::FillEdit::Island{std::move(place)};
  else
    fill.region = room::FillEdit::Connected{std::move(place)};
  return fill;
}

std::string number(double value) { return csv_number(value, ','); }

nlohmann::json vec3(const glm::dvec3& v) { return nlohmann::json::array({v.x, v.y, v.z}); }
}  // namespace

nlohmann::json bounds_json(const glm::dvec3& low, const glm::dvec3& high) {
  return {{"min", vec3(low)}, {"max", vec3(high)}};
}

room::Place place_of(const protocol::SurfacePlace& place) {
  if (place.point) return *place.point;
  return room::PixelPlace{*place.camera, *place.x, *place.y};
}

bool names_tool(const protocol::Edit& edit) {
  const auto* stroke = std::get_if<protocol::EditStroke>(&edit);
  return stroke && is_tool(stroke->shape);
}
bool names_tool(const protocol::StrokeBegin& begin) { return is_tool(begin.shape); }

double in_model_units(double millimetres, Unit unit) {
  return millimetres * 0.001 / metres_per(unit);
}
double in_millimetres(double length, Unit unit) { return length * metres_per(unit) * 1000; }

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
    request.edit = room::PolygonEdit{
        polygon->erase, *bits, {polygon->camera, polygon->path, polygon->through}};
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
  for (const char* member : {"id", "layer", "stroke"}) tool.record.erase(member);
  return tool;
}

room::EditRequest batch_request(app::StrokeBook::Batch batch, const Uuid& stroke, const Uuid& id,
                                int n, Author author) {
  room::EditRequest request{id, std::move(author), batch.tool.layer_id};
  request.record = std::move(batch.tool.record);
  request.record["n"] = n;
  nlohmann::json path = nlohmann::json::array();
  for (const auto& point : batch.path) path.push_back({point.x, point.y});
  request.record["path"] = std::move(path);
  if (!batch.widths.empty()) request.record["widths"] = batch.widths;
  batch.tool.batch.path = std::move(batch.path);
  batch.tool.batch.widths = std::move(batch.widths);
  request.edit = room::StrokeEdit{std::move(batch.tool.batch), stroke, n};
  return request;
}

Result<room::Highlight> highlight_of(const protocol::Highlight& asked, const Layer& layer,
                                     const std::string& field) {
  if (!layer.table)
    return fail(
        ErrorCode::invalid, "Layer has no records",
        "'" + layer.name + "' holds numbers: only records of database layers can be highlighted.",
        field);
  room::Highlight highlight;
  highlight.isolate = asked.isolate;
  if (asked.filter) {
    auto filter = STRATA_TRY(query::parse_condition(
        *asked.filter, field.empty() ? "filter" : field + ".filter", query::Names::columns));
    highlight.records = std::move(filter);
  } else {
    std::vector<std::uint32_t> keys(asked.keys->begin(), asked.keys->end());
    std::ranges::sort(keys);
    keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
    highlight.records = std::move(keys);
  }
  return highlight;
}

Result<std::vector<room::LookView>> look_views(const room::Room& room,
                                               const std::vector<protocol::LookShown>& asked) {
  std::vector<room::LookView> views;
  for (std::size_t i = 0; i < asked.size(); ++i) {
    const std::string field = "looks[" + std::to_string(i) + "].look";
    auto look = room.look(protocol::to_ref(asked[i].look));
    if (!look) {
      Error problem = look.error();
      problem.field = field;
      return tl::unexpected(std::move(problem));
    }
    for (const room::LookView& other : views)
      if (other.look_id == look->id)
        return fail(ErrorCode::invalid, "Look given twice", "A view shows each look once.", field);
    views.push_back({look->id, asked[i].opacity});
  }
  return views;
}

Result<Background> background_of(const std::optional<protocol::Background>& asked) {
  if (!asked) return Background{};
  const auto top = parse_color(asked->top, "background.top"),
             bottom = parse_color(asked->bottom, "background.bottom");
  if (!top) return tl::unexpected(top.error());
  if (!bottom) return tl::unexpected(bottom.error());
  return Background{*top, *bottom};
}

Result<room::ViewSettings> view_settings(
    const room::Room& room, const std::vector<protocol::LayerOverride>& layers,
    const std::optional<std::vector<protocol::LookShown>>& looks,
    const std::optional<Light>& light) {
  room::ViewSettings settings;
  for (std::size_t i = 0; i < layers.size(); ++i) {
    const protocol::LayerOverride& asked = layers[i];
    const std::string field = "layers[" + std::to_string(i) + "]";
    const auto layer = room.layer(protocol::to_ref(asked.layer));
    if (!layer) {
      Error problem = layer.error();
      problem.field = field + ".layer";
      return tl::unexpected(std::move(problem));
    }
    room::LayerView view{layer->id, asked.visible, asked.opacity, std::nullopt, std::nullopt};
    if (asked.palette) {
      auto palette = STRATA_TRY(palette_from_json(*asked.palette, field + ".palette"));
      view.palette = std::move(palette);
    }
    if (asked.highlight) {
      auto highlight = STRATA_TRY(highlight_of(*asked.highlight, *layer, field + ".highlight"));
      view.highlight = std::move(highlight);
    }
    if (asked.order) view.order = static_cast<int>(*asked.order);
    settings.layers.push_back(std::move(view));
  }
  if (looks) {
    auto shown = STRATA_TRY(look_views(room, *looks));
    settings.looks = std::move(shown);
  }
  if (light) settings.light = *light;
  STRATA_TRY(validate(settings.light));
  return settings;
}

std::optional<app::StrokeBook::End> end_of_path(const nlohmann::json& record) {
  if (!record.is_object()) return std::nullopt;
  const auto path = record.find("path");
  if (path == record.end() || !path->is_array() || path->empty()) return std::nullopt;
  const auto& point = path->back();
  if (!point.is_array() || point.size() != 2 || !point[0].is_number() || !point[1].is_number())
    return std::nullopt;
  app::StrokeBook::End end{{point[0].get<double>(), point[1].get<double>()}};
  const auto widths = record.find("widths");
  if (widths != record.end() && widths->is_array() && !widths->empty() &&
      widths->back().is_number())
    end.width = widths->back().get<double>();
  return end;
}

protocol::SurfacePoint to_protocol(const query::SurfacePoint& point) {
  protocol::SurfacePoint out;
  out.hit = point.hit;
  if (!point.hit) return out;
  out.position = point.position;
  out.normal = glm::dvec3(point.normal);
  out.uv = glm::dvec2(point.uv);
  // as far as the contract goes: a camera may be farther away
  out.distance = std::clamp(point.distance, 0.0, 1e15);
  out.values.emplace();
  for (const auto& value : point.values) {
    protocol::SurfaceValue& entry = (*out.values)[value.layer];
    entry.valid = value.valid;
    // A float layer may hold what JSON cannot carry only if a raster brought it in; such a texel
    // reads as valid, unnamed.
    if (value.valid && std::isfinite(value.value)) entry.value = value.value;
  }
  return out;
}

protocol::Picked to_picked(const query::SurfacePoint& point, const std::optional<std::string>& id) {
  protocol::SurfacePoint surface = to_protocol(point);
  protocol::Picked picked;
  picked.id = id;
  picked.hit = surface.hit;
  picked.position = surface.position;
  picked.normal = surface.normal;
  picked.uv = surface.uv;
  picked.distance = surface.distance;
  picked.values = std::move(surface.values);
  return picked;
}

nlohmann::json to_json(const query::Statistics& statistics) {
  nlohmann::json json{{"texels", statistics.texels}, {"area_m2", statistics.area_m2}};
  if (statistics.texels > 0) {
    json["min"] = statistics.min;
    json["max"] = statistics.max;
    json["mean"] = statistics.mean;
    json["std"] = statistics.std;
  }
  nlohmann::json bins = nlohmann::json::array();
  for (const auto& bin : statistics.histogram)
    bins.push_back(
        {{"from", bin.from}, {"to", bin.to}, {"texels", bin.texels}, {"area_m2", bin.area_m2}});
  json["histogram"] = std::move(bins);
  nlohmann::json keys = nlohmann::json::array();
  for (const auto& [key, entry] : statistics.keys) {
    nlohmann::json of_key{{"key", static_cast<std::int64_t>(key)},  // integer layers only
                          {"texels", entry.texels},
                          {"area_m2", entry.area_m2},
                          {"centroid", vec3(entry.centroid)},
                          {"bounds", bounds_json(entry.bounds_min, entry.bounds_max)}};
    if (entry.pieces) of_key["pieces"] = *entry.pieces;
    if (entry.perimeter_m) of_key["perimeter_m"] = *entry.perimeter_m;
    keys.push_back(std::move(of_key));
  }
  json["keys"] = std::move(keys);
  if (statistics.pieces) json["pieces"] = *statistics.pieces;
  if (statistics.perimeter_m) json["perimeter_m"] = *statistics.perimeter_m;
  if (statistics.quantiles) {
    static constexpr std::array kNames = {"p5", "p25", "p50", "p75", "p95"};
    static_assert(kNames.size() == query::kQuantiles.size());
    for (std::size_t i = 0; i < kNames.size(); ++i)
      json["quantiles"][kNames[i]] = (*statistics.quantiles)[i];
  }
  return json;
}

nlohmann::json to_json(const room::SelectedArea& area) {
  nlohmann::json json{{"resolution", area.resolution},
                      {"texels", area.texels},
                      {"area_m2", area.area_m2},
                      {"share", area.share},
                      {"layers", nlohmann::json::object()}};
  if (area.texels > 0) json["bounds"] = bounds_json(area.bounds_min, area.bounds_max);
  for (const auto& [slug, statistics] : area.layers) json["layers"][slug] = to_json(statistics);
  return json;
}

nlohmann::json to_json(const query::CrossTable& table) {
  const auto keys = [](const std::vector<query::CrossTable::Key>& side) {
    nlohmann::json list = nlohmann::json::array();
    for (const auto& key : side)
      list.push_back(key ? nlohmann::json(static_cast<std::int64_t>(*key)) : nlohmann::json());
    return list;
  };
  return {{"rows", keys(table.rows)},
          {"columns", keys(table.columns)},
          {"area_m2", table.area_m2},
          {"texels", table.texels}};
}

std::string cross_table_csv(const query::CrossTable& table, const std::string& rows,
                            const std::string& columns) {
  const auto key_text = [](const query::CrossTable::Key& key) {
    return key ? number(*key) : std::string("-");
  };
  std::vector<std::string> cells{rows + " / " + columns};
  for (const auto& column : table.columns) cells.push_back(key_text(column));
  std::string text = csv_line(cells, ',');
  for (std::size_t row = 0; row < table.rows.size(); ++row) {
    cells.assign(1, key_text(table.rows[row]));
    for (const double area : table.area_m2[row]) cells.push_back(number(area));
    text += csv_line(cells, ',');
  }
  return text;
}

nlohmann::json to_json(const jobs::JobStatus& job) {
  static constexpr const char* kStates[] = {"queued", "running", "done", "failed", "cancelled"};
  nlohmann::json json{{"id", job.id},
                      {"state", kStates[static_cast<int>(job.state)]},
                      {"progress", job.progress},
                      {"message", job.message}};
  if (job.problem) json["problem"] = protocol::problem_body(*job.problem);
  if (!job.result) return json;
  json["model"] = job.result->model;
  if (!job.result->layers.empty()) json["layers"] = job.result->layers;
  if (job.result->look) json["look"] = *job.result->look;
  if (!job.result->report.is_null()) json["report"] = job.result->report;
  if (const auto& file = job.result->file)
    json["file"] = {{"name", file->name}, {"media_type", file->media_type}, {"bytes", file->bytes}};
  return json;
}

std::string utc_text(std::chrono::system_clock::time_point time) {
  const auto milliseconds =
      std::chrono::duration_cast<std::chrono::milliseconds>(time.time_since_epoch()).count();
  const std::time_t seconds = static_cast<std::time_t>(
      milliseconds >= 0 ? milliseconds / 1000 : (milliseconds - 999) / 1000);
  std::tm utc{};
  gmtime_r(&seconds, &utc);
  char text[40];
  const std::size_t length = std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%S", &utc);
  std::snprintf(text + length, sizeof text - length, ".%03dZ",
                static_cast<int>(milliseconds - std::int64_t{seconds} * 1000));
  return text;
}

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

namespace {

std::string point_header(const std::vector<std::string>& layers) {
  std::vector<std::string> cells{"hit",      "x",        "y",        "z", "normal_x",
                                 "normal_y", "normal_z", "distance", "u", "v"};
  cells.insert(cells.end(), layers.begin(), layers.end());
  return csv_line(cells, ',');
}

// A row is written beside the text and then put there: hundreds of thousands of rows have ten
// numbers each.
class RowWriter {
 public:
  // Of a float no more digits than it has.
  template <class Number>
  void number(Number value) {
    end_ = std::to_chars(end_, digits_.data() + digits_.size(), value).ptr;
  }
  void comma() { *end_++ = ','; }
  // Before more than a number and a comma are written again.
  void move_to(std::string& text) {
    text.append(digits_.data(), end_);
    end_ = digits_.data();
  }

 private:
  std::array<char, 512> digits_;
  char* end_ = digits_.data();
};

void append_point(const query::SurfacePoint& point, const std::vector<std::string>& layers,
                  std::string& text) {
  if (!point.hit) {
    text += "false" + std::string(9 + layers.size(), ',') + "\r\n";
    return;
  }
  text += "true";
  RowWriter row;
  const auto add = [&](auto value) {
    row.comma();
    row.number(value);
  };
  for (int axis = 0; axis < 3; ++axis) add(point.position[axis]);
  for (int axis = 0; axis < 3; ++axis) add(point.normal[axis]);
  add(static_cast<float>(point.distance));
  add(point.uv.x);
  add(point.uv.y);
  row.move_to(text);
  for (const auto& layer : layers) {
    row.comma();
    for (const auto& value : point.values)
      if (value.layer == layer && value.valid) row.number(value.value);
    row.move_to(text);
  }
  text += "\r\n";
}

}  // namespace

std::string points_csv(const std::vector<query::SurfacePoint>& points,
                       const std::vector<std::string>& layers) {
  constexpr std::size_t kPointsAtOnce = 4096;
  std::vector<std::string> parts((points.size() + kPointsAtOnce - 1) / kPointsAtOnce);
  mesh::parallel_for(mesh::background_threads(), static_cast<int>(parts.size()), [&](int number) {
    const auto part = static_cast<std::size_t>(number);
    for (std::size_t i = part * kPointsAtOnce;
         i < std::min(points.size(), (part + 1) * kPointsAtOnce); ++i)
      append_point(points[i], layers, parts[part]);
  });
  std::string text = point_header(layers);
  std::size_t size = text.size();
  for (const std::string& part : parts) size += part.size();
  text.reserve(size);
  for (const std::string& part : parts) text += part;
  return text;
}

std::string profile_csv(const query::Profile& profile, Unit unit,
                        const std::vector<std::string>& layers) {
  std::string text = "along_mm," + point_header(layers);
  for (const auto& sample : profile.samples) {
    text += number(in_millimetres(sample.along, unit)) + ",";
    append_point(sample.point, layers, text);
  }
  return text;
}

nlohmann::json to_json(const query::Profile& profile, Unit unit) {
  nlohmann::json samples = nlohmann::json::array();
  for (const auto& sample : profile.samples)
    samples.push_back({{"along_mm", in_millimetres(sample.along, unit)},
                       {"point", protocol::to_json(to_protocol(sample.point))}});
  return {{"length_mm", in_millimetres(profile.length, unit)}, {"samples", std::move(samples)}};
}

nlohmann::json point_coverage(const query::SurfacePoint& point, const std::vector<Layer>& layers,
                              const Model& model) {
  nlohmann::json parameters = nlohmann::json::object(), ranges = nlohmann::json::object();
  for (const auto& layer : layers) {
    nlohmann::json parameter{{"type", "Parameter"},
                             {"observedProperty", {{"label", {{"en", layer.name}}}}}};
    if (!layer.description.empty()) parameter["description"] = {{"en", layer.description}};
    if (!layer.unit.empty()) parameter["unit"] = {{"symbol", layer.unit}};
    parameters[layer.slug] = std::move(parameter);
    nlohmann::json value;
    for (const auto& entry : point.values)
      if (entry.layer == layer.slug && entry.valid) value = entry.value;
    ranges[layer.slug] = {{"type", "NdArray"},
                          {"dataType", is_float(layer.type) ? "float" : "integer"},
                          {"values", {value}}};
  }
  nlohmann::json system{{"type", "GeographicCRS"}};
  if (model.crs.starts_with("EPSG:"))
    system["id"] = "http://www.opengis.net/def/crs/EPSG/0/" + model.crs.substr(5);
  auto axis = [&](double value) { return nlohmann::json{{"values", {value}}}; };
  return {{"type", "Coverage"},
          {"domain",
           {{"type", "Domain"},
            {"domainType", "Point"},
            {"axes",
             {{"x", axis(point.position.x)},
              {"y", axis(point.position.y)},
              {"z", axis(point.position.z)}}},
            {"referencing", {{{"coordinates", {"x", "y", "z"}}, {"system", system}}}}}},
          {"parameters", parameters},
          {"ranges", ranges}};
}

}  // namespace strata::net
