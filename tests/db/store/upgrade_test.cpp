// The change of a private cluster to a newer PostgreSQL: plans, refusals and failures. The newer
// version is a folder of scripts that fail. tests/e2e/api/upgrade_database_test.py uses a real one.
#include "store/cluster/upgrade.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <libpq-fe.h>
#include <stdlib.h>

#include <fstream>
#include <initializer_list>
#include <memory>
#include <optional>
#include <string>

#include "store/cluster/cluster_process.h"
#include "support/test_cluster.h"

namespace strata::store {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using Method = UpgradePlan::Method;

constexpr int kNewer = 99;

class UpgradeOfACluster : public ::testing::Test {
 protected:
  UpgradeOfACluster() {
    const char* listed = std::getenv("STRATA_POSTGRESQL");
    if (listed) before_ = listed;
    const auto newest = *installed_programs().rbegin();
    version_ = newest.first;
    fs::create_directories(programs());
    fs::create_directory_symlink(newest.second.parent_path(),
                                 programs() / std::to_string(version_));
    setenv("STRATA_POSTGRESQL", programs().c_str(), 1);
  }
  ~UpgradeOfACluster() override {
    if (before_)
      setenv("STRATA_POSTGRESQL", before_->c_str(), 1);
    else
      unsetenv("STRATA_POSTGRESQL");
  }

  fs::path data() const { return folder_.path() / "data"; }
  fs::path programs() const { return folder_.path() / "programs"; }
  fs::path aside() const {
    return data() / ("postgres-" + std::to_string(version_) + kBeforeUpgrade);
  }

  void make_site() {
    auto cluster = Cluster::start(data());
    ASSERT_TRUE(cluster) << cluster.error().detail;
    test::open_store((*cluster)->dsn(), 1);
  }
  // Succeeds if the site starts and has its tables.
  void check_site() {
    auto cluster = Cluster::start(data());
    ASSERT_TRUE(cluster) << cluster.error().detail;
    Progress progress;
    const auto facts = read_facts((*cluster)->dsn(), progress);
    ASSERT_TRUE(facts) << facts.error().detail;
    EXPECT_TRUE(facts->tables.contains("public.edits"));
  }

  void install(std::initializer_list<const char*> names) {
    const fs::path bin = programs() / std::to_string(kNewer) / "bin";
    fs::create_directories(bin);
    for (const char* name : names) {
      std::ofstream(bin / name) << "#!/bin/sh\necho not this version\nexit 1\n";
      fs::permissions(bin / name, fs::perms(0755));
    }
  }
  void install_all() {
    install({"postgres", "initdb", "pg_ctl", "pg_upgrade", "pg_dump", "pg_dumpall", "pg_restore",
             "psql", "vacuumdb", "pg_controldata", "pg_resetwal"});
  }

  test::TemporaryFolder folder_;
  std::optional<std::string> before_;
  int version_ = 0;
};

TEST_F(UpgradeOfACluster, the_plan_depends_on_the_installed_programs_and_changes_nothing) {
  EXPECT_EQ(plan_upgrade(data(), false).error().title, "No database");
  EXPECT_FALSE(fs::exists(data()));
  make_site();
  auto plan = plan_upgrade(data(), false);
  ASSERT_TRUE(plan) << plan.error().detail;
  EXPECT_EQ(plan->to, plan->from);

  install({"postgres"});
  EXPECT_EQ(plan_upgrade(data(), false).error().title, "Programs missing");
  install({"postgres", "initdb", "pg_restore"});
  plan = plan_upgrade(data(), false);
  ASSERT_TRUE(plan) << plan.error().detail;
  EXPECT_EQ(plan->method, Method::dump);
  EXPECT_EQ(plan->from, version_);
  EXPECT_EQ(plan->to, kNewer);
  EXPECT_FALSE(plan->running);
  EXPECT_GT(plan->bytes, 1u << 20);
  EXPECT_GT(plan->needed_bytes(false), 2 * plan->bytes);
  install_all();
  EXPECT_NE(plan_upgrade(data(), false)->method, Method::dump);
  EXPECT_EQ(plan_upgrade(data(), true)->method, Method::dump);

  fs::create_directory(aside());
  EXPECT_EQ(plan_upgrade(data(), false).error().title, "Earlier upgrade");
  fs::remove(aside());
  EXPECT_FALSE(fs::exists(data() / "upgrading"));
}

TEST_F(UpgradeOfACluster, a_running_server_is_recognised_and_not_disturbed) {
  make_site();
  install_all();
  auto cluster = Cluster::start(data());
  ASSERT_TRUE(cluster) << cluster.error().detail;
  const auto plan = plan_upgrade(data(), false);
  ASSERT_TRUE(plan) << plan.error().detail;
  EXPECT_TRUE(plan->running);
  EXPECT_GT(plan->needed_bytes(true), plan->needed_bytes(false) + (1u << 30))
      << "the running server keeps some space";
  auto dump = *plan;
  dump.method = Method::dump;
  EXPECT_GT(dump.needed_bytes(true), 3 * dump.bytes + (1u << 30)) << "the log of the new cluster";
  Progress progress;
  EXPECT_EQ(upgrade_cluster(*plan, progress).error().title, "Server running");
  EXPECT_FALSE(rehearse_upgrade(*plan, progress));
  EXPECT_EQ(PQping((*cluster)->dsn().c_str()), PQPING_OK);
  EXPECT_FALSE(fs::exists(data() / "upgrading"));
}

TEST_F(UpgradeOfACluster, after_a_failure_the_site_is_as_before) {
  make_site();
  install_all();
  for (const bool dump : {false, true}) {
    const auto plan = plan_upgrade(data(), dump);
    ASSERT_TRUE(plan) << plan.error().detail;
    Progress progress;
    const auto done = upgrade_cluster(*plan, progress);
    ASSERT_FALSE(done);
    EXPECT_THAT(done.error().detail, HasSubstr("initdb"));
    EXPECT_FALSE(fs::exists(data() / "upgrading"));
    EXPECT_FALSE(fs::exists(aside()));
  }
  check_site();
}

TEST_F(UpgradeOfACluster, a_full_disk_and_a_request_to_stop_end_it_early) {
  make_site();
  install_all();
  auto plan = plan_upgrade(data(), false);
  ASSERT_TRUE(plan) << plan.error().detail;
  Progress stopped;
  stopped.cancel();
  EXPECT_EQ(upgrade_cluster(*plan, stopped).error().code, ErrorCode::cancelled);
  plan->free_bytes = 1000;
  Progress progress;
  EXPECT_EQ(upgrade_cluster(*plan, progress).error().code, ErrorCode::storage_full);
  check_site();
}

TEST_F(UpgradeOfACluster, data_of_an_older_version_name_the_command) {
  make_site();
  install_all();
  fs::remove(programs() / std::to_string(version_));
  const auto started = Cluster::start(data());
  ASSERT_FALSE(started);
  EXPECT_THAT(started.error().detail, HasSubstr("strata upgrade-database"));
  EXPECT_THAT(plan_upgrade(data(), false).error().detail, HasSubstr("strata upgrade-database"));
}

TEST_F(UpgradeOfACluster, no_empty_site_starts_between_the_two_renames) {
  make_site();
  fs::rename(data() / "postgres", aside());
  const auto started = Cluster::start(data());
  ASSERT_FALSE(started);
  EXPECT_EQ(started.error().title, "Upgrade interrupted");
  EXPECT_FALSE(fs::exists(data() / "postgres"));
  fs::rename(aside(), data() / "postgres");
  check_site();
}

}  // namespace
}  // namespace strata::store
