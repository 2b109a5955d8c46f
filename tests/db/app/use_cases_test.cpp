// Use cases without HTTP: recomputed layers, the trash, measured figures.
#include <chrono>
#include <filesystem>
#include <fstream>
#include <future>
#include <thread>

#include "app/figures/figures.h"
#include "app/layers/formula_layers.h"
#include "app/layers/recomputer.h"
#include "app/layers/survey_statistics.h"
#include "app/trash_purger.h"
#include "domain/people/question.h"
#include "room/edits.h"
#include "room/layers.h"
#include "room/queries.h"
#include "store/content/layers.h"
#include "store/pg/pg.h"
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
    return make_computed("twice", source.slug + " * 2", source.resolution, true);
  }

  Layer make_computed(const std::string& name, const std::string& expression, int resolution,
                      bool automatic) {
    Layer layer;
    layer.model_id = model_.id;
    layer.name = layer.slug = name;
    layer.type = ValueType::f32;
    layer.resolution = resolution;
    auto formula = read_formula(*room(), expression, automatic, layer);
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

TEST_F(UseCases, distances_are_measured_from_what_is_painted_until_it_changes) {
  const Layer source = make_layer(ValueType::u8, 2048, "values");
  ASSERT_TRUE(send(stroke(source, 5, {{320, 240}}, 20)));
  const Layer away = make_computed("away", "distance(values)", source.resolution, false);
  const auto painted = room()->queries().statistics(source.slug),
             distances = room()->queries().statistics(away.slug);
  EXPECT_EQ(distances->min, 0);
  EXPECT_GT(distances->max, 0);
  const std::string half = std::to_string(distances->max / 2);
  const Layer near =
      make_computed("near", "within(values, " + half + ")", source.resolution, false);
  const auto buffer = room()->queries().statistics(near.slug);
  EXPECT_EQ(buffer->max, 1);
  EXPECT_GT(buffer->texels, painted->texels);
  EXPECT_LT(buffer->texels, distances->texels);
  const Layer inside = make_computed("inside", "distance(away > " + half + ") + nearest(values)",
                                     source.resolution, false);
  EXPECT_EQ(room()->queries().statistics(inside.slug)->min, 5);
  EXPECT_FALSE(inside.formula->stale);

  ASSERT_TRUE(send(stroke(source, 5, {{200, 180}}, 20)));
  for (const Layer& layer : {away, near, inside})
    EXPECT_TRUE(wait_until([&] { return room()->layers().find(layer.slug)->formula->stale; }))
        << layer.slug;
  Progress progress;
  const auto now = compute_layer(services(), room(), away, {"carl", Role::curator}, progress);
  ASSERT_TRUE(now) << now.error().detail;
  EXPECT_FALSE(now->formula->stale);
}

TEST_F(UseCases, a_distance_from_what_is_not_saved_yet_is_current) {
  const Layer source = make_layer(ValueType::u8, 2048, "values");
  ASSERT_TRUE(send(stroke(source, 5, {{320, 240}}, 20)));
  // This is quick, so it ends before the lock makes the database refuse the stroke.
  const Layer near = make_computed("near", "within(values, 0.01)", source.resolution, false);
  const auto before = room()->edits().sequence();

  auto blocker = store::PgConnection::connect(dsn_);
  ASSERT_TRUE(blocker);
  // allows reading but not writing
  ASSERT_TRUE(blocker->script("BEGIN; LOCK TABLE edits IN SHARE ROW EXCLUSIVE MODE"));
  auto painted = start(stroke(source, 5, {{200, 180}}, 20));
  const auto is_applied = [&](std::int64_t edits) {
    return wait_until([&] { return room()->edits().sequence() == before + edits; });
  };
  EXPECT_TRUE(is_applied(1));
  Progress progress;
  auto computed = std::async(std::launch::async, [&] {
    return compute_layer(services(), room(), near, {"carl", Role::curator}, progress);
  });
  EXPECT_TRUE(is_applied(2));
  EXPECT_EQ(room()->edits().durable_sequence(), before);
  EXPECT_TRUE(blocker->script("COMMIT"));
  EXPECT_TRUE(painted.get());
  const auto now = computed.get();
  ASSERT_TRUE(now) << now.error().detail;
  EXPECT_FALSE(now->formula->stale);
}

TEST_F(UseCases, a_cancelled_distance_changes_nothing) {
  const Layer source = make_layer(ValueType::u8, 2048, "values");
  ASSERT_TRUE(send(stroke(source, 5, {{320, 240}}, 20)));
  const Layer away = make_computed("away", "distance(values)", source.resolution, false);
  const auto before = room()->edits().sequence();
  Progress progress;
  progress.cancel();
  const auto stopped = compute_layer(services(), room(), away, {"carl", Role::curator}, progress);
  ASSERT_FALSE(stopped);
  EXPECT_EQ(stopped.error().code, ErrorCode::cancelled);
  EXPECT_EQ(room()->edits().sequence(), before);
}

TEST_F(UseCases, a_layer_is_not_computed_for_a_client_that_has_left) {
  const Layer source = make_layer(ValueType::u8, 2048, "values");
  ASSERT_TRUE(send(stroke(source, 5, {{320, 240}}, 20)));
  const Layer twice = make_double(source),
              away = make_computed("away", "distance(values)", source.resolution, false);
  const auto before = room()->edits().sequence();
  const auto question = std::make_shared<Question>("carl", QuestionLimits{}, nullptr);
  question->end({ErrorCode::cancelled, "Client left", "", {}});
  const Question::Scope scope(question);
  Progress progress;
  const auto compute = [&](const Layer& layer) {
    return compute_layer(services(), room(), layer, {"carl", Role::curator}, progress);
  };
  EXPECT_THROW(compute(away), QuestionEnded);
  const auto refused = compute(twice);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().title, "Client left");
  EXPECT_EQ(room()->edits().sequence(), before);
}

