#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "cli/open_database.h"
#include "core/error.h"

namespace strata::cli {

struct SupportOptions {
  std::filesystem::path file;                    // the zip file to write; must not exist
  std::vector<std::filesystem::path> log_files;  // in addition to the log of the private database
  std::string listen = "127.0.0.1:8080";         // of the server; only its port is used
};

// Writes a zip file with the facts that explain most problems of an installation, as text and JSON.
// `checks` is the report of the doctor, and `graphics` contains its findings about OpenGL.
//
// The names of people are replaced by pseudonyms. If the database cannot be read, the names are
// unknown, so the bundle contains no logs. Finally, the bundle is searched for the secrets of the
// installation. If the bundle contains a secret, no file is written (`conflict`).
Result<void> write_support_bundle(const DataOptions& data, const SupportOptions& options,
                                  const std::string& checks, const nlohmann::json& graphics);

}  // namespace strata::cli
