#include "app/layers/analysis.h"

#include "room/edits.h"
#include "room/layers.h"
#include "room/queries.h"
#include "store/content/layers.h"
#include "support/quiet_services.h"
#include "support/room_fixture.h"

namespace strata::app {
namespace {

const Author kCarl("carl", Role::curator);

// Is cancelled as soon as the room has this number of layers.
class CancelledAtLayers final : public Progress {
 public:
  CancelledAtLayers(std::shared_ptr<room::Room> room, std::size_t layers)
      : room_(std::move(room)), layers_(layers) {}
  bool cancelled() const override { return room_->layers().all().size() >= layers_; }

 private:
  std::shared_ptr<room::Room> room_;
  std::size_t layers_;
};

// Is cancelled when the room has this number of layers, but only those who watch it find out.
class CancelledForWatchers final : public Progress {
 public:
  CancelledForWatchers(std::shared_ptr<room::Room> room, std::size_t layers)
      : room_(std::move(room)), layers_(layers) {}
  bool cancelled() const override {
    if (room_->layers().all().size() >= layers_) self_.cancel();
    return false;
  }

 private:
  std::shared_ptr<room::Room> room_;
  std::size_t layers_;
  Progress& self_ = *this;
};

class Analyses : public test::RoomTest {
 protected:
  void SetUp() override {
    RoomTest::SetUp();
    cracks_ = make_layer(ValueType::u8, 2048, "cracks");
    ASSERT_TRUE(send(stroke(cracks_, 3, {{320, 240}}, 20)));
  }

  Services services() { return quiet_.of(*store_, *rooms_); }

  static AnalysisStep compute(const std::string& name, const std::string& expression,
                              ValueType type = ValueType::f32) {
    AnalysisStep::Compute step;
    step.layer.name = step.layer.slug = name;
    step.layer.type = type;
    step.layer.locked = true;
    step.layer.palette = default_palette(type, false);
    step.expression = expression;
    step.has_palette = true;
    return {std::move(step)};
  }
  static AnalysisStep measure(const std::string& layer, std::optional<std::string> where = {}) {
    return {AnalysisStep::Measure{layer, std::move(where)}};
  }

  Result<void> add(AnalysisStep step) {
    if (auto* made = std::get_if<AnalysisStep::Compute>(&step.work))
      made->layer.model_id = model_.id;
    return add_step(services(), *room(), Role::curator, analysis_, std::move(step));
  }

  Result<std::vector<AnalysisResult>> run(Progress& progress) {
    NewLayers layers(room(), quiet_.counters, kCarl);
    auto results = run_analysis(services(), room(), analysis_, kCarl, layers, progress);
    if (!results) {
      layers.take_back();
      return results;
    }
    EXPECT_TRUE(layers.show({}));
    return results;
  }

  std::vector<std::string> slugs() {
    std::vector<std::string> slugs;
    for (const Layer& layer : room()->layers().all()) slugs.push_back(layer.slug);
    return slugs;
  }

