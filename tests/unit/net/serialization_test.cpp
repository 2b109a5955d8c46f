#include <gtest/gtest.h>

#include "core/text/timestamp.h"
#include "domain/scene/model.h"
#include "domain/scene/units.h"
#include "jobs/job_queue.h"
#include "net/serialization/edit_serialization.h"
#include "net/serialization/job_serialization.h"
#include "net/serialization/point_serialization.h"
#include "net/serialization/statistics_serialization.h"
#include "query/statistics/statistics.h"
#include "room/queries.h"
#include "support/shapes.h"

namespace strata::net {
namespace {

const Author kAnna("anna", Role::annotator);

Layer layer_of(ValueType type) {
  Layer layer;
  layer.id = 5;
  layer.slug = "cracks";
  layer.type = type;
  return layer;
}

Model model_in(Unit unit) {
  Model model;
  model.id = 1;
  model.unit = unit;
  return model;
}

Camera camera() {
  Camera made;
  made.width = 640;
  made.height = 480;
  return made;
}

protocol::Edit stroke(double value) {
  protocol::EditStroke edit;
  edit.value = value;
  edit.camera = camera();
  edit.radius_px = 12.0;
  edit.path = {{1, 2}, {3, 4}};
  return edit;
}

TEST(Wire, a_stroke_becomes_an_edit_of_the_layer) {
  const Uuid id = random_uuid();
  const auto request =
      edit_request(stroke(7), layer_of(ValueType::u8), model_in(Unit::m), id, kAnna);
  ASSERT_TRUE(request);
  EXPECT_EQ(request->id, id);
  EXPECT_EQ(request->author.user, "anna");
  EXPECT_EQ(request->author.role, Role::annotator);
  EXPECT_EQ(request->layer_id, LayerId(5));
  const auto& edit = std::get<room::StrokeEdit>(request->edit);
  EXPECT_EQ(edit.stroke, id);
  EXPECT_EQ(edit.batch.value_bits, 7u);
  EXPECT_EQ(edit.batch.radius_px, 12);
  EXPECT_EQ(edit.batch.path.size(), 2u);
  EXPECT_EQ(edit.batch.path[1], glm::dvec2(3, 4));
  EXPECT_EQ(edit.batch.camera, camera());
  EXPECT_EQ(request->record["op"], "stroke");
}

TEST(Wire, a_value_outside_the_type_is_refused_not_clamped) {
  for (double value : {256.0, -1.0, 1.5}) {
    const auto request = edit_request(stroke(value), layer_of(ValueType::u8), model_in(Unit::m),
                                      random_uuid(), kAnna);
    ASSERT_FALSE(request) << value;
    EXPECT_EQ(request.error().field, "value");
  }
  EXPECT_TRUE(
      edit_request(stroke(1.5), layer_of(ValueType::f16), model_in(Unit::m), random_uuid(), kAnna));
}

TEST(Wire, erasing_needs_no_value_of_the_type) {
  protocol::EditStroke edit = std::get<protocol::EditStroke>(stroke(-400));
  edit.erase = true;
  const auto request =
      edit_request(edit, layer_of(ValueType::u8), model_in(Unit::m), random_uuid(), kAnna);
  ASSERT_TRUE(request);
  EXPECT_TRUE(std::get<room::StrokeEdit>(request->edit).batch.erase);
}

TEST(Wire, millimetres_become_the_models_unit) {
  EXPECT_DOUBLE_EQ(in_model_units(25, Unit::mm), 25);
  EXPECT_DOUBLE_EQ(in_model_units(25, Unit::cm), 2.5);
  EXPECT_DOUBLE_EQ(in_model_units(25, Unit::m), 0.025);
  protocol::EditStroke edit = std::get<protocol::EditStroke>(stroke(1));
  edit.radius_px.reset();
  edit.radius_mm = 10.0;
  const auto request =
      edit_request(edit, layer_of(ValueType::u8), model_in(Unit::cm), random_uuid(), kAnna);
  ASSERT_TRUE(request);
  EXPECT_EQ(std::get<room::StrokeEdit>(request->edit).batch.radius_px, 0);
  EXPECT_DOUBLE_EQ(std::get<room::StrokeEdit>(request->edit).batch.radius_world, 1);
}

TEST(Wire, a_fill_carries_the_bits_of_its_value) {
  protocol::EditFill fill;
  fill.value = -1;
  fill.where = "true";
  const auto request =
      edit_request(fill, layer_of(ValueType::i8), model_in(Unit::m), random_uuid(), kAnna);
  ASSERT_TRUE(request);
  EXPECT_EQ(std::get<room::FillEdit>(request->edit).value_bits, 0xffu);
  EXPECT_EQ(request->record["op"], "fill");
}

Result<room::EditRequest> request_of(const protocol::Edit& edit) {
  return edit_request(edit, layer_of(ValueType::u8), model_in(Unit::m), random_uuid(), kAnna);
}

TEST(Wire, a_fill_is_of_the_region_that_its_mode_tells) {
  using room::FillEdit;
  protocol::EditFill fill;
  fill.where = "true";
  EXPECT_TRUE(std::holds_alternative<FillEdit::Everywhere>(
      std::get<FillEdit>(request_of(fill)->edit).region));
  fill.where = "wet > 3";
  const auto where = request_of(fill);
  ASSERT_TRUE(where);
  const auto& condition =
      std::get<FillEdit::Where>(std::get<FillEdit>(where->edit).region).condition;
  EXPECT_EQ(condition.op, Expression::Op::greater);
  EXPECT_EQ(where->record["where"], "wet > 3");
  fill.where.reset();
  fill.at.emplace();
  fill.at->point = glm::dvec3(1, 2, 3);
  fill.mode = protocol::EditFillMode::island;
  const auto island = request_of(fill);
  EXPECT_EQ(
      std::get<glm::dvec3>(std::get<FillEdit::Island>(std::get<FillEdit>(island->edit).region).at),
      glm::dvec3(1, 2, 3));
  fill.at->point.reset();
  fill.at->camera = camera();
  fill.at->x = 4;
  fill.at->y = 5;
  fill.mode = protocol::EditFillMode::connected;
  const auto connected = request_of(fill);
  const auto& at = std::get<FillEdit::Connected>(std::get<FillEdit>(connected->edit).region).at;
  EXPECT_EQ(std::get<room::PixelPlace>(at).camera, camera());
  EXPECT_EQ(std::get<room::PixelPlace>(at).y, 5);
}

TEST(Wire, a_fill_that_lacks_what_its_mode_needs_is_refused) {
  protocol::EditFill fill;
  fill.where = "wet >";
  EXPECT_EQ(request_of(fill).error().field, "where");
  fill.mode = protocol::EditFillMode::island;
  EXPECT_EQ(request_of(fill).error().field, "at");
  fill.where.reset();
  fill.at.emplace();
  fill.at->point = glm::dvec3(1, 2, 3);
  fill.mode = protocol::EditFillMode::where;
  EXPECT_EQ(request_of(fill).error().field, "where");
}

TEST(Wire, a_polygon_becomes_an_edit) {
  protocol::EditPolygon polygon;
  polygon.value = 300;
  polygon.camera = camera();
  polygon.path = {{1, 2}, {3, 4}, {5, 0}};
  polygon.through = true;
  EXPECT_EQ(request_of(polygon).error().field, "value");
  polygon.value = 200;
  const auto request = request_of(polygon);
  ASSERT_TRUE(request);
  const auto& edit = std::get<room::PolygonEdit>(request->edit);
  EXPECT_EQ(edit.value_bits, 200u);
  EXPECT_EQ(edit.outline.path.size(), 3u);
  EXPECT_TRUE(edit.outline.through);
  EXPECT_EQ(request->record["op"], "polygon");
}

TEST(Wire, further_outlines_of_a_polygon_keep_their_cameras_and_their_order) {
  protocol::EditPolygon polygon;
  polygon.value = 200;
  polygon.camera = camera();
  polygon.path = {{1, 2}, {3, 4}, {5, 0}};
  protocol::OutlineStep step;
  step.camera = camera();
  step.path = {{7, 8}, {9, 4}, {5, 0}};
  step.through = true;
  polygon.steps.emplace();
  using protocol::Combination;
  for (const auto combine : {Combination::subtract, Combination::intersect, Combination::add}) {
    step.combine = combine;
    polygon.steps->push_back(step);
  }
  const auto request = request_of(polygon);
  ASSERT_TRUE(request);
  const auto& steps = std::get<room::PolygonEdit>(request->edit).outline.steps;
  ASSERT_EQ(steps.size(), 3u);
  EXPECT_EQ(steps[0].combination, room::Combination::subtract);
  EXPECT_EQ(steps[1].combination, room::Combination::intersect);
  EXPECT_EQ(steps[2].combination, room::Combination::add);
  EXPECT_EQ(steps[0].path, step.path);
  EXPECT_TRUE(steps[0].through);
  EXPECT_EQ(request->record["steps"].size(), 3u);
  polygon.steps->front().path.resize(kMaxOutlinePoints, {1, 1});
  EXPECT_EQ(request_of(polygon).error().field, "steps");
}

TEST(Wire, a_batch_keeps_in_the_journal_all_that_made_it) {
  protocol::StrokeBegin begin;
  begin.id = random_uuid();
  begin.stroke = random_uuid();
  begin.layer = std::string("cracks");
  begin.value = 3;
  begin.camera = camera();
  begin.radius_px = 4.0;
  auto tool = stroke_tool(begin, layer_of(ValueType::u8), model_in(Unit::m));
  ASSERT_TRUE(tool);
  const Uuid id = random_uuid();
  const auto request = batch_request({*tool, {{1, 1}, {2, 3}}}, begin.stroke, id, 4, kAnna);
  const auto& edit = std::get<room::StrokeEdit>(request.edit);
  EXPECT_EQ(edit.stroke, begin.stroke);
  EXPECT_EQ(edit.n, 4);
  EXPECT_EQ(edit.batch.value_bits, 3u);
  EXPECT_EQ(request.record["op"], "stroke");
  EXPECT_EQ(request.record["n"], 4);
  EXPECT_EQ(request.record["radius_px"], 4);
  EXPECT_EQ(request.record["camera"]["width"], 640);
  EXPECT_FALSE(request.record.contains("id"));
  EXPECT_EQ(end_of_path(request.record), (app::StrokeTracker::End{{2, 3}}));
  auto pressed = request.record;
  pressed["widths"] = {0.5, 0.25};
  EXPECT_EQ(end_of_path(pressed), (app::StrokeTracker::End{{2, 3}, 0.25}));
}

TEST(Wire, a_tool_of_the_site_gives_its_shape_and_its_id_to_the_record) {
  const auto shape = test::shape(test::in_flag);
  std::string requested;
  const app::FindTool find = [&](const std::string& ref) -> Result<app::FoundTool> {
    requested = ref;
    if (ref == "gone") return fail(ErrorCode::unavailable, "Database unavailable", "Wait.");
    if (ref != "flag" && ref != "12")
      return fail(ErrorCode::not_found, "Not found", "There is no such tool.");
    return app::FoundTool{12, shape};
  };
  auto edit = stroke(1);
  const auto with_shape = [&](const protocol::ToolShape& of) {
    std::get<protocol::EditStroke>(edit).shape = of;
    return edit_request(edit, layer_of(ValueType::u8), model_in(Unit::m), random_uuid(), kAnna,
                        find);
  };
  for (const protocol::ToolShape& of :
       {protocol::ToolShape("flag"), protocol::ToolShape(std::int64_t{12})}) {
    const auto request = with_shape(of);
    ASSERT_TRUE(request);
    EXPECT_TRUE(names_tool(edit));
    const auto& batch = std::get<room::StrokeEdit>(request->edit).batch;
    EXPECT_EQ(batch.shape, ToolShape::texture);
    EXPECT_EQ(batch.texture, shape);
    EXPECT_EQ(request->record["shape"], 12) << "whatever becomes of its slug";
  }
  EXPECT_EQ(with_shape("star").error().code, ErrorCode::invalid);
  EXPECT_EQ(with_shape("star").error().field, "shape");
  EXPECT_EQ(with_shape("gone").error().code, ErrorCode::unavailable);
  requested.clear();
  const auto square = with_shape("square");
  EXPECT_FALSE(names_tool(edit));
  EXPECT_EQ(std::get<room::StrokeEdit>(square->edit).batch.shape, ToolShape::square);
  EXPECT_EQ(square->record["shape"], "square");
  EXPECT_EQ(requested, "");

  protocol::StrokeBegin begin;
  begin.camera = camera();
  begin.radius_px = 4.0;
  begin.shape = "flag";
  const auto tool = stroke_tool(begin, layer_of(ValueType::u8), model_in(Unit::m), find);
  ASSERT_TRUE(tool);
  EXPECT_EQ(tool->batch.texture, shape);
  EXPECT_EQ(tool->record["shape"], 12);
  EXPECT_EQ(stroke_tool(begin, layer_of(ValueType::u8), model_in(Unit::m)).error().field, "shape");
}

TEST(Wire, bias_and_angle_of_a_stroke_are_optional) {
  auto edit = stroke(1);
  const auto batch = [&] {
    auto request =
        edit_request(edit, layer_of(ValueType::u8), model_in(Unit::m), random_uuid(), kAnna);
    return std::pair(std::get<room::StrokeEdit>(request->edit).batch, request->record);
  };
  EXPECT_FALSE(batch().first.fixed_depth_bias || batch().first.max_angle_deg);
  EXPECT_FALSE(batch().second.contains("depth_bias") || batch().second.contains("max_angle_deg"));
  std::get<protocol::EditStroke>(edit).depth_bias = 2e-4;
  std::get<protocol::EditStroke>(edit).max_angle_deg = 60.0;
  EXPECT_EQ(batch().first.fixed_depth_bias, 2e-4);
  EXPECT_EQ(batch().first.max_angle_deg, 60.0);
  EXPECT_EQ(batch().second["depth_bias"], 2e-4);
  EXPECT_EQ(batch().second["max_angle_deg"], 60.0);
}

TEST(Wire, the_end_of_a_path_is_found_only_in_strokes) {
  EXPECT_FALSE(end_of_path({{"op", "fill"}}));
  EXPECT_FALSE(end_of_path({{"path", nlohmann::json::array()}}));
  EXPECT_FALSE(end_of_path({{"path", {{1, "x"}}}}));
  EXPECT_FALSE(end_of_path(nullptr));
}

query::SurfacePoint point() {
  query::SurfacePoint made;
  made.hit = true;
  made.position = {1.5, 2, 3};
  made.normal = {0, 0, 1};
  made.distance = 0.25;
  made.uv = {0.5f, 0.25f};
  made.values = {{"cracks", true, 4}, {"a,b", false, 0}};
  return made;
}

TEST(Wire, a_surface_point_reads_as_the_contract_says) {
  const auto json = protocol::to_json(to_protocol(point()));
  EXPECT_TRUE(protocol::validate(protocol::Schema::SurfacePoint, json));
  EXPECT_EQ(json["values"]["cracks"]["value"], 4);
  EXPECT_EQ(json["values"]["a,b"]["valid"], false);
  EXPECT_FALSE(json["values"]["a,b"].contains("value"));
  const auto miss = protocol::to_json(to_protocol(query::SurfacePoint{}));
  EXPECT_TRUE(protocol::validate(protocol::Schema::SurfacePoint, miss));
  EXPECT_FALSE(miss.contains("position"));
}

TEST(Wire, points_as_csv_have_a_column_for_each_layer) {
  const std::string text = points_csv({point(), query::SurfacePoint{}}, {"cracks", "a,b"});
  EXPECT_EQ(text,
            "hit,x,y,z,normal_x,normal_y,normal_z,distance,u,v,cracks,\"a,b\"\r\n"
            "true,1.5,2,3,0,0,1,0.25,0.5,0.25,4,\r\n"
            "false,,,,,,,,,,,\r\n");
}

TEST(Wire, a_coverage_names_its_parameters) {
  Layer layer = layer_of(ValueType::f32);
  layer.name = "Moisture";
  layer.unit = "%";
  const auto json = point_coverage(point(), {layer}, model_in(Unit::m));
  EXPECT_EQ(json["type"], "Coverage");
  EXPECT_EQ(json["domain"]["axes"]["x"]["values"][0], 1.5);
  EXPECT_EQ(json["ranges"]["cracks"]["values"][0], 4);
  EXPECT_EQ(json["parameters"]["cracks"]["unit"]["symbol"], "%");
}

TEST(Wire, statistics_of_an_empty_layer_have_no_extremes) {
  const auto json = to_json(query::Statistics{});
  EXPECT_FALSE(json.contains("min"));
  EXPECT_EQ(json["area_m2"], 0);
  EXPECT_TRUE(json["histogram"].empty());
}

TEST(Wire, statistics_are_as_the_contract_says) {
  query::Statistics statistics;
  statistics.texels = 5;
  statistics.area_m2 = 0.5;
  statistics.min = 1;
  statistics.max = 3;
  statistics.histogram = {{1, 2, 2, 0.2}, {2, 3, 3, 0.3}};
  statistics.keys[3] = {3, 0.3, {1, 2, 3}, {0, 0, 0}, {2, 4, 6}};
  for (const auto& json : {to_json(statistics), to_json(query::Statistics{})}) {
    const auto fits = protocol::parse<protocol::Statistics>(json.dump());
    EXPECT_TRUE(fits) << fits.error().field << ": " << fits.error().detail;
  }
  EXPECT_EQ(to_json(statistics)["histogram"][1]["texels"], 3);
  EXPECT_EQ(to_json(statistics)["keys"][0]["key"].dump(), "3");
}

TEST(Wire, times_are_written_in_utc) {
  using namespace std::chrono;
  EXPECT_EQ(utc_text(system_clock::time_point(milliseconds(1'700'000'000'123))),
            "2023-11-14T22:13:20.123Z");
  EXPECT_EQ(utc_text(system_clock::time_point(milliseconds(-1))), "1969-12-31T23:59:59.999Z");
}

TEST(Wire, a_job_tells_what_went_wrong) {
  jobs::JobStatus job;
  job.id = 3;
  job.state = jobs::JobState::failed;
  job.problem = Error{ErrorCode::invalid, "Bad file", "Line 3.", {}};
  const auto json = to_json(job);
  EXPECT_EQ(json["state"], "failed");
  EXPECT_EQ(json["problem"]["title"], "Bad file");
  EXPECT_FALSE(json.contains("model"));
}

TEST(Wire, the_kind_of_a_job_decides_the_member_of_its_report) {
  jobs::JobStatus job;
  job.id = 3;
  job.state = jobs::JobState::done;
  job.result.emplace(ModelId(7));
  job.result->report = {{"operation", "sieve"}};
  job.kind = jobs::JobKind::layers;
  EXPECT_TRUE(to_json(job).contains("report"));
  job.kind = jobs::JobKind::regions;
  EXPECT_EQ(to_json(job)["cleanup"]["operation"], "sieve");
  EXPECT_FALSE(to_json(job).contains("report"));
  job.kind = jobs::JobKind::changes;
  EXPECT_EQ(to_json(job)["changes"]["operation"], "sieve");
  EXPECT_FALSE(to_json(job).contains("report"));
}

}  // namespace
}  // namespace strata::net
