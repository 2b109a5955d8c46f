#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "app/deposit/import_deposit.h"
#include "core/ids.h"
#include "core/mapped_file.h"
#include "core/progress.h"
#include "domain/tables/table.h"
#include "store/content/photographs.h"

// The parts of an import. The functions throw the exceptions of crate_json.h for a JSON text of
// another form.
namespace strata::app {

inline constexpr const char* kImporter = "Strata";  // the author of entries in the journals

// The ids in a deposit and those in the new project.
struct ImportIds {
  std::map<ModelId, ModelId> models;
  std::map<LayerId, LayerId> layers;
  std::map<SurfaceImageId, SurfaceImageId> images;
  std::map<TableId, TableId> tables;
  std::map<ColumnId, ColumnId> columns;
  std::map<NamedPartId, NamedPartId> views;
};

// An `invalid` error for a file of a bag whose content does not have the form of a deposit.
tl::unexpected<Error> damaged(const std::string& file, const std::string& why);

struct Import {
  store::Store& store;
  std::filesystem::path payload;  // the folder `data` of the bag
  Progress& progress;
  ImportedDeposit& made;
  ImportIds& ids;

  // Opens a file of the payload. Returns an `invalid` error for a path that leads out of it.
  Result<MappedFile> open(const std::string& path) const;
  Result<std::filesystem::path> place_of(const std::string& path) const;
  Result<nlohmann::json> read_json(const std::string& path) const;
};

// Makes the tables of project.json without records.
Result<void> import_tables(const Import& import, const nlohmann::json& tables);
// Adds the records and their files, after all models.
Result<void> import_records(const Import& import, const nlohmann::json& tables);
// Makes a model with its layers, images and photographs.
Result<void> import_model(const Import& import, const nlohmann::json& all);
// Adds the views, tours and comments of a model, after the records.
Result<void> import_model_parts(const Import& import, const nlohmann::json& all);

// The facts about a file that the server serves, from its bytes.
struct FileFacts {
  std::string media_type;
  std::optional<int> width, height;
};
FileFacts facts_of(const MappedFile& file, const std::string& name);

}  // namespace strata::app
