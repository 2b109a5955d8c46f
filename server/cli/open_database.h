#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "store/cluster/cluster.h"
#include "store/store.h"

namespace strata::cli {

// The options that name the data, and the database that they select.
struct DataOptions {
  std::filesystem::path data = "data";
  std::string database;
  std::optional<store::Cluster::SqlListen> sql{};  // of `serve`
};
void add_data_options(CLI::App& command, DataOptions& options);

struct OpenDatabase {
  std::unique_ptr<store::Cluster> cluster;  // null with --database
  std::unique_ptr<store::Store> store;      // destroyed before its cluster
  ~OpenDatabase() { store.reset(); }
};
Result<std::unique_ptr<OpenDatabase>> open_database(const DataOptions& options);
// The same, but if a server runs on that data, connects to its database.
Result<std::unique_ptr<OpenDatabase>> open_database_beside(const DataOptions& options);

// "title: detail" on stderr; returns 1.
int report(const Error& problem);

}  // namespace strata::cli
