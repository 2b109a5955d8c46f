#include "net/serialization/tour_serialization.h"

#include <algorithm>
#include <set>

#include "core/text/timestamp.h"
#include "domain/layers/layer.h"
#include "domain/tables/table.h"
#include "net/serialization/at_field.h"
#include "net/serialization/table_serialization.h"
#include "store/content/layers.h"
#include "store/store.h"
#include "store/tables/records.h"
#include "store/tables/tables.h"

namespace strata::net {
namespace {

std::string at(const std::string& list, std::size_t place) {
  return list + "[" + std::to_string(place) + "]";
}

template <class Id>
Result<void> once(std::set<Id>& known, Id id, const char* what, const std::string& field) {
  if (known.insert(id).second) return {};
  return fail(ErrorCode::invalid, "Duplicate entry",
              "This " + std::string(what) + " appears twice. Send it once.", field);
}

Result<nlohmann::json> stored_columns(const Table& table,
                                      const std::vector<protocol::TourColumn>& columns,
                                      const std::string& field) {
  nlohmann::json stored = nlohmann::json::array();
  std::set<ColumnId> known;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const std::string here = at(field, i) + ".column";
    const Column* column = find_column(table.columns, columns[i].column);
    if (!column)
      return fail(ErrorCode::invalid, "Column not found",
                  table.name + " has no column `" + columns[i].column + "`.", here);
    STRATA_TRY(once(known, column->id, "column", here));
    stored.push_back({{"column", column->id}});
    if (columns[i].labels) stored.back()["labels"] = *columns[i].labels;
  }
  return stored;
}

Result<nlohmann::json> stored_records(const RouteContext& context, const Model& model, Role role,
                                      const std::vector<protocol::TourRecords>& all,
                                      const std::string& field) {
  nlohmann::json stored = nlohmann::json::array();
  std::set<TableId> known;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const protocol::TourRecords& requested = all[i];
    const std::string here = at(field, i);
    auto table = context.store.tables().find(requested.table, role);
    if (!table && table.error().code != ErrorCode::not_found) return tl::unexpected(table.error());
    if (!table || table->project_id != model.project_id)
      return fail(ErrorCode::invalid, "Table not found",
                  "The model's project has no table `" + requested.table + "`.", here + ".table");
    STRATA_TRY(once(known, table->id, "table", here + ".table"));
    const auto missing = context.store.records().missing(table->id, requested.keys);
    if (!missing) return tl::unexpected(missing.error());
    for (std::size_t k = 0; k < requested.keys.size(); ++k)
      if (std::ranges::find(*missing, requested.keys[k]) != missing->end())
        return fail(ErrorCode::invalid, "Record not found",
                    table->name + " has no record " + std::to_string(requested.keys[k]) + ".",
                    at(here + ".keys", k));
    auto columns = STRATA_TRY(stored_columns(*table, requested.columns, here + ".columns"));
    stored.push_back(
        {{"table", table->id}, {"keys", requested.keys}, {"columns", std::move(columns)}});
  }
  return stored;
}

Result<nlohmann::json> stored_layers(const RouteContext& context, const Model& model, Role role,
                                     const std::vector<std::string>& refs,
                                     const std::string& field) {
  nlohmann::json stored = nlohmann::json::array();
  std::set<LayerId> known;
  for (std::size_t i = 0; i < refs.size(); ++i) {
    const auto layer = context.store.layers().find(model.id, refs[i], role);
    if (!layer) return at_field(layer.error(), at(field, i));
    STRATA_TRY(once(known, layer->id, "layer", at(field, i)));
    stored.push_back(layer->id);
  }
  return stored;
}

Result<nlohmann::json> stored_names(const std::vector<protocol::TourClassName>& classes,
                                    const std::string& field) {
  nlohmann::json stored = nlohmann::json::array();
  std::set<double> known;
  for (std::size_t i = 0; i < classes.size(); ++i) {
    if (!known.insert(classes[i].value).second)
      return fail(ErrorCode::invalid, "Duplicate entry", "This class appears twice. Send it once.",
                  at(field, i) + ".value");
    stored.push_back(protocol::to_json(classes[i]));
  }
  return stored;
}

// Checks that `words`, which are keyed by language, use only languages of the tour.
Result<void> check_words(const nlohmann::json& words, const nlohmann::json& languages,
                         const std::string& field) {
  for (const auto& [language, text] : words.items())
    if (std::ranges::find(languages, nlohmann::json(language)) == languages.end())
      return fail(ErrorCode::invalid, "Language not in tour",
                  "`" + language +
                      "` is not a language of the tour. Add the language to the tour, or leave "
                      "these texts out.",
                  field + "." + language);
  return {};
}