SurveyedObject surveyed(const std::vector<ModelId>& models) {
  SurveyedObject object{7, 1, "Bust", 1, {}};
  for (const ModelId model : models) object.surveys.push_back({model, "bust", "Bust", "2019"});
  return object;
}

TEST_F(UseCases, statistics_of_surveys_are_those_of_each_layer) {
  const Layer layer = make_layer(ValueType::u8, 2048, "values");
  ASSERT_TRUE(send(stroke(layer, 5, {{320, 240}}, 20)));
  const auto alone = room()->queries().statistics(layer.slug);
  const ModelId deleted = 987'654;
  const auto all = survey_statistics(services(), surveyed({model_.id, deleted, model_.id}),
                                     {.layer = layer.name, .options = {.pieces = true}});
  ASSERT_TRUE(all) << all.error().detail;
  ASSERT_EQ(all->size(), 2u);
  for (const SurveyStatistics& each : *all) {
    ASSERT_TRUE(each.layer);
    EXPECT_EQ(each.layer->statistics.texels, alone->texels);
    EXPECT_EQ(each.layer->statistics.area_m2, alone->area_m2);
    EXPECT_EQ(each.layer->statistics.mean, 5);
    EXPECT_GT(each.layer->statistics.pieces.value_or(0), 0u);
    EXPECT_EQ(each.layer->sequence, room()->edits().sequence());
    EXPECT_GT(each.layer->share(), 0);
    EXPECT_LT(each.layer->share(), 1);
  }
}

TEST_F(UseCases, statistics_of_too_many_surveys_are_refused) {
  const SurveyedObject object = surveyed(std::vector<ModelId>(kMaxSurveysAtOnce + 1, model_.id));
  const auto refused = survey_statistics(services(), object, {.layer = "values"});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::invalid);
  EXPECT_EQ(refused.error().field, "from");
  const auto none = survey_statistics(services(), object, {.layer = "values", .from = "2020"});
  ASSERT_TRUE(none) << none.error().detail;
  EXPECT_TRUE(none->empty());
}

TEST_F(UseCases, statistics_of_surveys_stop_when_the_client_has_left) {
  const auto question = std::make_shared<Question>("ada", QuestionLimits{}, nullptr);
  question->end({ErrorCode::cancelled, "Client has left", "", ""});
  const Question::Scope scope(question);
  EXPECT_THROW((void)survey_statistics(services(), surveyed({model_.id}), {.layer = "values"}),
               QuestionEnded);
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
  auto file = make_figure(services(), budget, request, folder, progress);
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
  const auto refused = make_figure(services(), budget, request, folder, progress);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().field, "camera.section");
  fs::remove_all(folder);
}

}  // namespace
}  // namespace strata::app
