#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <utility>
#include <vector>

#include "app/deposit/bag.h"
#include "app/services.h"
#include "core/progress.h"
#include "domain/people/role.h"
#include "domain/scene/model.h"
#include "domain/tables/table.h"
#include "protocol/messages.h"

// The parts of a deposit. Each function adds the files of a part to the bag.
namespace strata::app {

// The names of files that `strata import-deposit` reads.
inline constexpr const char* kProjectFile = "project.json";
inline constexpr const char* kModelFile = "model.json";
inline constexpr const char* kDepositFormat = "strata-deposit";
inline constexpr int kDepositVersion = 1;

struct DepositReader {
  const Services& services;
  const Author& reader;
  Progress& progress;
};

// Adds a model, and returns the path of its model.json. `object` is the name of its object.
Result<std::string> add_model(Bag& bag, const DepositReader& from, const Model& model,
                              const std::string& object);
// Adds a table, and returns its description in project.json: its columns, and the paths of its
// records and attachments.
Result<nlohmann::json> add_table(Bag& bag, const DepositReader& from, const Table& table);

// Adds ro-crate-metadata.json and ro-crate-preview.html, which describe the files in the bag.
Result<void> add_ro_crate(Bag& bag, const Project& project, const std::vector<Model>& models,
                          const protocol::DepositRecord& record);

}  // namespace strata::app
