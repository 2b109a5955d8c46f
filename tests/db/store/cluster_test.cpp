#include <gtest/gtest.h>
#include <libpq-fe.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>
#include <thread>

#include "store/cluster/cluster_process.h"
#include "support/test_cluster.h"

namespace strata::store {
namespace {

using test::TemporaryFolder;

std::string ask(const std::string& dsn, const char* sql) {
  const std::unique_ptr<PGconn, decltype(&PQfinish)> connection(PQconnectdb(dsn.c_str()),
                                                                &PQfinish);
  const std::unique_ptr<PGresult, decltype(&PQclear)> result(PQexec(connection.get(), sql),
                                                             &PQclear);
  return PQntuples(result.get()) == 1 ? PQgetvalue(result.get(), 0, 0)
                                      : PQerrorMessage(connection.get());
}

bool wait_until(const std::function<bool()>& done) {
  for (int i = 0; i < 600; ++i) {
    if (done()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
  return false;
}

TEST(Cluster, it_listens_on_its_socket_only_and_survives_a_restart_of_the_server) {
  TemporaryFolder folder;
  {
    auto cluster = Cluster::start(folder.path());
    ASSERT_TRUE(cluster) << cluster.error().detail;
    EXPECT_EQ(ask((*cluster)->dsn(), "SHOW listen_addresses"), "");
    EXPECT_EQ(ask((*cluster)->dsn(), "CREATE TABLE kept AS SELECT 7 AS n RETURNING 1").substr(0, 5),
              "ERROR");
    ask((*cluster)->dsn(), "CREATE TABLE kept AS SELECT 7 AS n");
  }
  auto again = Cluster::start(folder.path());
  ASSERT_TRUE(again) << again.error().detail;
  EXPECT_EQ(ask((*again)->dsn(), "SELECT n FROM kept"), "7");
}

TEST(Cluster, a_second_server_on_the_same_folder_is_refused) {
  TemporaryFolder folder;
  auto first = Cluster::start(folder.path());
  ASSERT_TRUE(first) << first.error().detail;
  auto second = Cluster::start(folder.path());
  ASSERT_FALSE(second);
  EXPECT_EQ(second.error().code, ErrorCode::conflict);
  EXPECT_EQ(ask((*first)->dsn(), "SELECT 1"), "1");
}

TEST(Cluster, a_killed_postmaster_is_started_again_with_its_data) {
  TemporaryFolder folder;
  auto cluster = Cluster::start(folder.path());
  ASSERT_TRUE(cluster) << cluster.error().detail;
  ask((*cluster)->dsn(), "CREATE TABLE kept AS SELECT 7 AS n");
  for (int round = 0; round < 3; ++round) {
    const int before = (*cluster)->postmaster_pid();
    test::kill_postmaster(**cluster);
    const auto running = (*cluster)->ensure_running();
    ASSERT_TRUE(running) << running.error().detail;
    EXPECT_NE((*cluster)->postmaster_pid(), before);
    EXPECT_EQ(ask((*cluster)->dsn(), "SELECT n FROM kept"), "7");
  }
}

TEST(Cluster, a_watched_cluster_comes_back_without_being_asked) {
  TemporaryFolder folder;
  auto cluster = Cluster::start(folder.path());
  ASSERT_TRUE(cluster) << cluster.error().detail;
  (*cluster)->watch();
  ASSERT_EQ(kill((*cluster)->postmaster_pid(), SIGKILL), 0);
  EXPECT_TRUE(wait_until([&] { return PQping((*cluster)->dsn().c_str()) == PQPING_OK; }));
}

TEST(Cluster, ensure_running_may_be_called_from_a_thread_that_ends) {
  TemporaryFolder folder;
  auto cluster = Cluster::start(folder.path());
  ASSERT_TRUE(cluster) << cluster.error().detail;
  test::kill_postmaster(**cluster);
  std::thread([&] { EXPECT_TRUE((*cluster)->ensure_running()); }).join();
  const int pid = (*cluster)->postmaster_pid();
  EXPECT_EQ(ask((*cluster)->dsn(), "SELECT pg_sleep(0.3)"), "");
  EXPECT_TRUE((*cluster)->ensure_running());
  EXPECT_EQ((*cluster)->postmaster_pid(), pid);
}

TEST(Cluster, the_database_stops_when_its_server_is_killed_and_a_new_server_takes_over) {
  TemporaryFolder folder;
  int channel[2];
  ASSERT_EQ(pipe(channel), 0);
  const pid_t server = fork();
  if (server == 0) {
    auto cluster = Cluster::start(folder.path());
    const int pid = cluster ? (*cluster)->postmaster_pid() : 0;
    if (write(channel[1], &pid, sizeof pid) != sizeof pid) _exit(1);
    for (;;) pause();
  }
  int postmaster = 0;
  ASSERT_EQ(read(channel[0], &postmaster, sizeof postmaster),
            static_cast<ssize_t>(sizeof postmaster));
  ASSERT_GT(postmaster, 0);
  kill(server, SIGKILL);
  waitpid(server, nullptr, 0);
  auto cluster = Cluster::start(folder.path());  // the old server may not have ended yet
  ASSERT_TRUE(cluster) << cluster.error().detail;
  EXPECT_EQ(ask((*cluster)->dsn(), "SELECT 1"), "1");
  EXPECT_NE((*cluster)->postmaster_pid(), postmaster);
}

TEST(Cluster, a_postmaster_that_somebody_else_started_is_not_ended) {
  TemporaryFolder folder;
  auto cluster = Cluster::start(folder.path());
  ASSERT_TRUE(cluster) << cluster.error().detail;
  const auto pgdata = folder.path() / "postgres" / "pgdata";
  EXPECT_FALSE(end_postmaster(pgdata, std::chrono::seconds(0), true));
  EXPECT_EQ(ask((*cluster)->dsn(), "SELECT 1"), "1");
  EXPECT_TRUE(end_postmaster(pgdata, std::chrono::minutes(5)));
}

TEST(Cluster, a_folder_with_a_very_long_path_works) {
  TemporaryFolder folder;
  auto cluster =
      Cluster::start(folder.path() / std::string(60, 'a') / (std::string(60, 'b') + " it's"));
  ASSERT_TRUE(cluster) << cluster.error().detail;
  EXPECT_EQ(ask((*cluster)->dsn(), "SELECT 1"), "1");
}

TEST(Cluster, an_initdb_that_was_cut_short_is_done_again) {
  TemporaryFolder folder;
  std::filesystem::create_directories(folder.path() / "postgres/pgdata.new/base");
  std::ofstream(folder.path() / "postgres/pgdata.new/PG_VERSION") << "15\n";
  auto cluster = Cluster::start(folder.path());
  ASSERT_TRUE(cluster) << cluster.error().detail;
}

TEST(Cluster, data_of_a_postgresql_that_is_not_installed_is_refused_by_name) {
  TemporaryFolder folder;
  std::filesystem::create_directories(folder.path() / "postgres/pgdata");
  std::ofstream(folder.path() / "postgres/pgdata/PG_VERSION") << "99\n";
  auto cluster = Cluster::start(folder.path());
  ASSERT_FALSE(cluster);
  EXPECT_NE(cluster.error().detail.find("PostgreSQL 99"), std::string::npos)
      << cluster.error().detail;
}

TEST(Cluster, a_folder_that_the_database_user_cannot_reach_is_refused_with_advice) {
  if (geteuid() != 0) GTEST_SKIP() << "SKIPPED: only as root is the database another user";
  TemporaryFolder folder;
  std::filesystem::create_directory(folder.path() / "private");
  std::filesystem::permissions(folder.path() / "private", std::filesystem::perms::owner_all);
  auto cluster = Cluster::start(folder.path() / "private/data");
  ASSERT_FALSE(cluster);
  EXPECT_EQ(cluster.error().title, "Data folder not reachable");
  EXPECT_NE(cluster.error().detail.find("/var/lib/strata"), std::string::npos);
}

}  // namespace
}  // namespace strata::store
