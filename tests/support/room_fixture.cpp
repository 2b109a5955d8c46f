#include "support/room_fixture.h"

#include <glm/gtc/matrix_transform.hpp>
#include <thread>

#include "mesh/demo/demo_pot.h"
#include "mesh/surface/geometry.h"
#include "room/edit.h"
#include "room/edits.h"
#include "room/layers.h"
#include "room/queries.h"
#include "room/rooms.h"
#include "store/content/models.h"
#include "store/content/projects.h"
#include "store/journal/journal_reads.h"
#include "store/pg/pg.h"
#include "stream/viewer.h"
#include "support/shader_dirs.h"
#include "support/whole_picture.h"

namespace strata::test {

namespace {

struct Pot {
  double area;
  AtlasReport report;
  mesh::Geometry geometry;
};

// Unwraps the pot once for all tests of the process.
const Result<Pot>& pot() {
  static const Result<Pot> made = []() -> Result<Pot> {
    Progress progress;
    const mesh::TriangleMesh mesh = mesh::make_demo_pot(0.2);
    auto atlas = mesh::make_atlas(mesh, 2048, progress);
    if (!atlas) return tl::unexpected(atlas.error());
    return Pot{mesh::surface_area(mesh), atlas->report, mesh::build_geometry(mesh, *atlas)};
  }();
  return made;
}

}  // namespace

void RoomTest::SetUp() {
  dsn_ = fresh_database();
  store_ = open_store(dsn_);
  ASSERT_TRUE(store_);
  const auto& made_pot = pot();
  ASSERT_TRUE(made_pot) << made_pot.error().detail;
  const mesh::Geometry& geometry = made_pot->geometry;
  store::NewModel made;
  made.model.name = "Pot";
  made.model.slug = "pot";
  auto project = store_->projects().find("default");
  ASSERT_TRUE(project);
  made.model.project_id = project->id;
  made.model.unit = Unit::mm;
  made.model.origin = geometry.origin;
  made.model.triangles = geometry.triangle_count();
  made.model.vertices = geometry.positions.size();
  made.model.bounds_min = geometry.origin + glm::dvec3(geometry.box_min);
  made.model.bounds_max = geometry.origin + glm::dvec3(geometry.box_max);
  made.model.area = made_pot->area;
  made.model.atlas = made_pot->report;
  made.geometry = mesh::encode_geometry(geometry);
  auto model = store_->models().create(made, [] { return false; });
  ASSERT_TRUE(model) << model.error().detail;
  model_ = *model;
  store_.reset();
  restart();
}

void RoomTest::TearDown() {
  rooms_.reset();
  encoder_.reset();
  if (renderer_) {
    EXPECT_EQ(renderer_->debug_errors(), 0);
  }
  renderer_.reset();
  store_.reset();
}

void RoomTest::restart(std::uint64_t gpu_memory) {
  rooms_.reset();
  encoder_.reset();
  renderer_.reset();
  store_.reset();
  store_ = open_store(dsn_);
  ASSERT_TRUE(store_);
  render::RendererOptions options;
  options.shader_dir = shader_dir().string();
  options.debug = true;
  options.gpu_memory_bytes = gpu_memory;
  auto renderer = render::Renderer::start(options);
  ASSERT_TRUE(renderer) << renderer.error().detail;
  renderer_ = std::move(*renderer);
  encoder_ = std::make_unique<stream::JpegPool>(1);
  rooms_ = std::make_unique<room::Rooms>(
      *store_, *renderer_, stream::StreamContext{renderer_.get(), encoder_.get()}, options_);
}

std::shared_ptr<room::Room> RoomTest::room() {
  auto room = rooms_->open("pot", Role::owner);
  EXPECT_TRUE(room) << (room ? "" : room.error().detail);
  return *room;
}

Layer RoomTest::make_layer(ValueType type, int resolution, const std::string& name) {
  Layer layer;
  layer.name = layer.slug = name;
  layer.type = type;
  layer.resolution = resolution;
  layer.palette = default_palette(type, false);
  auto made = room()->layers().create(layer);
  EXPECT_TRUE(made) << (made ? "" : made.error().detail);
  return *made;
}

Camera RoomTest::camera(glm::dvec3 from, bool orthographic) const {
  const glm::dvec3 center = (model_.bounds_min + model_.bounds_max) * 0.5;
  const double size = glm::length(model_.bounds_max - model_.bounds_min);
  const glm::dvec3 direction = glm::normalize(from);
  const glm::dvec3 up = std::abs(direction.z) > 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(0, 0, 1);
  return {glm::lookAt(center + direction * size * 1.5, center, up),
          orthographic
              ? glm::ortho(-size * 0.67, size * 0.67, -size * 0.5, size * 0.5, size * 0.1, size * 4)
              : glm::perspective(0.7, 640.0 / 480.0, size * 0.1, size * 4),
          640, 480};
}

room::EditRequest RoomTest::request(const Layer& layer, decltype(room::EditRequest::edit) edit,
                                    const std::string& user) const {
  return {random_uuid(), {user, Role::annotator}, layer.id, std::move(edit), {{"op", "test"}}};
}

room::EditRequest RoomTest::stroke(const Layer& layer, double value, std::vector<glm::dvec2> path,
                                   double radius_px, const std::string& user) const {
  room::StrokeEdit edit;
  edit.batch.camera = camera({0.3, -1, 0.4});
  edit.batch.path = std::move(path);
  edit.batch.radius_px = radius_px;
  edit.batch.value_bits = encode_value(layer.type, value).value();
  edit.stroke = random_uuid();
  return request(layer, std::move(edit), user);
}

std::future<Result<room::EditAnswer>> RoomTest::start(room::EditRequest edit) {
  auto promise = std::make_shared<std::promise<Result<room::EditAnswer>>>();
  auto future = promise->get_future();
  room()->edits().submit(std::move(edit), {}, [promise](Result<room::EditAnswer> answer) {
    promise->set_value(std::move(answer));
  });
  return future;
}

Result<room::EditAnswer> RoomTest::send(room::EditRequest edit) {
  return start(std::move(edit)).get();
}

Result<room::EditAnswer> RoomTest::send_until_taken(const room::EditRequest& edit) {
  Result<room::EditAnswer> answer = fail(ErrorCode::unavailable, "", "");
  for (int i = 0; i < 6000 && !answer && is_server_failure(answer.error().code); ++i) {
    answer = send(edit);
    if (!answer) std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  return answer;
}

void RoomTest::expect_room_equals_journal(const Layer& layer) {
  const auto live = room()->queries().tiles(layer.slug, {});
  ASSERT_TRUE(live) << live.error().detail;
  const auto stored = store_->journal().load_tiles(layer);
  ASSERT_TRUE(stored) << stored.error().detail;
  EXPECT_TRUE(equal(live->tiles, stored->tiles));
  EXPECT_EQ(live->sequence, stored->sequence);
  EXPECT_EQ(room()->edits().durable_sequence(), store_->journal().last_sequence(model_.id).value());
}

void RoomTest::expect_picture_of_journal() {
  // A second renderer that has never painted. Its frame comes only from the journal.
  render::RendererOptions options;
  options.shader_dir = shader_dir().string();
  auto renderer = render::Renderer::start(options);
  ASSERT_TRUE(renderer) << renderer.error().detail;
  Result<Picture> expected = fail(ErrorCode::unavailable, "", "");
  // The second room only reads, so its claim must not close the room of the test.
  auto connection = store::PgConnection::connect(dsn_);
  ASSERT_TRUE(connection) << connection.error().detail;
  ASSERT_TRUE(connection->script(
      "CREATE OR REPLACE FUNCTION keep_epoch() RETURNS trigger LANGUAGE plpgsql AS "
      "'BEGIN NEW.owner_epoch := OLD.owner_epoch; RETURN NEW; END';"
      "CREATE TRIGGER keep_epoch BEFORE UPDATE OF owner_epoch ON all_models "
      "FOR EACH ROW EXECUTE FUNCTION keep_epoch()"));
  {
    room::Rooms rooms(*store_, **renderer, stream::StreamContext{renderer->get(), encoder_.get()},
                      {});
    auto fresh = rooms.open("pot", Role::owner);
    ASSERT_TRUE(fresh) << fresh.error().detail;
    expected = whole_picture((*fresh)->pictures(), {}, camera({0.3, -1, 0.4}));
  }
  ASSERT_TRUE(connection->script("DROP TRIGGER keep_epoch ON all_models"));
  ASSERT_TRUE(expected) << expected.error().detail;
  Result<Picture> shown = fail(ErrorCode::unavailable, "", "");
  for (int i = 0; i < 3000 && !(shown && shown->rgba == expected->rgba); ++i) {
    shown = whole_picture(room()->pictures(), {}, camera({0.3, -1, 0.4}));
    if (!shown || shown->rgba != expected->rgba)
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  ASSERT_TRUE(shown) << shown.error().detail;
  EXPECT_EQ(shown->rgba, expected->rgba);
}

bool equal(const TileMap& a, const TileMap& b) {
  if (a.size() != b.size()) return false;
  for (const auto& [address, tile] : a) {
    auto other = b.find(address);
    if (other == b.end() || !(*other->second == *tile)) return false;
  }
  return true;
}

}  // namespace strata::test
