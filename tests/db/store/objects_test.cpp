#include "store/content/objects.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <future>
#include <thread>

#include "store/content/models.h"
#include "store/content/projects.h"
#include "store/content/trash.h"
#include "store/pg/pg.h"
#include "support/test_cluster.h"

namespace strata::store {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

class ObjectsOfAProject : public ::testing::Test {
 protected:
  Model new_model(const std::string& name, ProjectId project = 1) {
    NewModel fresh;
    fresh.model.project_id = project;
    fresh.model.name = name;
    fresh.geometry = {1, 2, 3};
    return store_->models().create(fresh, {}).value();
  }
  Result<Model> put(const Model& model, std::optional<ObjectId> object, const std::string& date) {
    Model changed = store_->models().find(to_string(model.id)).value();
    changed.object = object;
    changed.survey_date = date;
    return store_->models().update(changed);
  }
  ProjectId new_project(const std::string& name) {
    Project project;
    project.name = name;
    return store_->projects().create(project).value().id;
  }
  std::vector<std::string> surveys(ObjectId id) {
    std::vector<std::string> texts;
    const auto object = objects_.find(1, id).value();
    for (const Survey& survey : object.surveys) texts.push_back(survey.date + " " + survey.slug);
    return texts;
  }

  const std::string dsn_ = test::fresh_database();
  std::unique_ptr<Store> store_ = test::open_store(dsn_);
  Objects& objects_ = store_->objects();
};

TEST_F(ObjectsOfAProject, surveys_are_sorted_by_their_dates) {
  const ObjectId bust = objects_.create(1, "Bust").value().id;
  EXPECT_THAT(surveys(bust), IsEmpty());
  const std::pair<const char*, const char*> dated[] = {
      {"e", "2022-06"}, {"b", "2019-05-01"}, {"a", "2019-05"}, {"d", "2022"}, {"c", "2019-11"}};
  for (const auto& [name, date] : dated) ASSERT_TRUE(put(new_model(name), bust, date));
  EXPECT_THAT(surveys(bust),
              ElementsAre("2019-05 a", "2019-05-01 b", "2019-11 c", "2022 d", "2022-06 e"));
}

TEST_F(ObjectsOfAProject, a_model_enters_an_object_with_a_date_and_leaves_it) {
  const ObjectId bust = objects_.create(1, "Bust").value().id;
  const Model model = new_model("a");
  EXPECT_EQ(put(model, bust, "").error().field, "survey_date");
  EXPECT_EQ(put(model, std::nullopt, "2019").error().field, "object");
  EXPECT_EQ(put(model, ObjectId(99), "2019").error().field, "object");
  const auto inside = put(model, bust, "2019").value();
  EXPECT_EQ(inside.object, bust);
  EXPECT_EQ(inside.survey_date, "2019");
  EXPECT_THAT(surveys(bust), ElementsAre("2019 a"));
  const auto outside = put(model, std::nullopt, "").value();
  EXPECT_EQ(outside.object, std::nullopt);
  EXPECT_EQ(outside.survey_date, "");
  EXPECT_THAT(surveys(bust), IsEmpty());
}

TEST_F(ObjectsOfAProject, an_object_and_its_models_are_in_one_project) {
  const ProjectId villa = new_project("Villa");
  const ObjectId of_villa = objects_.create(villa, "Bust").value().id;
  const Model model = new_model("a");
  const auto refused = put(model, of_villa, "2019").error();
  EXPECT_EQ(refused.code, ErrorCode::invalid);
  EXPECT_EQ(refused.field, "object");
  EXPECT_EQ(objects_.find(1, of_villa).error().code, ErrorCode::not_found);
  EXPECT_EQ(objects_.of_project(1, 10, 0, 0)->total, 0);

  const ObjectId bust = objects_.create(1, "Bust").value().id;
  Model moved = put(model, bust, "2019").value();
  moved.project_id = villa;
  EXPECT_EQ(store_->models().update(moved).error().field, "object");
}

TEST_F(ObjectsOfAProject, a_name_is_unique_in_its_project) {
  auto bust = objects_.create(1, "Bust").value();
  EXPECT_EQ(objects_.create(1, "BUST").error().code, ErrorCode::conflict);
  EXPECT_EQ(objects_.create(1, "").error().field, "name");
  EXPECT_EQ(objects_.create(99, "Bust").error().code, ErrorCode::not_found);
  ASSERT_TRUE(objects_.create(new_project("Villa"), "Bust"));
  ASSERT_TRUE(objects_.create(1, "Torso"));
  bust.name = "torso";
  EXPECT_EQ(objects_.rename(bust).error().code, ErrorCode::conflict);
  bust.name = "BUST";
  const auto renamed = objects_.rename(bust).value();
  EXPECT_EQ(renamed.name, "BUST");
  EXPECT_EQ(renamed.version, bust.version + 1);
  EXPECT_EQ(objects_.rename(bust).error().code, ErrorCode::stale);
  EXPECT_EQ(objects_.remove(bust).error().code, ErrorCode::stale);
  EXPECT_TRUE(objects_.remove(renamed));
  EXPECT_EQ(objects_.remove(renamed).error().code, ErrorCode::not_found);
  EXPECT_EQ(objects_.rename(renamed).error().code, ErrorCode::not_found);
}

TEST_F(ObjectsOfAProject, pages_list_each_object_once) {
  for (int i = 0; i < 5; ++i) ASSERT_TRUE(objects_.create(1, "Object " + std::to_string(i)));
  const auto first = objects_.of_project(1, 2, 0, 0).value();
  EXPECT_EQ(first.total, 5);
  ASSERT_EQ(first.objects.size(), 2u);
  const auto rest = objects_.of_project(1, 10, 0, first.objects.back().id.number()).value();
  ASSERT_EQ(rest.objects.size(), 3u);
  EXPECT_EQ(rest.objects.front().name, "Object 2");
}

TEST_F(ObjectsOfAProject, an_object_with_surveys_is_not_deleted) {
  const auto bust = objects_.create(1, "Bust").value();
  const Model model = new_model("a");
  ASSERT_TRUE(put(model, bust.id, "2019"));
  EXPECT_EQ(objects_.remove(bust).error().code, ErrorCode::conflict);
  // A model in the Trash is no survey. It comes back without the deleted object.
  ASSERT_TRUE(store_->trash().put_model(model.id, {}));
  EXPECT_THAT(surveys(bust.id), IsEmpty());
  ASSERT_TRUE(objects_.remove(bust));
  ASSERT_TRUE(PgConnection::connect(dsn_)->script(
      "UPDATE all_models SET binned = NULL, binned_by = NULL, binned_bytes = NULL"));
  EXPECT_EQ(store_->models().find("a")->object, std::nullopt);
}

TEST_F(ObjectsOfAProject, a_deletion_waits_for_a_restoration_from_the_trash) {
  const auto bust = objects_.create(1, "Bust").value();
  const Model model = new_model("a");
  ASSERT_TRUE(put(model, bust.id, "2019"));
  ASSERT_TRUE(store_->trash().put_model(model.id, {}));
  auto restoring = PgConnection::connect(dsn_), watcher = PgConnection::connect(dsn_);
  ASSERT_TRUE(restoring->script(
      "BEGIN; UPDATE all_models SET binned = NULL, binned_by = NULL, binned_bytes = NULL"));
  auto deletion = std::async(std::launch::async, [&] { return objects_.remove(bust); });
  while (watcher->query("SELECT count(*) FROM pg_locks WHERE NOT granted")->integer(0, 0) == 0 &&
         deletion.wait_for(std::chrono::milliseconds(1)) == std::future_status::timeout) {
  }
  EXPECT_TRUE(restoring->script("COMMIT"));
  const auto refused = deletion.get();
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::conflict);
  EXPECT_THAT(surveys(bust.id), ElementsAre("2019 a"));
}

