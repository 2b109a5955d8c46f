#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <string>

#include "store/cluster/cluster.h"
#include "store/store.h"

namespace strata::cli {

// The options that select the data, and the database that they select.
struct DataOptions {
  std::filesystem::path data = "data";
  std::string database;
  store::FilesPlace files{};
  store::ClusterOptions cluster{};  // only for `serve`
  // false: a command that refuses a database of another version, instead of migrating it
  bool migrates = true;
};
void add_data_options(CLI::App& command, DataOptions& options);
// Only for commands that read or write scans and other large content.
void add_files_options(CLI::App& command, DataOptions& options);

struct OpenDatabase {
  std::unique_ptr<store::Cluster> cluster;  // null with --database
  std::unique_ptr<store::Store> store;      // destroyed before the cluster
  ~OpenDatabase() { store.reset(); }
};
Result<std::unique_ptr<OpenDatabase>> open_database(const DataOptions& options);
// Opens the database like `open_database`. If a server is using the data folder, connects to its
// database.
Result<std::unique_ptr<OpenDatabase>> open_database_beside(const DataOptions& options);

// Prints "title: detail" on stderr. Returns 1.
int report(const Error& problem);

}  // namespace strata::cli
