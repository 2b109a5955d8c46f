// Use cases without HTTP: recomputed layers, the trash, measured figures.
#include <chrono>
#include <filesystem>
#include <fstream>
#include <thread>

#include "app/figures/figures.h"
#include "app/layers/formula_layers.h"
#include "app/layers/recomputer.h"
#include "app/trash_purger.h"
#include "room/edits.h"
#include "room/layers.h"
#include "room/queries.h"
#include "store/content/layers.h"
#include "support/quiet_services.h"
#include "support/room_fixture.h"

namespace strata::app {
namespace {

namespace fs = std::filesystem;
using test::RoomTest;

// Waits until the condition is true; returns false after a minute.
template <class Condition>
bool wait_until(const Condition& holds) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(1);
  while (!holds()) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  return true;
}

class UseCases : public RoomTest {
 protected:
  Services services() { return quiet_.of(*store_, *rooms_); }
  double highest(const std::string& layer) { return room()->queries().statistics(layer)->max; }

  // Creates a layer with twice the values of the source.
  Layer make_double(const Layer& source) {
    Layer layer;
    layer.model_id = model_.id;
    layer.name = layer.slug = "twice";
    layer.type = ValueType::f32;
    layer.resolution = source.resolution;
    auto formula = read_formula(*room(), source.slug + " * 2", true, Visibility::everyone);
    EXPECT_TRUE(formula) << formula.error().detail;
    layer.formula = *formula;
    layer.origin = LayerOrigin::expression;
    layer.locked = true;
    NewLayers layers(room(), quiet_.counters, {"carl", Role::curator});
    Progress progress;
    auto made = add_formula_layer(services(), room(), layers, std::move(layer),
                                  {"carl", Role::curator}, true, progress);
    EXPECT_TRUE(made) << made.error().detail;
    EXPECT_TRUE(layers.show({}));
    return *made;
  }

  test::QuietServices quiet_;
};

TEST_F(UseCases, an_automatic_layer_follows_what_is_painted_below_it) {
  const Layer source = make_layer(ValueType::u8, 2048, "values");
  ASSERT_TRUE(send(stroke(source, 5, {{320, 240}}, 20)));
  const Layer twice = make_double(source);
  EXPECT_EQ(highest(twice.slug), 10);
  EXPECT_EQ(quiet_.counters.saved, 1u);
  Recomputer recomputer(services());
  ASSERT_TRUE(send(stroke(source, 9, {{320, 240}}, 20)));
  EXPECT_TRUE(wait_until([&] { return highest(twice.slug) == 18; }));
  recomputer.stop();
  ASSERT_TRUE(send(stroke(source, 11, {{320, 240}}, 20)));
  EXPECT_EQ(highest(twice.slug), 18) << "it goes on after its stop";
}

TEST_F(UseCases, an_edit_that_is_refused_is_counted_and_its_layer_is_taken_back) {
  const Layer source = make_layer(ValueType::u8, 2048, "values");
  ASSERT_TRUE(send(stroke(source, 5, {{320, 240}}, 20)));
  const Layer twice = make_double(source);
  ASSERT_TRUE(room()->layers().put_in_trash(source.id, {.key = {}, .make = {}, .user = "carl"}));
  Progress progress;
  const auto now = store_->layers().find(model_.id, twice.slug, Role::owner);
  ASSERT_TRUE(now);
  const auto refused = compute_layer(services(), room(), *now, {"carl", Role::curator}, progress);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().field, "expression");
  EXPECT_EQ(quiet_.counters.saved, 1u);
}

TEST_F(UseCases, what_was_in_the_trash_for_long_enough_is_erased_and_nothing_else) {
  const Layer layer = make_layer(ValueType::u8, 2048, "old"),
              other = make_layer(ValueType::u8, 2048, "new");
  ASSERT_TRUE(send(stroke(layer, 9, {{320, 240}}, 20)));
  ASSERT_TRUE(send(stroke(other, 9, {{320, 240}}, 20)));
  ASSERT_TRUE(room()->layers().put_in_trash(layer.id, {.key = {}, .make = {}, .user = "carl"}));
  const auto in_trash = [&] {
    return store_->trash()
        .of_project(model_.project_id, {Role::owner, std::chrono::days(30)}, 10, 0)
        ->total;
  };
  {
    TrashPurger keeper(store_->trash(), std::chrono::days(30), store_->audit(),
                       std::chrono::days(0), store_->files(), std::chrono::days(30));
    keeper.stop();
  }
  EXPECT_EQ(in_trash(), 1);
  TrashPurger keeper(store_->trash(), std::chrono::days(0), store_->audit(), std::chrono::days(0),
                     store_->files(), std::chrono::days(30));
  keeper.check_now();
  EXPECT_TRUE(wait_until([&] { return in_trash() == 0; }));
  keeper.stop();
  EXPECT_TRUE(room()->layers().find(other.slug));
  EXPECT_EQ(highest(other.slug), 9);
}

TEST_F(UseCases, a_figure_is_drawn_to_a_file_that_goes_with_its_last_owner) {
  const Layer layer = make_layer(ValueType::u8, 2048, "cracks");
  ASSERT_TRUE(send(stroke(layer, 9, {{320, 240}}, 20)));
  FigureRequest request;
  request.room = room();
  request.role = Role::viewer;
  request.layers = {layer};
  request.shown.layers.emplace({to_string(layer.id)});
  request.shown.at = room()->edits().durable_sequence();
  request.plane = figure::plane_from(figure::Direction::top, model_.up);
  request.from = "top";
  request.dpi = 100;
  request.captions.title = "Folded surface";
  ByteBudget budget(64u << 20);
  Progress progress;
  const auto folder = fs::temp_directory_path() / to_string(random_uuid());
  fs::create_directory(folder);
  auto file = make_figure(*store_, budget, request, folder, progress);
  ASSERT_TRUE(file) << file.error().detail;
  EXPECT_EQ((*file)->media_type, "application/pdf");
  EXPECT_EQ((*file)->bytes, fs::file_size((*file)->path));
  std::ifstream in((*file)->path, std::ios::binary);
  std::string beginning(5, '\0');
  in.read(beginning.data(), 5);
  EXPECT_EQ(beginning, "%PDF-");
  file = fail(ErrorCode::gone, {}, {});
  EXPECT_TRUE(fs::is_empty(folder));
  request.section = {{0, 0, 1, -1e9}};  // cuts off the whole model
  const auto refused = make_figure(*store_, budget, request, folder, progress);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().field, "camera.section");
  fs::remove_all(folder);
}

}  // namespace
}  // namespace strata::app
