// The stored state of jobs after a restart, for every possible end. A success is stored together
// with its effect or not at all.
#include "store/content/jobs.h"

#include <gtest/gtest.h>

#include <map>

#include "store/content/idempotent_response.h"
#include "store/content/projects.h"
#include "store/nodes/nodes.h"
#include "store/pg/pg.h"
#include "store/store.h"
#include "support/test_cluster.h"

namespace strata::store {
namespace {

StoredJob job_of(JobId id, ProjectId project, const char* kind = "import") {
  return {id, project, "ada", kind, {}, {}, {}};
}

std::map<JobId, StoredJob> by_id(std::vector<StoredJob> jobs) {
  std::map<JobId, StoredJob> map;
  for (StoredJob& job : jobs) map.emplace(job.id, std::move(job));
  return map;
}

TEST(Jobs, those_that_did_not_end_are_lost_with_the_server_and_others_are_as_they_ended) {
  const auto dsn = test::fresh_database();
  const auto store = test::open_store(dsn);
  const auto project = store->projects().find("default")->id;
  for (const JobId id : std::initializer_list<JobId>{11, 12, 13, 14})
    ASSERT_TRUE(store->jobs().begin(job_of(id, project)));
  StoredJob done = job_of(12, project);
  done.state = "done";
  done.result = {{"model", 7}, {"layers", {1, 2}}};
  ASSERT_TRUE(store->jobs().end(done));
  StoredJob failed = job_of(13, project);
  failed.state = "failed";
  failed.problem = {{"code", "invalid"},
                    {"title", "Mesh file refused"},
                    {"detail", "No triangle."},
                    {"field", "file"}};
  ASSERT_TRUE(store->jobs().end(failed));

  for (int restart = 0; restart < 2; ++restart) {  // a second restart changes nothing
    const auto stored = store->jobs().take_over(1000);
    ASSERT_TRUE(stored);
    ASSERT_EQ(stored->size(), 4u);
    EXPECT_EQ(stored->front().id, JobId(14));  // newest first
    auto jobs = by_id(*stored);
    EXPECT_EQ(jobs.at(11).state, "lost");
    EXPECT_EQ(jobs.at(12).state, "done");
    EXPECT_EQ(jobs.at(12).result, done.result);
    EXPECT_TRUE(jobs.at(12).problem.is_null());
    EXPECT_EQ(jobs.at(13).problem, failed.problem);
    EXPECT_EQ(jobs.at(13).user, "ada");
    EXPECT_EQ(jobs.at(14).state, "lost");
  }
  EXPECT_EQ(store->jobs().take_over(2)->size(), 2u);
}

TEST(Jobs, of_every_kind_are_stored) {
  const auto dsn = test::fresh_database();
  const auto store = test::open_store(dsn);
  const auto project = store->projects().find("default")->id;
  std::int64_t id = 40;
  for (const char* kind : {"import", "layers", "look", "figure", "regions", "changes"}) {
    const auto begun = store->jobs().begin(job_of(JobId(++id), project, kind));
    EXPECT_TRUE(begun) << kind << ": " << begun.error().detail;
  }
  EXPECT_FALSE(store->jobs().begin(job_of(JobId(++id), project, "unknown")));
}

TEST(Jobs, of_a_node_with_a_lease_are_not_lost) {
  const auto dsn = test::fresh_database();
  const auto store = test::open_store(dsn);
  const auto project = store->projects().find("default")->id;
  const NewNode node{random_uuid(), "http://a.example", "1.0", "llvmpipe"};
  ASSERT_TRUE(store->nodes().join(node));
  auto connection = PgConnection::connect(dsn);
  ASSERT_TRUE(connection);
  // A lease that lasts for the whole test.
  ASSERT_TRUE(
      connection->query("UPDATE nodes SET lease_until = clock_timestamp() + interval '1 hour'"));
  StoredJob running = job_of(31, project);
  running.node = node.id;
  ASSERT_TRUE(store->jobs().begin(running));
  StoredJob ended = job_of(32, project);
  ended.node = random_uuid();  // a node that has left
  ASSERT_TRUE(store->jobs().begin(ended));
  ASSERT_TRUE(store->jobs().begin(job_of(33, project)));  // of a server that is not a node
  EXPECT_EQ(store->jobs().begin(running).error().code, ErrorCode::conflict);

  auto jobs = by_id(*store->jobs().take_over(10));
  EXPECT_EQ(jobs.size(), 2u);
  EXPECT_EQ(jobs.at(32).state, "lost");
  EXPECT_EQ(jobs.at(33).state, "lost");
  running.state = "done";
  running.result = {{"model", 3}};
  ASSERT_TRUE(store->jobs().end(running));
  EXPECT_EQ(by_id(*store->jobs().take_over(10)).at(31).state, "done");
}

TEST(Jobs, an_end_that_is_known_is_not_written_over) {
  const auto dsn = test::fresh_database();
  const auto store = test::open_store(dsn);
  const auto project = store->projects().find("default")->id;
  ASSERT_TRUE(store->jobs().begin(job_of(1, project)));
  StoredJob ended = job_of(1, project);
  ended.state = "done";
  ended.result = {{"model", 3}};
  ASSERT_TRUE(store->jobs().end(ended));
  ended.state = "cancelled";
  ended.result = nullptr;
  ASSERT_TRUE(store->jobs().end(ended));
  EXPECT_EQ(store->jobs().take_over(10)->front().state, "done");
}

TEST(Jobs, success_is_written_with_what_it_made) {
  const auto dsn = test::fresh_database();
  const auto store = test::open_store(dsn);
  const auto project = store->projects().find("default")->id;
  ASSERT_TRUE(store->jobs().begin(job_of(21, project)));
  ASSERT_TRUE(store->jobs().begin(job_of(22, project)));
  Project fresh;
  fresh.name = "Made by a job";
  const auto answer = [](JobId job) {
    return IdempotentResponse<Project>{
        {},
        [](const Project& made) {
          return nlohmann::json{{"request", "x"}, {"model", made.id}};
        },
        {},
        job};
  };
  const auto made = store->projects().create(fresh, answer(21));
  ASSERT_TRUE(made);
  fresh.name = "";  // refused, so nothing is created and the job is not done
  EXPECT_FALSE(store->projects().create(fresh, answer(22)));
  auto jobs = by_id(*store->jobs().take_over(10));
  EXPECT_EQ(jobs.at(21).state, "done");
  EXPECT_EQ(jobs.at(21).result, (nlohmann::json{{"model", made->id}}));
  EXPECT_EQ(jobs.at(22).state, "lost");
}

TEST(Jobs, go_after_seven_days_and_with_their_project) {
  const auto dsn = test::fresh_database();
  const auto store = test::open_store(dsn);
  Project fresh;
  fresh.name = "Short-lived";
  const auto project = store->projects().create(fresh);
  ASSERT_TRUE(project);
  const auto stays = store->projects().find("default")->id;
  ASSERT_TRUE(store->jobs().begin(job_of(1, project->id)));
  ASSERT_TRUE(store->jobs().begin(job_of(2, stays)));
  ASSERT_TRUE(store->jobs().begin(job_of(3, stays)));
  ASSERT_EQ(store->jobs().take_over(10)->size(), 3u);
  auto connection = PgConnection::connect(dsn);
  ASSERT_TRUE(connection);
  ASSERT_TRUE(
      connection->query("UPDATE jobs SET ended = now() - interval '7 days 1 hour' WHERE id = 2"));
  ASSERT_TRUE(store->projects().remove(project->id));
  const auto left = store->jobs().take_over(10);
  ASSERT_EQ(left->size(), 1u);
  EXPECT_EQ(left->front().id, JobId(3));
  EXPECT_EQ(store->jobs().begin(job_of(4, 999999)).error().code, ErrorCode::not_found);
}

}  // namespace
}  // namespace strata::store