Result<void> check_stop(const nlohmann::json& stop, const nlohmann::json& languages,
                        const std::string& field) {
  const auto first = languages.front().get<std::string>();
  if (!stop.at("title").contains(first))
    return fail(ErrorCode::invalid, "Title missing",
                "Each stop needs a title in the first language of the tour, `" + first + "`.",
                field + ".title");
  for (const char* member : {"title", "text"})
    STRATA_TRY(check_words(stop.at(member), languages, field + "." + member));
  if (const auto media = stop.find("media"); media != stop.end())
    for (std::size_t i = 0; i < media->size(); ++i)
      for (const char* member : {"alt", "caption", "subtitles"})
        STRATA_TRY(check_words((*media)[i].value(member, nlohmann::json::object()), languages,
                               at(field + ".media", i) + "." + member));
  for (std::size_t i = 0; i < stop.at("records").size(); ++i) {
    const auto& columns = stop.at("records")[i].at("columns");
    for (std::size_t k = 0; k < columns.size(); ++k)
      if (auto good = check_words(columns[k].value("labels", nlohmann::json::object()), languages,
                                  at(at(field + ".records", i) + ".columns", k) + ".labels");
          !good)
        return good;
  }
  return {};
}

Result<void> check_class_names(const nlohmann::json& all, const nlohmann::json& languages) {
  for (std::size_t i = 0; i < all.size(); ++i) {
    const auto& classes = all[i].at("classes");
    for (std::size_t k = 0; k < classes.size(); ++k)
      STRATA_TRY(check_words(classes[k].at("names"), languages,
                             at(at("classes", i) + ".classes", k) + ".names"));
  }
  return {};
}

// Reads each entity only once, even if the tours name it several times.
class Seen {
 public:
  static Result<Seen> of(const RouteContext& context, ModelId model_id, Role role) {
    auto views = STRATA_TRY(context.store.views().slugs(model_id));
    auto layers = STRATA_TRY(context.store.layers().of_model(model_id, role));
    Seen seen(context, role);
    seen.views_ = std::move(views);
    for (const Layer& layer : layers) seen.layers_[layer.id] = layer.slug;
    return seen;
  }

  // Leaves out layers that are deleted or invisible to the role.
  nlohmann::json classes(const nlohmann::json& stored) const {
    nlohmann::json shown = nlohmann::json::array();
    for (const nlohmann::json& each : stored)
      if (const auto layer = layers_.find(each.at("layer").get<LayerId>()); layer != layers_.end())
        shown.push_back({{"layer", layer->second}, {"classes", each.at("classes")}});
    return shown;
  }

  Result<nlohmann::json> stop(const nlohmann::json& stored) {
    nlohmann::json shown = stored;
    shown["layers"] = nlohmann::json::array();
    shown["records"] = nlohmann::json::array();
    if (const auto view = views_.find(stored.at("view").get<NamedPartId>()); view != views_.end())
      shown["view"] = view->second;
    else
      shown.erase("view");
    for (const nlohmann::json& id : stored.at("layers"))
      if (const auto layer = layers_.find(id.get<LayerId>()); layer != layers_.end())
        shown["layers"].push_back(layer->second);
    for (const nlohmann::json& each : stored.at("records")) {
      auto table = STRATA_TRY(find_table(each.at("table").get<TableId>()));
      if (table) shown["records"].push_back(records(each, *table));
    }
    return shown;
  }

 private:
  Seen(const RouteContext& context, Role role) : context_(&context), role_(role) {}

  static nlohmann::json records(const nlohmann::json& stored, const Table& table) {
    nlohmann::json shown{
        {"table", table.slug}, {"keys", stored.at("keys")}, {"columns", nlohmann::json::array()}};
    for (const nlohmann::json& each : stored.at("columns")) {
      const auto id = each.at("column").get<ColumnId>();
      const auto column = std::ranges::find(table.columns, id, &Column::id);
      if (column == table.columns.end()) continue;
      shown["columns"].push_back(each);
      shown["columns"].back()["column"] = column->slug;
    }
    return shown;
  }

  // Returns nothing if the table is deleted.
  Result<std::optional<Table>> find_table(TableId id) {
    const auto known = tables_.find(id);
    if (known != tables_.end()) return known->second;
    auto table = context_->store.tables().find(to_string(id), role_);
    if (!table && table.error().code != ErrorCode::not_found) return tl::unexpected(table.error());
    return tables_[id] = table ? std::optional(std::move(*table)) : std::nullopt;
  }

  const RouteContext* context_;
  Role role_;
  std::map<NamedPartId, std::string> views_;  // slug by id
  std::map<LayerId, std::string> layers_;     // slug by id
  std::map<TableId, std::optional<Table>> tables_;
};

}  // namespace

