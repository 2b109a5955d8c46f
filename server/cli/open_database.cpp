#include "cli/open_database.h"

#include <iostream>

#include "cli/install_dirs.h"
#include "store/cluster/inspect.h"
#include "store/cluster/sql_readers.h"

namespace strata::cli {

void add_data_options(CLI::App& command, DataOptions& options) {
  command
      .add_option("--data", options.data, "Folder of the private database and uploads in progress")
      ->envname("STRATA_DATA")
      ->capture_default_str();
  command
      .add_option("--database", options.database,
                  "Use this PostgreSQL (libpq connection string) instead of a private one")
      ->envname("STRATA_DATABASE");
}

void add_files_options(CLI::App& command, DataOptions& options) {
  auto* files = command
                    .add_option("--files", options.files.place,
                                "Keep scans, photographs and documents outside the database: a "
                                "folder, or s3://BUCKET/PREFIX "
                                "(docs/how-to/keep-files-outside-the-database.md)")
                    ->envname("STRATA_FILES");
  command
      .add_option("--files-endpoint", options.files.endpoint,
                  "Address of an S3 server that is not Amazon's, https://HOST:PORT")
      ->envname("STRATA_FILES_ENDPOINT")
      ->needs(files);
}

namespace {

// Returns `conflict` if the database does not have exactly the migrations of this program.
Result<void> check_same_version(const std::string& dsn) {
  const auto schema = STRATA_TRY(store::inspect_database(dsn, install_dirs().migrations));
  if (schema.schema_version == schema.known_version) return {};
  return fail(ErrorCode::conflict, "Version mismatch",
              "The server of this database has a different version than this program. Use the "
              "program of that version, or restart the server.");
}

}  // namespace

Result<std::unique_ptr<OpenDatabase>> open_database(const DataOptions& options) {
  auto open = std::make_unique<OpenDatabase>();
  std::error_code error;
  std::filesystem::create_directories(options.data, error);
  if (error)
    return fail(
        ErrorCode::internal, "Data folder cannot be created",
        options.data.string() + ": " + error.message() + ". Specify another folder with --data.");
  store::StoreOptions store_options;
  store_options.dsn = options.database;
  store_options.files = options.files;
  if (options.database.empty()) {
    auto cluster =
        STRATA_TRY(store::Cluster::start(std::filesystem::absolute(options.data), options.cluster));
    open->cluster = std::move(cluster);
    store_options.dsn = open->cluster->dsn();
  }
  if (!options.migrates) STRATA_TRY(check_same_version(store_options.dsn));
  auto store = store::Store::open(store_options, install_dirs().migrations);
  if (!store) return tl::unexpected(store.error());
  open->store = std::move(*store);
  if (options.cluster.sql)
    if (auto admitted = store::admit_readers(store_options.dsn, options.data / "sql-password");
        !admitted)
      return tl::unexpected(admitted.error());
  return open;
}

Result<std::unique_ptr<OpenDatabase>> open_database_beside(const DataOptions& options) {
  if (!options.database.empty()) return open_database(options);
  const auto state = store::Cluster::inspect(options.data);
  if (!state.running && state.version == 0 && !state.trouble)
    return fail(ErrorCode::not_found, "No database",
                "There is no database in " + std::filesystem::absolute(options.data).string() +
                    ". Specify the server's folder with --data, or start the server to create a "
                    "database.");
  if (!state.running) return open_database(options);
  // While a server is running, no other program may migrate its database. The server migrates it
  // when it starts.
  STRATA_TRY(check_same_version(state.dsn));
  DataOptions beside = options;
  beside.database = state.dsn;
  return open_database(beside);
}

int report(const Error& problem) {
  std::cerr << "strata: " << problem.title << ": " << problem.detail
            << (problem.field.empty() ? "" : " (" + problem.field + ")") << std::endl;
  return 1;
}

}  // namespace strata::cli
