#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/progress.h"
#include "domain/scene/model.h"

namespace strata::store {
class Store;
}

namespace strata::app {

struct ImportedDeposit {
  Project project;
  std::vector<Model> models;
  std::int64_t layers = 0, tables = 0, records = 0, photographs = 0, files = 0;
  // Parts that a deposit describes but that a new project cannot contain, for people: "3 saved
  // states of Pot".
  std::vector<std::string> left_out;
};

// Makes a new project of a deposit (deposit.h), which is a bag in a folder. Checks the bag first.
// Slugs that the site already uses get a number. Texels, records, and the files of people are
// identical. docs/reference/deposits.md lists the losses. `slug` replaces the slug of the project,
// if it is not empty. After an error, no part of the project remains. Returns `invalid` with the
// name of the file for a damaged deposit. Blocks.
Result<ImportedDeposit> import_deposit(store::Store& store, const std::filesystem::path& bag,
                                       const std::string& slug, Progress& progress);

}  // namespace strata::app
