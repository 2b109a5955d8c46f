#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>

#include "app/deposit/crate_json.h"
#include "app/deposit/import_parts.h"
#include "media/media_type.h"
#include "protocol/parse.h"
#include "store/content/comments.h"
#include "store/content/named_parts.h"
#include "store/content/tour_files.h"
#include "store/store.h"

namespace strata::app {
namespace {

using nlohmann::json;

// Replaces the id at a place of the JSON. Returns false if the new project does not have the part.
template <class Id>
bool replace_id(json& id, const std::map<Id, Id>& ids) {
  const auto found = ids.find(id.get<Id>());
  if (found == ids.end()) return false;
  id = found->second;
  return true;
}

// Replaces the ids in the elements of a list, and removes the elements whose part is missing.
template <class Id>
void replace_ids(json& all, const char* list, const char* member, const std::map<Id, Id>& ids) {
  const auto found = all.find(list);
  if (found == all.end()) return;
  json kept = json::array();
  for (json& each : *found)
    if (replace_id(member ? each.at(member) : each, ids)) kept.push_back(std::move(each));
  *found = std::move(kept);
}

class PartImport {
 public:
  PartImport(const Import& import, const json& all)
      : import_(import), store_(import.store), ids_(import.ids), all_(all) {
    model_ = ids_.models.at(all.at("model").at("id").get<ModelId>());
  }

  Result<void> run() {
    STRATA_TRY(add_views());
    STRATA_TRY(add_tours());
    STRATA_TRY(add_comments());
    const auto name = all_.at("model").at("name").get<std::string>();
    for (const auto& [list, words] :
         {std::pair("snapshots", "saved states of "), std::pair("selections", "selections of ")})
      if (const auto count = all_.at(list).size(); count > 0)
        import_.made.left_out.push_back(std::to_string(count) + " " + words + name);
    return {};
  }

 private:
  store::NamedPart part_of(const json& all) const {
    store::NamedPart part = crate::named_part_of(all);
    part.id = {};
    part.model_id = model_;
    return part;
  }

  // A view that the server itself would not accept would break the lists of views.
  static Result<void> check_view(const store::NamedPart& view) {
    json body{{"name", view.name}, {"camera", view.content.at("camera")}};
    if (const auto light = view.content.find("light"); light != view.content.end())
      body["light"] = *light;
    STRATA_TRY(protocol::from_json<protocol::ViewCreate>(body));
    return {};
  }

  Result<void> add_views() {
    for (const json& each : all_.at("views")) {
      store::NamedPart view = part_of(each);
      STRATA_TRY(check_view(view));
      replace_ids(view.content, "layers", "layer", ids_.layers);
      replace_ids(view.content, "looks", "look", ids_.images);
      const auto made = STRATA_TRY(store_.views().create(view));
      ids_.views[each.at("id").get<NamedPartId>()] = made.id;
    }
    return {};
  }

  // The files of a tour refer to the tour, and the tour to its files.
  Result<void> add_tours() {
    for (const json& each : all_.at("tours")) {
      store::NamedPart tour = part_of(each);
      const json stops = tour.content.at("stops");
      const json theme = tour.content.value("theme", json());
      tour.content["stops"] = json::array();
      tour.content.erase("theme");
      replace_ids(tour.content, "classes", "layer", ids_.layers);
      auto made = STRATA_TRY(store_.tours().create(tour));
      std::map<store::TourFileId, store::TourFileId> files;
      for (const json& file : each.at("files"))
        files[file.at("id").get<store::TourFileId>()] =
            STRATA_TRY(add_tour_file(made.id, file, each.at("user").get<std::string>()));
      for (json stop : stops) {
        if (!replace_id(stop.at("view"), ids_.views)) continue;
        replace_stop(stop, files);
        made.content["stops"].push_back(std::move(stop));
      }
      if (!theme.is_null()) made.content["theme"] = with_logo(theme, files);
      STRATA_TRY(store_.tours().update(made));
    }
    return {};
  }

  using TourFiles = std::map<store::TourFileId, store::TourFileId>;

  void replace_stop(json& stop, const TourFiles& files) const {
    replace_ids(stop, "layers", nullptr, ids_.layers);
    replace_ids(stop, "records", "table", ids_.tables);
    for (json& records : stop.at("records"))
      replace_ids(records, "columns", "column", ids_.columns);
    replace_ids(stop, "media", "file", files);
    if (const auto media = stop.find("media"); media != stop.end())
      for (json& medium : *media)
        if (const auto subtitles = medium.find("subtitles"); subtitles != medium.end()) {
          json kept = json::object();
          for (auto& [language, id] : subtitles->items())
            if (replace_id(id, files)) kept[language] = id;
          *subtitles = std::move(kept);
        }
  }

  static json with_logo(json theme, const TourFiles& files) {
    if (const auto logo = theme.find("logo"); logo != theme.end() && !replace_id(*logo, files))
      theme.erase(logo);
    return theme;
  }

  Result<store::TourFileId> add_tour_file(NamedPartId tour, const json& stored,
                                          const std::string& user) {
    const auto path = stored.at("file").get<std::string>();
    const auto mapped = STRATA_TRY(import_.open(path));
    store::NewTourFile file;
    file.name = stored.at("name").get<std::string>();
    file.file = STRATA_TRY(import_.place_of(path));
    const FileFacts facts = facts_of(mapped, file.name);
    // The sniffed type is less specific for these two.
    const auto stated = stored.at("media_type").get<std::string>();
    const bool is_specific = (stated == "audio/ogg" && facts.media_type == "application/ogg") ||
                             (stated == "text/vtt" && facts.media_type == "text/plain");
    file.media_type = is_specific ? stated : facts.media_type;
    file.width = facts.width;
    file.height = facts.height;
    const auto made = STRATA_TRY(store_.tour_files().add(tour, file, user));
    ++import_.made.files;
    return made.id;
  }

  Result<void> add_comments() {
    std::map<CommentId, CommentId> threads;
    for (const json& each : all_.at("comments")) {
      store::Comment comment = crate::comment_of(each);
      const CommentId before = comment.id;
      comment.id = {};
      comment.model_id = model_;
      // A deleted comment has no text, and is only kept for its replies.
      if (comment.deleted) comment.text = "(deleted)";
      if (comment.thread) {
        const auto thread = threads.find(*comment.thread);
        if (thread == threads.end()) continue;
        comment.thread = thread->second;
      }
      if (comment.layer_id) comment.layer_id = mapped(ids_.layers, *comment.layer_id);
      if (comment.table_id) comment.table_id = mapped(ids_.tables, *comment.table_id);
      if (!comment.table_id) comment.record.reset();
      const auto resolved = comment.resolved;
      comment.resolved.reset();
      auto made = STRATA_TRY(store_.comments().create(comment));
      if (!comment.thread) threads[before] = made.id;
      if (!resolved) continue;
      made.resolved = resolved;
      STRATA_TRY(store_.comments().update(made));
    }
    return {};
  }

  template <class Id>
  static std::optional<Id> mapped(const std::map<Id, Id>& ids, Id before) {
    const auto found = ids.find(before);
    return found == ids.end() ? std::nullopt : std::optional(found->second);
  }

  const Import& import_;
  store::Store& store_;
  ImportIds& ids_;
  const json& all_;
  ModelId model_;
};

}  // namespace

Result<void> import_model_parts(const Import& import, const json& all) {
  return PartImport(import, all).run();
}

}  // namespace strata::app