Result<nlohmann::json> stored_stops(const RouteContext& context, const Model& model, Role role,
                                    const std::vector<protocol::TourStopCreate>& stops,
                                    const TourFilesById& files) {
  nlohmann::json all = nlohmann::json::array();
  for (std::size_t i = 0; i < stops.size(); ++i) {
    const protocol::TourStopCreate& stop = stops[i];
    const std::string here = at("stops", i);
    const auto view = context.store.views().find(model.id, stop.view);
    if (!view) return at_field(view.error(), here + ".view");
    auto layers = STRATA_TRY(stored_layers(
        context, model, role, stop.layers.value_or(std::vector<std::string>{}), here + ".layers"));
    auto records = STRATA_TRY(stored_records(
        context, model, role, stop.records.value_or(std::vector<protocol::TourRecords>{}),
        here + ".records"));
    const auto media = stop.media.value_or(std::vector<protocol::TourMedium>{});
    STRATA_TRY(check_media(media, files, here + ".media"));
    all.push_back(
        {{"view", view->id},
         {"title", stop.title},
         {"text", stop.text.value_or(protocol::TourText{})},
         {"attract_s", stop.attract_s},
         {"transition", protocol::name(stop.transition.value_or(protocol::TourTransition::move))},
         {"transition_s", stop.transition_s},
         {"layers", std::move(layers)},
         {"records", std::move(records)}});
    if (media.empty()) continue;
    for (const protocol::TourMedium& medium : media)
      all.back()["media"].push_back(protocol::to_json(medium));
  }
  return all;
}

Result<nlohmann::json> stored_classes(const RouteContext& context, const Model& model, Role role,
                                      const std::vector<protocol::TourClasses>& all) {
  nlohmann::json stored = nlohmann::json::array();
  std::set<LayerId> known;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const std::string here = at("classes", i);
    const auto layer = context.store.layers().find(model.id, all[i].layer, role);
    if (!layer) return at_field(layer.error(), here + ".layer");
    STRATA_TRY(once(known, layer->id, "layer", here + ".layer"));
    auto names = STRATA_TRY(stored_names(all[i].classes, here + ".classes"));
    stored.push_back({{"layer", layer->id}, {"classes", std::move(names)}});
  }
  return stored;
}

Result<void> check_languages(const nlohmann::json& content, bool stops_are_new) {
  const nlohmann::json& languages = content.at("languages");
  for (std::size_t i = 0; i < languages.size(); ++i)
    if (std::find(languages.begin(), languages.begin() + static_cast<std::ptrdiff_t>(i),
                  languages[i]) != languages.begin() + static_cast<std::ptrdiff_t>(i))
      return fail(ErrorCode::invalid, "Duplicate entry",
                  "This language appears twice. Send it once.", at("languages", i));
  const nlohmann::json& stops = content.at("stops");
  for (std::size_t i = 0; i < stops.size(); ++i)
    if (auto good = check_stop(stops[i], languages, at("stops", i)); !good) {
      if (stops_are_new) return good;
      return fail(ErrorCode::invalid, "Languages do not match",
                  "Stop " + std::to_string(i + 1) +
                      " does not match these languages: " + good.error().detail,
                  "languages");
    }
  if (const auto classes = content.find("classes"); classes != content.end())
    STRATA_TRY(check_class_names(*classes, languages));
  return {};
}

nlohmann::json tour_entry(const store::NamedPart& tour, const std::string& user) {
  return {{"id", tour.id},
          {"slug", tour.slug},
          {"name", tour.name},
          {"text", tour.text},
          {"languages", tour.content.at("languages")},
          {"stop_count", tour.content.at("stops").size()},
          {"user", user},
          {"time", utc_text(tour.time)},
          {"version", tour.version}};
}

Result<nlohmann::json> to_json(const RouteContext& context, const store::NamedPart& tour, Role role,
                               const std::string& user) {
  auto seen = STRATA_TRY(Seen::of(context, tour.model_id, role));
  nlohmann::json json = tour_entry(tour, user);
  json.erase("stop_count");
  json["idle_s"] = tour.content.at("idle_s");
  json["stops"] = nlohmann::json::array();
  for (const nlohmann::json& stored : tour.content.at("stops")) {
    auto stop = STRATA_TRY(seen.stop(stored));
    json["stops"].push_back(std::move(stop));
  }
  if (const auto theme = tour.content.find("theme"); theme != tour.content.end())
    json["theme"] = *theme;
  if (const auto classes = tour.content.find("classes"); classes != tour.content.end())
    json["classes"] = seen.classes(*classes);
  const auto used = files_in(tour.content);
  if (used.empty()) return json;
  json["files"] = nlohmann::json::array();
  const auto files = STRATA_TRY(context.store.tour_files().of_tour(tour.id));
  for (const store::TourFile& file : files)
    if (used.contains(file.id)) json["files"].push_back(to_json(file));
  return json;
}

}  // namespace strata::net
