// The archive of a private cluster: copies, retention, interruptions, and recovery to a moment.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <libpq-fe.h>

#include <chrono>
#include <fstream>
#include <functional>
#include <memory>
#include <thread>

#include "store/cluster/archive_copies.h"
#include "store/cluster/archive_keeper.h"
#include "store/cluster/archive_restore.h"
#include "support/test_cluster.h"

namespace strata::store {
namespace {

namespace fs = std::filesystem;
using std::chrono::system_clock;
using test::TemporaryFolder;
using ::testing::HasSubstr;

constexpr std::chrono::hours kWeek{7 * 24};
const auto kAlways = [] { return true; };

std::string ask(const std::string& dsn, const std::string& sql) {
  const std::unique_ptr<PGconn, decltype(&PQfinish)> connection(PQconnectdb(dsn.c_str()),
                                                                &PQfinish);
  const std::unique_ptr<PGresult, decltype(&PQclear)> result(PQexec(connection.get(), sql.c_str()),
                                                             &PQclear);
  return PQntuples(result.get()) == 1 ? PQgetvalue(result.get(), 0, 0)
                                      : PQerrorMessage(connection.get());
}

bool wait_until(const std::function<bool()>& done) {
  for (int i = 0; i < 1800; ++i) {
    if (done()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
  return false;
}

std::size_t entries_of(const fs::path& folder) {
  return static_cast<std::size_t>(
      std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

class ArchiveOfACluster : public ::testing::Test {
 protected:
  ArchiveOfACluster() { start(); }

  void start() {
    cluster_.reset();
    ClusterOptions options;
    options.archive = archive_folder();
    options.settings = {"autovacuum=off"};  // so that only the test changes data
    auto cluster = Cluster::start(data(), options);
    ASSERT_TRUE(cluster) << cluster.error().detail;
    cluster_ = std::move(*cluster);
    // `read_site` of archive_restore.cpp counts the rows of these tables
    for (const char* table : {"projects", "models"})
      run(std::string("CREATE TABLE IF NOT EXISTS ") + table + " (id int)");
    run("CREATE TABLE IF NOT EXISTS edits (number int, "
        "time timestamptz DEFAULT clock_timestamp())");
  }
  void run(const std::string& sql) { ask(cluster_->dsn(), sql); }
  void edit(int number) {
    run("INSERT INTO edits (number) VALUES (" + std::to_string(number) + ")");
  }

  // Ends the current segment, and waits until PostgreSQL has archived it.
  void archive_now() {
    const auto segment =
        parse_wal_name(ask(cluster_->dsn(), "SELECT pg_walfile_name(pg_switch_wal())"));
    ASSERT_TRUE(segment);
    ASSERT_TRUE(wait_until([&] { return archive().segments().contains(*segment); }));
  }
  ArchiveFolder::Copy copy_now() {
    auto copy = make_copy(archive(), *cluster_, kAlways);
    EXPECT_TRUE(copy) << copy.error().detail;
    return copy ? *copy : ArchiveFolder::Copy{};
  }
  // Returns a moment after all earlier changes and before all later changes.
  static system_clock::time_point moment() {
    const auto now = std::chrono::ceil<std::chrono::milliseconds>(system_clock::now());
    while (system_clock::now() <= now) std::this_thread::yield();
    return now;
  }

  const ArchiveFolder& archive() const { return *cluster_->archive(); }
  fs::path archive_folder() const { return folder_.path() / "an archive's 100% folder"; }
  fs::path data() const { return folder_.path() / "data"; }
  fs::path target() const { return folder_.path() / "restored"; }

  Result<RestoredSite> restored(const std::optional<system_clock::time_point>& at) {
    auto plan = plan_restore(archive(), at);
    if (!plan) return tl::unexpected(plan.error());
    std::error_code ignored;
    fs::remove_all(target(), ignored);
    Progress progress;
    return restore_archive(archive(), *plan, target(), progress);
  }

  TemporaryFolder folder_;
  std::unique_ptr<Cluster> cluster_;
};

TEST_F(ArchiveOfACluster, the_oldest_copies_and_only_their_wal_are_deleted) {
  std::vector<ArchiveFolder::Copy> made;
  for (int number = 1; number <= 3; ++number) {
    made.push_back(copy_now());
    edit(number);
    archive_now();
  }
  ASSERT_EQ(archive().copies().size(), 3u);
  drop_old(archive(), 2);
  const auto kept = archive().copies();
  ASSERT_EQ(kept.size(), 2u);
  EXPECT_EQ(kept.front().folder, made[1].folder);
  EXPECT_EQ(kept.back().folder, made[2].folder);
  EXPECT_EQ(entries_of(archive().copies_folder()), 2u);
  const auto segments = archive().segments();
  EXPECT_EQ(*segments.begin(), made[1].first);
  drop_old(archive(), 2);
  EXPECT_EQ(archive().segments(), segments);

  const auto site = restored(std::nullopt);
  ASSERT_TRUE(site) << site.error().detail;
  EXPECT_EQ(site->edits, 3);
}

TEST_F(ArchiveOfACluster, a_moment_between_two_edits_is_restored) {
  edit(1);
  const auto copy = copy_now();
  edit(2);
  const auto between = moment();
  edit(3);
  run("DROP TABLE projects");
  archive_now();
  const auto site = restored(between);
  ASSERT_TRUE(site) << site.error().detail;
  EXPECT_EQ(site->edits, 2);
  EXPECT_LE(site->reached, between);
  EXPECT_LE(*site->last_edit, between);
  // The original is unchanged, and the copy is still complete.
  EXPECT_EQ(ask(cluster_->dsn(), "SELECT count(*) FROM edits"), "3");
  ASSERT_EQ(archive().copies().size(), 1u);
  EXPECT_EQ(archive().copies().front().folder, copy.folder);

  auto again = Cluster::start(target());
  ASSERT_TRUE(again) << again.error().detail;
  EXPECT_EQ(ask((*again)->dsn(), "SELECT string_agg(number::text, ',' ORDER BY number) FROM edits"),
            "1,2");
  EXPECT_EQ(ask((*again)->dsn(), "SHOW archive_mode"), "off");
}

TEST_F(ArchiveOfACluster, moments_outside_the_archive_are_refused_by_name) {
  const auto before = moment();
  EXPECT_EQ(restored(std::nullopt).error().code, ErrorCode::not_found);  // no copy yet
  copy_now();
  EXPECT_EQ(restored(before).error().title, "Before the first copy");
  EXPECT_EQ(restored(system_clock::now() + kWeek).error().title, "Moment in the future");
  edit(1);
  archive_now();
  const auto late = restored(moment());
  ASSERT_FALSE(late);
  EXPECT_EQ(late.error().title, "After the last archived change");
  const auto site = restored(std::nullopt);
  ASSERT_TRUE(site) << site.error().detail;
  EXPECT_EQ(site->edits, 1);
}

TEST_F(ArchiveOfACluster, missing_and_damaged_wal_is_no_silent_end) {
  const auto copy = copy_now();
  archive_now();
  edit(1);
  archive_now();
  const WalSegment second{copy.first.timeline, copy.first.number + 1};
  const fs::path file = archive().wal() / (wal_name(second) + ".gz");
  ASSERT_TRUE(fs::exists(file));
  edit(2);
  const auto later = moment();
  edit(3);
  archive_now();
  std::ofstream(file, std::ios::trunc) << "damaged";
  EXPECT_EQ(restored(later).error().title, "Archive damaged");
  fs::remove(file);
  EXPECT_EQ(restored(std::nullopt).error().title, "Archive incomplete");
  EXPECT_EQ(restored(later).error().title, "Archive incomplete");
  EXPECT_TRUE(*needs_copy(archive(), *cluster_, kWeek));
}

TEST_F(ArchiveOfACluster, a_damaged_copy_is_not_restored) {
  const auto copy = copy_now();
  const fs::path file = copy.folder / "global/pg_filenode.map";
  std::ofstream(file, std::ios::app) << "x";
  const auto site = restored(std::nullopt);
  ASSERT_FALSE(site);
  EXPECT_THAT(site.error().detail, HasSubstr("pg_filenode.map"));
}

TEST_F(ArchiveOfACluster, a_copy_is_needed_if_there_is_none_or_it_is_old_or_wal_is_missing) {
  EXPECT_TRUE(*needs_copy(archive(), *cluster_, kWeek));
  copy_now();
  EXPECT_FALSE(*needs_copy(archive(), *cluster_, kWeek));
  archive_now();
  EXPECT_FALSE(*needs_copy(archive(), *cluster_, kWeek));
  EXPECT_TRUE(*needs_copy(archive(), *cluster_, std::chrono::hours(0)));

  // A server without the archive fills segments that nobody archives.
  cluster_.reset();
  {
    auto without = Cluster::start(data());
    ASSERT_TRUE(without) << without.error().detail;
    for (int i = 0; i < 2; ++i) {
      ask((*without)->dsn(), "CREATE TABLE more AS SELECT 1");
      ask((*without)->dsn(), "DROP TABLE more");
      ask((*without)->dsn(), "SELECT pg_switch_wal()");
    }
  }
  start();
  EXPECT_TRUE(*needs_copy(archive(), *cluster_, kWeek));
  copy_now();
  EXPECT_FALSE(*needs_copy(archive(), *cluster_, kWeek));
}

TEST_F(ArchiveOfACluster, an_interrupted_copy_is_recognised_and_removed) {
  const auto cancelled = make_copy(archive(), *cluster_, [] { return false; });
  ASSERT_FALSE(cancelled);
  EXPECT_EQ(cancelled.error().code, ErrorCode::cancelled);
  // A killed server leaves the copy with its name for unfinished copies.
  const auto whole = copy_now();
  fs::path part = whole.folder;
  part += kUnfinished;
  fs::rename(whole.folder, part);
  EXPECT_TRUE(archive().copies().empty());
  EXPECT_TRUE(*needs_copy(archive(), *cluster_, kWeek));
  drop_unfinished(archive());
  EXPECT_FALSE(fs::exists(part));
}

TEST_F(ArchiveOfACluster, the_keeper_makes_the_first_copy_and_removes_an_interrupted_one) {
  const fs::path part = archive().copies_folder() / (std::string("interrupted") + kUnfinished);
  fs::create_directory(part);
  ArchiveKeeper keeper(*cluster_, {kWeek, 2});
  EXPECT_TRUE(wait_until([&] { return keeper.status().copied.has_value(); }));
  EXPECT_FALSE(fs::exists(part));
  EXPECT_EQ(archive().copies().size(), 1u);
  EXPECT_EQ(keeper.status().failed_copies, 0u);
}

TEST_F(ArchiveOfACluster, the_archiver_reports_failures_and_never_replaces_other_content) {
  archive_now();
  const auto segment = parse_wal_name(
      ask(cluster_->dsn(), "SELECT pg_walfile_name(pg_current_wal_insert_lsn() + 1)"));
  ASSERT_TRUE(segment);
  const fs::path file = archive().wal() / (wal_name(*segment) + ".gz");
  std::ofstream(file) << "other content";
  edit(1);
  run("SELECT pg_switch_wal()");
  ASSERT_TRUE(wait_until([&] {
    const auto state = archiver_state(cluster_->dsn());
    return state && state->archiving && state->failing && state->failures > 0;
  }));
  std::string content;
  std::ifstream(file) >> content;
  EXPECT_EQ(content, "other");
  fs::remove(file);
  EXPECT_TRUE(wait_until([&] { return !archiver_state(cluster_->dsn())->failing; }));
}

TEST_F(ArchiveOfACluster, an_archive_belongs_to_one_data_folder) {
  copy_now();
  edit(1);
  archive_now();
  ASSERT_TRUE(restored(std::nullopt));
  ClusterOptions options;
  options.archive = archive_folder();
  for (const fs::path& other : {folder_.path() / "other", target()}) {
    const auto refused = Cluster::start(other, options);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().title, "Archive of another site");
  }
  start();  // the archive still accepts its own cluster
}

TEST_F(ArchiveOfACluster, unsuitable_folders_are_refused) {
  cluster_.reset();
  const auto refusal = [&](const fs::path& archive) {
    ClusterOptions options;
    options.archive = archive;
    const auto started = Cluster::start(data(), options);
    return started ? "none" : started.error().title;
  };
  EXPECT_EQ(refusal(data() / "archive"), "Archive in the data folder");
  EXPECT_EQ(refusal(data()), "Archive in the data folder");
  EXPECT_EQ(refusal(folder_.path()), "Archive in the data folder");
  fs::create_directory(folder_.path() / "used");
  std::ofstream(folder_.path() / "used/file") << "x";
  EXPECT_EQ(refusal(folder_.path() / "used"), "Not an archive");
  // The disk of the archive is not mounted.
  fs::rename(archive_folder(), folder_.path() / "elsewhere");
  EXPECT_EQ(refusal(archive_folder()), "Archive missing");
  fs::rename(folder_.path() / "elsewhere", archive_folder());
  EXPECT_EQ(refusal(archive_folder()), "none");
}

}  // namespace
}  // namespace strata::store