TEST_F(ObjectsOfAProject, a_project_is_deleted_with_its_objects) {
  const ProjectId villa = new_project("Villa");
  ASSERT_TRUE(objects_.create(villa, "Bust"));
  EXPECT_TRUE(store_->projects().remove(villa));
  EXPECT_EQ(objects_.of_project(villa, 10, 0, 0)->total, 0);
}

TEST_F(ObjectsOfAProject, an_import_names_an_object_that_may_be_new) {
  NewModel fresh;
  fresh.model.project_id = 1;
  fresh.model.name = "a";
  fresh.geometry = {1, 2, 3};
  fresh.object_name = "Bust";
  EXPECT_EQ(store_->models().create(fresh, {}).error().field, "survey_date");
  fresh.model.survey_date = "2019";
  const auto first = store_->models().create(fresh, {}).value();
  fresh.object_name = "bust";
  fresh.model.survey_date = "2022-06";
  const auto second = store_->models().create(fresh, {}).value();
  EXPECT_EQ(first.object, second.object);
  EXPECT_THAT(surveys(*first.object), ElementsAre("2019 a", "2022-06 a-2"));
}

TEST_F(ObjectsOfAProject, imports_at_the_same_time_create_an_object_once) {
  std::vector<std::thread> threads;
  for (int i = 0; i < 4; ++i)
    threads.emplace_back([&] {
      NewModel fresh;
      fresh.model.project_id = 1;
      fresh.model.name = "a";
      fresh.model.survey_date = "2019";
      fresh.geometry = {1, 2, 3};
      fresh.object_name = "Bust";
      EXPECT_TRUE(store_->models().create(fresh, {}));
    });
  for (auto& thread : threads) thread.join();
  const auto page = objects_.of_project(1, 10, 0, 0).value();
  ASSERT_EQ(page.objects.size(), 1u);
  EXPECT_EQ(page.objects[0].surveys.size(), 4u);
}

TEST_F(ObjectsOfAProject, analysts_read_the_object_and_the_date) {
  const ObjectId bust = objects_.create(1, "Bust").value().id;
  ASSERT_TRUE(put(new_model("a"), bust, "2019-05"));
  new_model("b");
  auto connection = PgConnection::connect(dsn_);
  const auto rows =
      connection->query("SELECT object, survey_date FROM analysis.models ORDER BY model").value();
  ASSERT_EQ(rows.rows(), 2);
  EXPECT_EQ(rows.text(0, 0), "Bust");
  EXPECT_EQ(rows.text(0, 1), "2019-05");
  EXPECT_TRUE(rows.null(1, 0));
  EXPECT_TRUE(rows.null(1, 1));
}

}  // namespace
}  // namespace strata::store
