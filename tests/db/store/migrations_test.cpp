#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <thread>

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

TEST(Migrations, a_newer_schema_is_refused) {
  const auto dsn = test::empty_database();
  test::open_store(dsn);
  ASSERT_TRUE(connect(dsn).script("INSERT INTO schema_migrations VALUES ('999999')"));
  auto store = Store::open({dsn, 1}, STRATA_MIGRATIONS_DIR);
  ASSERT_FALSE(store);
  EXPECT_EQ(store.error().title, "Database is newer");
  EXPECT_NE(store.error().detail.find("999999"), std::string::npos);
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
