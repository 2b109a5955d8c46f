#include "app/deposit/import_deposit.h"

#include <nlohmann/json.hpp>

#include "app/deposit/crate_json.h"
#include "app/deposit/deposit_parts.h"
#include "app/deposit/import_parts.h"
#include "app/deposit/metadata.h"
#include "app/deposit/read_bag.h"
#include "core/unzip.h"
#include "media/media_type.h"
#include "media/picture.h"
#include "protocol/parse.h"
#include "store/content/layers.h"
#include "store/content/metadata.h"
#include "store/content/models.h"
#include "store/content/projects.h"
#include "store/journal/journal_reads.h"
#include "store/store.h"
#include "store/tables/tables.h"

namespace strata::app {
namespace fs = std::filesystem;
namespace {

using nlohmann::json;

// The stages of the task.
constexpr double kChecked = 0.2, kTables = 0.25, kModels = 0.8, kRecords = 0.95;
constexpr std::uint64_t kMaxJson = std::uint64_t{256} << 20;

Result<void> check_format(const json& all) {
  if (all.value("format", "") != kDepositFormat)
    return fail(ErrorCode::invalid, "Not a deposit of Strata",
                "The bag was not made by Strata. Import its scans with `strata import`.");
  if (all.at("version").get<int>() != kDepositVersion)
    return fail(ErrorCode::invalid, "Newer deposit",
                "The deposit was made by Strata " + all.value("program", "") +
                    ". Import it with this version or a later one.");
  return {};
}

// Layers that were computed from other layers are now as up to date as in the deposit.
Result<void> finish_formulas(const Import& import, const json& model) {
  const ModelId id = import.ids.models.at(model.at("model").at("id").get<ModelId>());
  const auto last = STRATA_TRY(import.store.journal().last_sequence(id));
  for (const json& each : model.at("layers")) {
    const Layer stored = crate::layer_of(each);
    if (!stored.formula) continue;
    const LayerId made = import.ids.layers.at(stored.id);
    Layer layer = STRATA_TRY(import.store.layers().find(id, to_string(made), Role::owner));
    if (stored.formula->automatic) {
      layer.formula->automatic = true;
      layer = STRATA_TRY(import.store.layers().update(layer));
    }
    if (stored.edited_by_hand) continue;
    const auto tables = STRATA_TRY(import.store.layers().table_sequences_of(made));
    STRATA_TRY(import.store.layers().set_computed(made, stored.formula->expression, last, tables));
  }
  return {};
}

Result<void> import_all(const Import& import, const json& all) {
  Progress& progress = import.progress;
  progress.begin_stage(kChecked, kTables);
  STRATA_TRY(import_tables(import, all.at("tables")));
  std::vector<json> models;
  const double count = static_cast<double>(all.at("models").size());
  for (const json& path : all.at("models")) {
    const auto done = static_cast<double>(models.size());
    progress.begin_stage(kTables + (kModels - kTables) * done / count,
                         kTables + (kModels - kTables) * (done + 1) / count);
    auto model = STRATA_TRY(import.read_json(path.get<std::string>()));
    STRATA_TRY(import_model(import, model));
    models.push_back(std::move(model));
  }
  progress.begin_stage(kModels, kRecords);
  STRATA_TRY(import_records(import, all.at("tables")));
  progress.begin_stage(kRecords, 1);
  for (const json& model : models) {
    STRATA_TRY(import_model_parts(import, model));
    STRATA_TRY(finish_formulas(import, model));
  }
  import.made.models = STRATA_TRY(import.store.models().all(import.made.project.id));
  return {};
}

// Deletes everything that an import has made. An error here leaves parts, which a user can delete.
void remove_all(store::Store& store, const Project& project) {
  if (const auto models = store.models().all(project.id))
    for (const Model& model : *models) static_cast<void>(store.models().remove(model.id));
  // A table can be deleted only after the tables that name it.
  for (bool goes_on = true; goes_on;) {
    goes_on = false;
    const auto tables = store.tables().of_project(project.id, Role::owner);
    if (!tables) break;
    for (const Table& table : *tables)
      if (store.tables().remove(table.id)) goes_on = true;
  }
  static_cast<void>(store.projects().remove(project.id));
}

Result<Project> make_project(store::Store& store, const json& all, const std::string& slug) {
  Project project;
  project.name = all.at("project").at("name").get<std::string>();
  project.slug = slug.empty() ? all.at("project").at("slug").get<std::string>() : slug;
  project.description = all.at("project").at("description").get<std::string>();
  const std::string base = project.slug;
  for (int i = 2;; ++i) {
    const auto known = store.projects().find(project.slug);
    if (!known && known.error().code == ErrorCode::not_found) break;
    if (!known) return tl::unexpected(known.error());
    if (!slug.empty())
      return fail(ErrorCode::conflict, "Slug already used",
                  "The site already has a project `" + slug + "`. Choose another slug.", "--slug");
    project.slug = base + "-" + std::to_string(i);
  }
  return store.projects().create(project);
}

Result<void> keep_metadata(store::Store& store, const Project& project, const json& all) {
  const auto record = STRATA_TRY(protocol::from_json<protocol::DepositRecord>(all.at("metadata")));
  const auto checked = STRATA_TRY(checked_metadata(record));
  STRATA_TRY(store.metadata().replace(project.id, protocol::to_json(checked), 0));
  return {};
}

}  // namespace

tl::unexpected<Error> damaged(const std::string& file, const std::string& why) {
  return fail(ErrorCode::invalid, "Deposit damaged",
              "The file " + file + " of the deposit " + why + ".");
}

Result<fs::path> Import::place_of(const std::string& path) const {
  if (!is_safe_path(path)) return damaged(path, "has a path that is not allowed");
  fs::path place = payload / fs::path(path);
  std::error_code error;
  if (!fs::is_regular_file(fs::symlink_status(place, error))) return damaged(path, "is missing");
  return place;
}

Result<MappedFile> Import::open(const std::string& path) const {
  const auto place = STRATA_TRY(place_of(path));
  return MappedFile::open(place);
}

Result<json> Import::read_json(const std::string& path) const {
  const auto file = STRATA_TRY(open(path));
  if (file.bytes().size() > kMaxJson) return damaged(path, "is too large");
  json parsed = json::parse(file.view(), nullptr, false);
  if (parsed.is_discarded()) return damaged(path, "is not JSON");
  return parsed;
}

FileFacts facts_of(const MappedFile& file, const std::string& name) {
  const auto bytes = file.bytes();
  FileFacts facts;
  facts.media_type = sniff_media_type(bytes.first(std::min(bytes.size(), kSniffedBytes)), name);
  if (is_raster_picture(facts.media_type))
    if (const auto info = inspect_picture(bytes)) {
      facts.width = info->width;
      facts.height = info->height;
    }
  return facts;
}

Result<ImportedDeposit> import_deposit(store::Store& store, const fs::path& bag,
                                       const std::string& slug, Progress& progress) {
  progress.begin_stage(0, kChecked);
  STRATA_TRY(check_bag(bag, progress));
  ImportedDeposit made;
  ImportIds ids;
  const Import import{store, bag / "data", progress, made, ids};
  const json all = STRATA_TRY(import.read_json(kProjectFile));
  bool has_project = false;
  const auto work = [&]() -> Result<void> {
    STRATA_TRY(check_format(all));
    made.project = STRATA_TRY(make_project(store, all, slug));
    has_project = true;
    STRATA_TRY(keep_metadata(store, made.project, all));
    return import_all(import, all);
  };
  Result<void> done;
  try {
    done = work();
  } catch (const json::exception& error) {
    done = damaged("project.json or model.json", std::string("has another form: ") + error.what());
  } catch (const std::domain_error& error) {
    done = damaged("project.json or model.json", std::string("has another form: ") + error.what());
  } catch (const std::out_of_range&) {
    done = damaged("project.json or model.json", "names a part that it does not contain");
  } catch (const std::bad_alloc&) {
    done = fail(ErrorCode::out_of_memory, "Not enough memory",
                "The deposit needs more memory than the machine has.");
  } catch (const std::exception& error) {
    done = fail(ErrorCode::internal, "Deposit not imported", error.what());
  }
  if (done) return made;
  if (has_project) remove_all(store, made.project);
  return tl::unexpected(done.error());
}

}  // namespace strata::app