  test::QuietServices quiet_;
  Layer cracks_;
  Analysis analysis_{"Twice"};
};

TEST_F(Analyses, a_step_reads_the_layer_of_the_step_before_it) {
  ASSERT_TRUE(add(compute("twice", "cracks * 2")));
  ASSERT_TRUE(add(compute("more", "twice + 1")));
  ASSERT_TRUE(add(measure("more", "twice > 5")));
  Progress progress;
  progress.set_job(JobId(7));
  const auto results = run(progress);
  ASSERT_TRUE(results) << results.error().detail;
  ASSERT_EQ(results->size(), 3u);
  EXPECT_EQ(room()->queries().statistics("more")->max, 7);

  const AnalysisResult& more = results->at(1);
  ASSERT_EQ(more.inputs.size(), 1u);
  EXPECT_EQ(more.inputs[0].slug, "twice");
  EXPECT_EQ(more.inputs[0].id, results->at(0).layer.id);
  EXPECT_EQ(more.sequence, more.layer.formula->computed_sequence);
  EXPECT_FALSE(more.layer.formula->stale);
  const auto stored = store_->layers().find(model_.id, "more", Role::owner);
  ASSERT_TRUE(stored);
  EXPECT_EQ(stored->analysis, (LayerAnalysis{"Twice", 2, 3, JobId(7)}));
  EXPECT_FALSE(store_->layers().find(model_.id, "cracks", Role::owner)->analysis);

  const AnalysisResult& measured = results->at(2);
  ASSERT_TRUE(measured.statistics);
  EXPECT_EQ(measured.statistics->max, 7);
  EXPECT_EQ(measured.sequence, room()->edits().durable_sequence());
  ASSERT_EQ(measured.inputs.size(), 2u);
  EXPECT_EQ(measured.inputs[0].slug, "more");
  EXPECT_EQ(measured.inputs[1].slug, "twice");
}

TEST_F(Analyses, a_step_cannot_read_a_layer_of_a_later_step) {
  const auto early = add(compute("more", "twice + 1"));
  ASSERT_FALSE(early);
  EXPECT_EQ(early.error().code, ErrorCode::invalid);
  EXPECT_EQ(early.error().field, "expression");
  const auto nowhere = add(measure("twice"));
  ASSERT_FALSE(nowhere);
  EXPECT_EQ(nowhere.error().field, "layer");
  ASSERT_TRUE(add(compute("twice", "cracks * 2")));
  EXPECT_TRUE(add(compute("more", "twice + 1")));
  EXPECT_TRUE(add(measure("twice", "more > 3")));
  const auto unknown = add(measure("twice", "most > 3"));
  ASSERT_FALSE(unknown);
  EXPECT_EQ(unknown.error().field, "where");
}

TEST_F(Analyses, two_layers_cannot_have_the_same_slug) {
  const auto taken = add(compute("cracks", "1"));
  ASSERT_FALSE(taken);
  EXPECT_EQ(taken.error().code, ErrorCode::conflict);
  EXPECT_EQ(taken.error().field, "name");
  ASSERT_TRUE(add(compute("twice", "cracks * 2")));
  EXPECT_FALSE(add(compute("twice", "cracks * 3")));
}

TEST_F(Analyses, a_slug_that_is_used_in_the_meantime_is_refused) {
  ASSERT_TRUE(add(compute("twice", "cracks * 2")));
  make_layer(ValueType::u8, 2048, "twice");
  Progress progress;
  const auto results = run(progress);
  ASSERT_FALSE(results);
  EXPECT_EQ(results.error().code, ErrorCode::conflict);
  EXPECT_EQ(results.error().field, "steps[0].layer.name");
  EXPECT_EQ(slugs(), (std::vector<std::string>{"cracks", "twice"}));
}

TEST_F(Analyses, a_step_that_fails_takes_back_the_layers_of_all_steps) {
  ASSERT_TRUE(add(compute("twice", "cracks * 2")));
  ASSERT_TRUE(add(compute("large", "twice * 1000", ValueType::u8)));
  Progress progress;
  const auto results = run(progress);
  ASSERT_FALSE(results);
  EXPECT_EQ(results.error().code, ErrorCode::invalid);
  EXPECT_EQ(results.error().field, "steps[1].layer.type");
  EXPECT_TRUE(results.error().detail.starts_with("Step 2 of 2: ")) << results.error().detail;
  EXPECT_EQ(slugs(), std::vector<std::string>{"cracks"});
}

TEST_F(Analyses, a_cancelled_analysis_takes_back_the_layers_of_all_steps) {
  ASSERT_TRUE(add(compute("twice", "cracks * 2")));
  ASSERT_TRUE(add(compute("more", "twice + 1")));
  ASSERT_TRUE(add(measure("more")));
  CancelledAtLayers progress(room(), 3);  // during the second step
  const auto results = run(progress);
  ASSERT_FALSE(results);
  EXPECT_EQ(results.error().code, ErrorCode::cancelled);
  EXPECT_EQ(progress.message(), "Step 2 of 3");
  EXPECT_EQ(slugs(), std::vector<std::string>{"cracks"});
}

TEST_F(Analyses, statistics_end_when_the_analysis_is_cancelled) {
  ASSERT_TRUE(add(compute("twice", "cracks * 2")));
  ASSERT_TRUE(add(measure("twice", "cracks > 1")));
  CancelledForWatchers progress(room(), 2);  // after the first step
  const auto results = run(progress);
  ASSERT_FALSE(results);
  EXPECT_EQ(results.error().code, ErrorCode::cancelled);
  EXPECT_EQ(progress.message(), "Step 2 of 2: Measuring the layer");
  EXPECT_EQ(slugs(), std::vector<std::string>{"cracks"});
}

}  // namespace
}  // namespace strata::app
