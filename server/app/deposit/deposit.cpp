#include "app/deposit/deposit.h"

#include <map>
#include <nlohmann/json.hpp>

#include "app/deposit/datacite.h"
#include "app/deposit/deposit_parts.h"
#include "core/text/csv.h"
#include "core/uuid.h"
#include "core/version.h"
#include "store/cluster/scratch_folder.h"
#include "store/content/models.h"
#include "store/content/objects.h"
#include "store/people/members.h"
#include "store/store.h"
#include "store/tables/attachments.h"
#include "store/tables/tables.h"

namespace strata::app {
namespace fs = std::filesystem;
namespace {

// The stages of the job.
constexpr double kRead = 0.6, kDescribed = 0.65;

BagFile described(std::string path, std::string media_type, std::string description) {
  BagFile file;
  file.path = std::move(path);
  file.media_type = std::move(media_type);
  file.description = std::move(description);
  return file;
}

// Names and roles only: the deposit contains no accounts.
Result<void> add_people(Bag& bag, store::Store& store, const Project& project) {
  std::string text = csv_line({"name", "full_name", "role"}, ',');
  const auto members = STRATA_TRY(store.members().of_project(project.id));
  for (const auto& member : members)
    text += csv_line({guard_formula(member.person.name), guard_formula(member.person.full_name),
                      std::string(name(member.role))},
                     ',');
  return bag.add(described("people.csv", "text/csv", "People with a role in the project"), text);
}

Result<std::map<ObjectId, std::string>> objects_of(store::Store& store, const Project& project) {
  const auto page = STRATA_TRY(
      store.objects().of_project(project.id, static_cast<int>(store::Objects::kMaxObjects), 0, 0));
  std::map<ObjectId, std::string> names;
  for (const SurveyedObject& object : page.objects) names[object.id] = object.name;
  return names;
}

// Adds all parts, and returns the models.
Result<std::vector<Model>> add_parts(Bag& bag, const DepositReader& from,
                                     const DepositRequest& request) {
  store::Store& store = from.services.store;
  const Project& project = request.project;
  nlohmann::json all{
      {"format", kDepositFormat},
      {"version", kDepositVersion},
      {"program", version()},
      {"project",
       {{"name", project.name}, {"slug", project.slug}, {"description", project.description}}},
      {"metadata", protocol::to_json(request.record)},
      {"tables", nlohmann::json::array()},
      {"models", nlohmann::json::array()}};
  const auto tables = STRATA_TRY(store.tables().of_project(project.id, request.reader.role));
  auto models = STRATA_TRY(store.models().all(project.id));
  const double steps = static_cast<double>(tables.size() + models.size());
  double done = 0;
  const auto begin_step = [&] {
    from.progress.begin_stage(kRead * done / steps, kRead * (done + 1) / steps);
    ++done;
  };
  for (const Table& table : tables) {
    begin_step();
    auto added = STRATA_TRY(add_table(bag, from, table));
    all["tables"].push_back(std::move(added));
  }
  const auto objects = STRATA_TRY(objects_of(store, project));
  for (const Model& model : models) {
    begin_step();
    const auto object = model.object ? objects.find(*model.object) : objects.end();
    auto path = STRATA_TRY(
        add_model(bag, from, model, object == objects.end() ? std::string() : object->second));
    all["models"].push_back(std::move(path));
  }
  STRATA_TRY(add_people(bag, store, project));
  STRATA_TRY(bag.add(described("metadata/datacite.json", "application/json", "DataCite metadata"),
                     datacite_json(request.record).dump(2)));
  STRATA_TRY(bag.add(described("metadata/datacite.xml", "application/xml", "DataCite metadata"),
                     datacite_xml(request.record)));
  STRATA_TRY(bag.add(described(kProjectFile, "application/json", "Properties of the project"),
                     all.dump(1)));
  return models;
}

}  // namespace

Result<std::shared_ptr<const TemporaryFile>> make_deposit(const Services& services,
                                                          const DepositRequest& request,
                                                          const fs::path& folder,
                                                          Progress& progress) {
  const std::string unique = to_string(random_uuid());
  const store::ScratchFolder scratch(folder / (unique + ".deposit"));
  std::error_code error;
  fs::create_directories(scratch.folder(), error);
  if (error)
    return fail(ErrorCode::storage_full, "File not written",
                "The server cannot write to the folder for uploads: " + error.message() + ".");
  Bag bag(scratch.folder(),
          [&store = services.store](const std::string& sha256, std::uint64_t begin,
                                    std::uint64_t end, const auto& sink) {
            return store.attachments().read(sha256, begin, end, sink);
          });
  const auto models = STRATA_TRY(add_parts(bag, {services, request.reader, progress}, request));
  progress.begin_stage(kRead, kDescribed);
  progress.report(0, "Describing the files");
  STRATA_TRY(add_ro_crate(bag, request.project, models, request.record));
  progress.begin_stage(kDescribed, 1);
  auto file = std::make_shared<TemporaryFile>(folder / (unique + ".zip"));
  file->name = request.project.slug + ".zip";
  file->media_type = "application/zip";
  const std::string publisher =
      request.record.publisher ? request.record.publisher->name : std::string();
  file->bytes = STRATA_TRY(
      bag.write(request.project.slug,
                {{"Source-Organization", publisher},
                 {"External-Description", request.project.description},
                 {"External-Identifier",
                  request.record.doi ? "https://doi.org/" + *request.record.doi : std::string()},
                 {"Internal-Sender-Identifier", request.project.slug},
                 {"Bag-Software-Agent", "Strata " + std::string(version())}},
                file->path, progress));
  return file;
}

}  // namespace strata::app
