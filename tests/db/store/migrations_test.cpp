#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <map>
#include <sstream>
#include <thread>

#include "core/version.h"
#include "store/cluster/inspect.h"
#include "store/cluster/migrations.h"
#include "store/content/projects.h"
#include "store/pg/pg.h"
#include "strata_dirs.h"
#include "support/test_cluster.h"

namespace strata::store {
namespace {

namespace fs = std::filesystem;

PgConnection connect(const std::string& dsn) {
  return std::move(PgConnection::connect(dsn).value());
}

void write(const fs::path& file, const std::string& text) { std::ofstream(file) << text; }

std::string read(const fs::path& file) {
  std::stringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

// Copies the real migrations. A test may add migrations to the copy.
void copy_migrations(const fs::path& folder) {
  for (const auto& entry : fs::directory_iterator(STRATA_MIGRATIONS_DIR))
    fs::copy_file(entry.path(), folder / entry.path().filename());
}

std::int64_t newest() { return read_migrations(STRATA_MIGRATIONS_DIR).value().back().number; }

// Writes a migration that creates a table with its number. `readers` are lines before the SQL.
void write_migration(const fs::path& folder, int number, const std::string& readers = {}) {
  write(
      folder / (std::to_string(number) + "_more.sql"),
      "-- migrate:up\n" + readers + "CREATE TABLE more_" + std::to_string(number) + " (n int);\n");
}

std::string readable_for_us() { return "-- readable-from: " + std::to_string(newest()) + "\n"; }

TEST(Migrations, applying_them_twice_is_harmless) {
  const auto dsn = test::empty_database();
  const auto first = test::open_store(dsn)->info().value();
  const auto second = test::open_store(dsn)->info().value();
  EXPECT_GE(first.schema_version, 3);
  EXPECT_EQ(first.schema_version, second.schema_version);
  EXPECT_EQ(first.server_version.substr(0, 2), "15");
  EXPECT_GT(first.database_bytes, 1'000'000u);
}

TEST(Migrations, twenty_servers_starting_at_once_are_harmless) {
  const auto dsn = test::empty_database();
  std::atomic<int> opened{0};
  std::vector<std::thread> servers;
  for (int i = 0; i < 20; ++i)
    servers.emplace_back([&] {
      auto store = Store::open({dsn, 1}, STRATA_MIGRATIONS_DIR);
      EXPECT_TRUE(store) << store.error().detail;
      if (store && (*store)->projects().find("default")) ++opened;
    });
  for (auto& server : servers) server.join();
  EXPECT_EQ(opened, 20);
  auto connection = connect(dsn);
  EXPECT_EQ(connection.query("SELECT count(*) FROM projects")->integer(0, 0), 1);
}

TEST(Migrations, jobs_on_regions_of_earlier_programs_get_their_own_kind) {
  test::TemporaryFolder folder;
  copy_migrations(folder.path());
  for (const auto& entry : fs::directory_iterator(STRATA_MIGRATIONS_DIR))
    if (const auto name = entry.path().filename(); name >= "000053")
      fs::remove(folder.path() / name);
  const auto dsn = test::empty_database();
  ASSERT_TRUE(Store::open({dsn, 1}, folder.path()));
  auto connection = connect(dsn);
  ASSERT_TRUE(connection.script(
      "INSERT INTO jobs (id, project_id, user_name, kind, state, ended, result) SELECT v.id, p.id, '', v.kind, 'done', now(), v.result "
      "FROM projects p, (VALUES (1, 'layers', '{\"report\": {\"operation\": \"sieve\"}}'::jsonb), "
      "(2, 'layers', '{\"report\": {\"from\": 7}}'), (3, 'layers', '{\"layers\": [1]}'), (4, 'import', NULL)) "
      "AS v (id, kind, result)"));
  ASSERT_TRUE(Store::open({dsn, 1}, STRATA_MIGRATIONS_DIR));
  EXPECT_EQ(connection.query("SELECT string_agg(kind, ' ' ORDER BY id) FROM jobs")->text(0, 0),
            "regions layers layers import");
}

TEST(Migrations, a_newer_schema_is_refused) {
  const auto dsn = test::empty_database();
  test::open_store(dsn);
  ASSERT_TRUE(connect(dsn).script("INSERT INTO schema_migrations VALUES ('999999')"));
  auto store = Store::open({dsn, 1}, STRATA_MIGRATIONS_DIR);
  ASSERT_FALSE(store);
  EXPECT_EQ(store.error().title, "Database is newer");
  EXPECT_NE(store.error().detail.find("999999"), std::string::npos);
}

TEST(Migrations, a_newer_schema_that_is_readable_can_be_used) {
  test::TemporaryFolder folder;
  copy_migrations(folder.path());
  write_migration(folder.path(), 900000, readable_for_us());
  const auto dsn = test::empty_database();
  ASSERT_TRUE(Store::open({dsn, 1}, STRATA_MIGRATIONS_DIR));
  const auto before = inspect_database(dsn, folder.path()).value();
  EXPECT_EQ(before.readable_after_update, newest()) << "nodes that are running could not continue";
  ASSERT_TRUE(Store::open({dsn, 1}, folder.path()));
  for (int again = 0; again < 2; ++again) {
    auto store = Store::open({dsn, 1}, STRATA_MIGRATIONS_DIR);
    ASSERT_TRUE(store) << store.error().detail;
    EXPECT_EQ((*store)->info()->schema_version, 900000);
    EXPECT_EQ((*store)->info()->readable_from, newest());
  }
  const auto state = inspect_database(dsn, STRATA_MIGRATIONS_DIR).value();
  EXPECT_EQ(state.schema_version, 900000);
  EXPECT_EQ(state.known_version, newest());
  EXPECT_EQ(state.readable_from, newest());
  EXPECT_EQ(state.applied_by, version());
}

TEST(Migrations, one_unreadable_migration_between_readable_ones_is_refused) {
  test::TemporaryFolder folder;
  copy_migrations(folder.path());
  write_migration(folder.path(), 900000);
  write_migration(folder.path(), 900001, readable_for_us());
  const auto dsn = test::empty_database();
  ASSERT_TRUE(Store::open({dsn, 1}, folder.path()));
  auto store = Store::open({dsn, 1}, STRATA_MIGRATIONS_DIR);
  ASSERT_FALSE(store);
  EXPECT_EQ(store.error().title, "Database is newer");
  EXPECT_NE(store.error().detail.find("900000 or a later one"), std::string::npos)
      << store.error().detail;
  EXPECT_NE(store.error().detail.find("Start Strata " + std::string(version())), std::string::npos)
      << store.error().detail;
  fs::remove(folder.path() / "900001_more.sql");
  EXPECT_TRUE(Store::open({dsn, 1}, folder.path()));
}

TEST(Migrations, a_program_that_lacks_an_earlier_migration_is_refused) {
  test::TemporaryFolder folder;
  copy_migrations(folder.path());
  write_migration(folder.path(), 800000);
  const auto dsn = test::empty_database();
  test::open_store(dsn);
  ASSERT_TRUE(
      connect(dsn).script("INSERT INTO schema_migrations (version, readable_from) VALUES "
                          "('900000', 44)"));
  auto store = Store::open({dsn, 1}, folder.path());  // 800000 would follow 900000
  ASSERT_FALSE(store);
  EXPECT_EQ(store.error().title, "Migrations differ");
  EXPECT_TRUE(connect(dsn).query("SELECT to_regclass('more_800000') IS NULL")->boolean(0, 0));
  ASSERT_TRUE(
      connect(dsn).script("INSERT INTO schema_migrations (version, readable_from) VALUES "
                          "('700000', 44)"));
  store = Store::open({dsn, 1}, folder.path());
  ASSERT_FALSE(store);
  EXPECT_EQ(store.error().title, "Migrations differ");
  EXPECT_NE(store.error().detail.find("700000"), std::string::npos) << store.error().detail;
}

TEST(Migrations, readers_are_found_from_all_migrations) {
  const auto from = [](std::map<std::int64_t, std::int64_t> migrations) {
    return Schema{std::move(migrations), {}}.readable_from();
  };
  EXPECT_EQ(from({}), 0);
  EXPECT_EQ(from({{1, 1}, {2, 2}, {44, 44}}), 44);
  EXPECT_EQ(from({{44, 44}, {45, 44}, {46, 45}}), 45);
  EXPECT_EQ(from({{44, 44}, {45, 44}, {46, 44}}), 44);
  EXPECT_EQ(from({{44, 44}, {45, 45}, {46, 44}}), 45) << "46 is readable, but 45 is not";
  EXPECT_EQ(from({{44, 44}, {46, 45}}), 45) << "numbers may have gaps";
}

TEST(Migrations, a_server_waits_for_another_one_that_migrates_but_not_for_ever) {
  const auto dsn = test::empty_database();
  const auto known = read_migrations(STRATA_MIGRATIONS_DIR).value();
  auto other = connect(dsn), ours = connect(dsn);
  ASSERT_TRUE(other.script("SELECT pg_advisory_lock(7130915062201)"));
  auto refused = migrate(ours, known, std::chrono::milliseconds(1));
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::unavailable);
  EXPECT_EQ(refused.error().title, "Database is being updated");
  std::atomic<bool> done{false};
  std::thread server([&] {
    EXPECT_TRUE(migrate(ours, known));
    done = true;
  });
  EXPECT_FALSE(done);
  EXPECT_TRUE(other.script("SELECT pg_advisory_unlock(7130915062201)"));
  server.join();
  EXPECT_TRUE(done);
}

TEST(Migrations, an_applied_file_that_was_edited_is_refused) {
  test::TemporaryFolder folder;
  copy_migrations(folder.path());
  const auto dsn = test::empty_database();
  ASSERT_TRUE(Store::open({dsn, 1}, folder.path()));
  const auto file = folder.path() / "000001_projects_and_models.sql";
  write(file, read(file) + "-- a word more\n");
  auto store = Store::open({dsn, 1}, folder.path());
  ASSERT_FALSE(store);
  EXPECT_EQ(store.error().title, "Migration changed");
}

TEST(Migrations, a_failing_file_leaves_nothing_behind_and_works_once_mended) {
  test::TemporaryFolder folder;
  copy_migrations(folder.path());
  const auto dsn = test::empty_database();
  write(
      folder.path() / "900000_more.sql",
      "-- migrate:up\nCREATE TABLE more (n int);\nSELECT 1/0;\n-- migrate:down\nDROP TABLE more;\n");
  auto store = Store::open({dsn, 1}, folder.path());
  ASSERT_FALSE(store);
  EXPECT_NE(store.error().detail.find("900000_more.sql"), std::string::npos);
  auto connection = connect(dsn);
  EXPECT_TRUE(connection.query("SELECT to_regclass('more') IS NULL")->boolean(0, 0));
  EXPECT_EQ(connection.query("SELECT count(*) FROM schema_migrations WHERE version = '900000'")
                ->integer(0, 0),
            0);
  write(folder.path() / "900000_more.sql",
        "-- migrate:up\nCREATE TABLE more (n int);\n-- migrate:down\nDROP TABLE more;\n");
  ASSERT_TRUE(Store::open({dsn, 1}, folder.path()));
  EXPECT_FALSE(connection.query("SELECT to_regclass('more')::text IS NULL")->boolean(0, 0));
}

TEST(Migrations, a_database_that_dbmate_migrated_is_taken_over) {
  const auto dsn = test::empty_database();
  auto connection = connect(dsn);
  ASSERT_TRUE(connection.script(
      "CREATE TABLE schema_migrations (version character varying(128) PRIMARY KEY)"));
  const auto known = read_migrations(STRATA_MIGRATIONS_DIR).value();
  for (const auto& migration : known)
    ASSERT_TRUE(connection.script("BEGIN;" + migration.sql +
                                  "INSERT INTO schema_migrations VALUES ('" + migration.version +
                                  "'); COMMIT"));
  ASSERT_TRUE(Store::open({dsn, 1}, STRATA_MIGRATIONS_DIR));
  EXPECT_EQ(connection.query("SELECT count(*) FROM schema_checksums")->integer(0, 0),
            static_cast<std::int64_t>(known.size()));
}

TEST(Migrations, a_folder_without_or_with_bad_files_is_refused) {
  test::TemporaryFolder folder;
  EXPECT_FALSE(read_migrations(folder.path()));
  EXPECT_FALSE(read_migrations(folder.path() / "missing"));
  write(folder.path() / "000001_a.sql", "CREATE TABLE a (n int);\n");
  EXPECT_NE(read_migrations(folder.path()).error().detail.find("migrate:up"), std::string::npos);
  write(folder.path() / "000001_a.sql", "-- migrate:up\n");
  EXPECT_TRUE(read_migrations(folder.path()));
  write(folder.path() / "0001_b.sql", "-- migrate:up\n");
  EXPECT_NE(read_migrations(folder.path()).error().detail.find("the same version"),
            std::string::npos);
  fs::remove(folder.path() / "0001_b.sql");
  write(folder.path() / "x_b.sql", "-- migrate:up\n");
  EXPECT_FALSE(read_migrations(folder.path()));
}

TEST(Migrations, a_malformed_line_about_readers_is_refused) {
  test::TemporaryFolder folder;
  write_migration(folder.path(), 900, "-- readable-from: 898\n");
  EXPECT_EQ(read_migrations(folder.path())->back().readable_from, 898);
  write_migration(folder.path(), 900, "-- The servers of version 2 can read this.\n");
  EXPECT_EQ(read_migrations(folder.path())->back().readable_from, 900);
  for (const char* line :
       {"-- readable-from:", "-- readable-from: ", "-- readable-from: x", "-- readable-from: 898 ",
        "-- readable-from: 898\r", "-- readable-from 898", "--readable-from: 898",
        " -- readable-from: 898", "-- Readable-From: 898", "-- readable_from: 898",
        "-- readable from: 898", "-- readable-from: -1", "-- readable-from: 43",
        "-- readable-from: 900", "-- readable-from: 9999999999999999999",
        "-- readable-from: 898\n-- readable-from: 899"}) {
    write_migration(folder.path(), 900, std::string(line) + "\n");
    const auto refused = read_migrations(folder.path());
    ASSERT_FALSE(refused) << line;
    EXPECT_NE(refused.error().detail.find("900_more.sql"), std::string::npos) << line;
  }
}

TEST(Migrations, all_files_of_the_project_are_well_formed) {
  const auto known = read_migrations(STRATA_MIGRATIONS_DIR);
  ASSERT_TRUE(known) << known.error().detail;
  for (const Migration& migration : *known) {
    EXPECT_EQ(migration.version.size(), 6u) << migration.name;
    if (migration.readable_from != migration.number) {
      EXPECT_TRUE(std::ranges::any_of(
          *known, [&](const Migration& other) { return other.number == migration.readable_from; }))
          << migration.name << " is readable from a migration that does not exist";
    }
  }
}

TEST(Migrations, the_schema_file_is_what_a_fresh_database_has) {
  const auto dsn = test::empty_database();
  test::open_store(dsn);
  const std::string command =
      std::string(STRATA_SOURCE_DIR) + "/tests/db/dump_schema.sh \"" + dsn + "\"";
  const std::unique_ptr<FILE, decltype(&pclose)> pipe(popen(command.c_str(), "r"), &pclose);
  std::string dumped;
  std::array<char, 4096> buffer{};
  for (std::size_t n; (n = fread(buffer.data(), 1, buffer.size(), pipe.get())) > 0;)
    dumped.append(buffer.data(), n);
  ASSERT_NE(dumped.find("CREATE TABLE"), std::string::npos);
  const fs::path file = fs::path(STRATA_SOURCE_DIR) / "db/schema.sql";
  if (std::getenv("STRATA_UPDATE_GOLDEN")) write(file, dumped);
  EXPECT_EQ(read(file), dumped) << "see tests/db/dump_schema.sh";
}

TEST(Migrations, looking_at_a_database_does_not_change_it) {
  const auto dsn = test::empty_database();
  const auto tables = [&] {
    return connect(dsn)
        .query("SELECT count(*) FROM pg_class WHERE relnamespace = 'public'::regnamespace")
        ->integer(0, 0);
  };
  const auto empty = inspect_database(dsn, STRATA_MIGRATIONS_DIR).value();
  EXPECT_EQ(empty.schema_version, 0);
  EXPECT_EQ(empty.encoding, "UTF8");
  EXPECT_EQ(tables(), 0);
  test::open_store(dsn);
  const auto made = inspect_database(dsn, STRATA_MIGRATIONS_DIR).value();
  EXPECT_EQ(made.schema_version, made.known_version);
  EXPECT_GT(made.bytes, 0u);
}

}  // namespace
}  // namespace strata::store
