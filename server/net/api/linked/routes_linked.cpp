// The entities of the site as linked data, under addresses that stay the same.
#include <algorithm>

#include "app/records/painted_keys.h"
#include "app/records/record_csv.h"
#include "core/no_such.h"
#include "core/text/number_text.h"
#include "core/text/timestamp.h"
#include "domain/layers/layer.h"
#include "domain/tables/label_text.h"
#include "domain/tables/surface_feature.h"
#include "net/api/addressed.h"
#include "net/api/linked/iiif_manifest.h"
#include "net/api/linked/linked_catalog.h"
#include "net/api/linked/linked_entities.h"
#include "net/api/linked/linked_response.h"
#include "net/api/linked/linked_terms.h"
#include "net/api/route_help.h"
#include "net/api/routes.h"
#include "net/auth/project_authorization.h"
#include "net/http/entity_tags.h"
#include "net/serialization/people_serialization.h"
#include "net/serialization/record_place.h"
#include "net/serialization/view_serialization.h"
#include "room/room.h"
#include "store/content/layers.h"
#include "store/content/models.h"
#include "store/content/named_parts.h"
#include "store/content/objects.h"
#include "store/content/projects.h"
#include "store/store.h"
#include "store/tables/attachments.h"
#include "store/tables/records.h"
#include "store/tables/tables.h"

namespace strata::net {
namespace {

constexpr std::int64_t kListedRecords = 10'000;
constexpr int kListedViews = 1000;

Result<Response> catalog(const RouteContext& context, const Request& request) {
  auto models = STRATA_TRY(context.store.models().all());
  std::erase_if(models,
                [&](const Model& model) { return !request.principal->sees(model.project_id); });
  std::vector<Table> tables;
  const auto projects = STRATA_TRY(context.store.projects().all());
  for (const Project& project : projects) {
    if (!request.principal->sees(project.id)) continue;
    auto of_project = STRATA_TRY(
        context.store.tables().of_project(project.id, request.principal->roles.in(project.id)));
    std::ranges::move(of_project, std::back_inserter(tables));
  }
  const LinkedAddresses addresses(context, request);
  return linked_response(context, request, linked_catalog(addresses, models, tables),
                         catalog_terms(), addresses.site() + "/");
}

bool may_get_source(const Request& request, const Model& model) {
  return check_source_download(request, model).has_value();
}

Result<Response> get_model(const RouteContext& context, const Request& request) {
  const auto model = STRATA_TRY(stored_model(context, request));
  const auto layers = STRATA_TRY(context.store.layers().of_model(model.id, request.role()));
  const LinkedAddresses addresses(context, request);
  return linked_response(context, request,
                         linked_model(addresses, model, layers, may_get_source(request, model)),
                         linked_art(), addresses.page(model));
}

Result<Response> get_object(const RouteContext& context, const Request& request) {
  const auto project = STRATA_TRY(stored_project(context, request));
  const auto id = STRATA_TRY(id_of<ObjectId>(request, "object"));
  const auto object = STRATA_TRY(context.store.objects().find(project.id, id));
  std::vector<Model> models;
  for (const Survey& survey : object.surveys) {
    auto model = context.store.models().find(to_string(survey.model));
    if (model) models.push_back(std::move(*model));  // otherwise, deleted in the meantime
  }
  return linked_response(context, request,
                         linked_object(LinkedAddresses(context, request), object, models),
                         linked_art());
}

Result<Response> get_layer(const RouteContext& context, const Request& request) {
  const auto model = STRATA_TRY(stored_model(context, request));
  const auto layer = STRATA_TRY(stored_layer(context, request));
  const LinkedAddresses addresses(context, request);
  return linked_response(context, request, linked_layer(addresses, model, layer), linked_art(),
                         addresses.page(model));
}

// --- tables

Result<Response> get_table(const RouteContext& context, const Request& request) {
  const auto table = STRATA_TRY(stored_table(context, request));
  const LinkedAddresses addresses(context, request);
  store::RecordQuery query;
  query.limit = term_columns(table) ? store::kMaxRecords : kListedRecords;
  std::int64_t number = 0;
  if (const auto asked = request.query.find("page"); asked != request.query.end())
    number = STRATA_TRY(parse_integer(asked->second, 0, 1'000'000, "page"));
  if (!term_columns(table)) query.offset = number * kListedRecords;
  const auto page = STRATA_TRY(context.store.records().page(table.id, request.role(), query));
  if (const auto columns = term_columns(page.table))
    return linked_response(context, request,
                           linked_terms(addresses, page.table, list_terms(*columns, page.records)),
                           catalog_terms());
  std::vector<std::int64_t> keys;
  for (const Record& record : page.records) keys.push_back(record.key);
  nlohmann::json json = linked_table(addresses, page.table, keys);
  const std::string first = addresses.table(table.id);
  if (query.offset + kListedRecords < page.total)
    json["next"] = first + "?page=" + std::to_string(number + 1);
  if (number > 0)
    json["previous"] = number == 1 ? first : first + "?page=" + std::to_string(number - 1);
  return linked_response(context, request, std::move(json), catalog_terms());
}

Result<Response> concept_of(const RouteContext& context, const Request& request, const Table& table,
                            std::int64_t key) {
  store::RecordQuery query;
  query.limit = store::kMaxRecords;
  const auto page = STRATA_TRY(context.store.records().page(table.id, request.role(), query));
  if (const auto columns = term_columns(page.table))
    for (const ListedTerm& listed : list_terms(*columns, page.records))
      if (listed.key == key)
        return linked_response(context, request,
                               linked_term(LinkedAddresses(context, request), page.table, listed),
                               catalog_terms());
  return no_such("record", std::to_string(key));
}

// The terms of a record, with their addresses in other vocabularies.
Result<std::vector<RecordTerm>> terms_of(const RouteContext& context, const Request& request,
                                         const Table& table, const Record& record) {
  const auto language = STRATA_TRY(requested_language(request));
  std::vector<RecordTerm> terms;
  for (const Column& column : table.columns) {
    const auto value = record.values.find(column.id);
    if (column.kind != ColumnKind::term || !column.target || value == record.values.end() ||
        value->second.is_null())
      continue;
    const auto key = value->second.get<std::int64_t>();
    store::RecordQuery query;
    query.keys = std::vector{key};
    const auto page =
        STRATA_TRY(context.store.records().page(*column.target, request.role(), query));
    if (page.records.empty()) continue;
    RecordTerm term{&column, key, record_name(page.records.front(), page.table), {}};
    if (const auto columns = term_columns(page.table))
      for (const ListedTerm& listed : list_terms(*columns, page.records)) {
        term.label = label_in(listed.term, language);
        term.uri = listed.term.uri;
      }
    terms.push_back(std::move(term));
  }
  return terms;
}

std::string wkt_of(const SurfaceFeature& feature, bool is_line) {
  // "3 LINESTRING Z (…)": the model precedes the geometry.
  const std::string text = print_features({&feature, 1}, is_line);
  return text.substr(text.find(' ') + 1);
}

Result<std::vector<RecordSite>> sites_of(const RouteContext& context, const Request& request,
                                         const Table& table, const Record& record) {
  const LinkedAddresses addresses(context, request);
  std::vector<RecordSite> sites;
  const auto layers = STRATA_TRY(app::painted_layers(context, table.id, request.role()));
  for (const app::PaintedLayer& painted : layers) {
    const auto area = painted.areas.find(record.key);
    if (area == painted.areas.end()) continue;
    const Model model = painted.room->model();
    sites.push_back({model, painted.layer.name + " on " + model.name,
                     addresses.annotations(painted.layer) + "/areas." + std::to_string(record.key),
                     area->second.area_m2});
  }
  for (const Column& column : table.columns) {
    if (!holds_features(column.kind)) continue;
    for (const SurfaceFeature& feature : features_of(record, column)) {
      auto model = context.store.models().find(to_string(feature.model));
      if (!model) continue;  // deleted
      std::string label = column.name + " on " + model->name;
      sites.push_back({std::move(*model),
                       std::move(label),
                       {},
                       {},
                       wkt_of(feature, column.kind == ColumnKind::line)});
    }
  }
  return sites;
}

Result<std::vector<Attachment>> files_of(const RouteContext& context, const Request& request,
                                         const Table& table, const Record& record) {
  std::vector<Attachment> files;
  for (const Column& column : table.columns) {
    const auto value = record.values.find(column.id);
    if (!holds_attachments(column.kind) || value == record.values.end()) continue;
    for (const nlohmann::json& id : value->second) {
      auto file = context.store.attachments().find(id.get<AttachmentId>(), request.author());
      if (file) files.push_back(std::move(*file));  // otherwise, not visible to the caller
    }
  }
  return files;
}

Result<Response> get_record(const RouteContext& context, const Request& request) {
  const auto table = STRATA_TRY(stored_table(context, request));
  const auto key = STRATA_TRY(record_key(request));
  if (term_columns(table)) return concept_of(context, request, table, key);
  Table then;
  const auto record =
      STRATA_TRY(stored_record(context, table, request.role(), key, std::nullopt, &then));
  LinkedRecord linked{then, record, record_name(record, then), {}, {}, {}};
  linked.terms = STRATA_TRY(terms_of(context, request, then, record));
  linked.sites = STRATA_TRY(sites_of(context, request, then, record));
  linked.files = STRATA_TRY(files_of(context, request, then, record));
  const auto history =
      STRATA_TRY(context.store.tables().history(then.id, request.role(), key, 1, 0));
  if (!history.rows.empty()) {
    const std::string user = visible_name(request, history.rows.front().user);
    if (!user.empty()) linked.author = written_name(context.store, user);
    linked.time = utc_text(history.rows.front().time);
  }
  return linked_response(context, request, linked_record(LinkedAddresses(context, request), linked),
                         linked_art());
}

// --- the manifest

Result<Response> get_manifest(const RouteContext& context, const Request& request) {
  const auto room = STRATA_TRY(open_room(context, request));
  const Model model = room->model();
  const auto found =
      STRATA_TRY(context.store.views().of_model(model.id, kListedViews, 0, 0, request.user()));
  std::vector<ManifestView> views;
  for (const store::NamedPart& part : found.parts) {
    auto view = STRATA_TRY(as_view_create(context, request, part, *room));
    views.push_back({part.slug, part.name, part.text, view.camera});
  }
  const auto layers = STRATA_TRY(context.store.layers().of_model(model.id, request.role()));
  Response response = text_response(
      iiif_manifest(LinkedAddresses(context, request), model, views, layers,
                    may_get_source(request, model))
          .dump(-1, ' ', false, nlohmann::json::error_handler_t::replace),
      "application/ld+json; profile=\"http://iiif.io/api/presentation/4/context.json\"");
  return response;
}

}  // namespace

void add_linked_routes(Router& router, const RouteContext& context) {
  using Answer = Result<Response> (*)(const RouteContext&, const Request&);
  const auto add = [&](const std::string& pattern, Answer answer, bool is_question = false,
                       std::vector<std::string> query = {"f"}, Role least = Role::viewer) {
    router.add({.method = Method::get,
                .pattern = pattern,
                .handler = answering([&context, answer](const Request& request) {
                  return answer(context, request);
                }),
                .role = least,
                .query = std::move(query),
                .is_question = is_question});
  };
  // A guest may be a member of some projects, and sees only their entities.
  add("/id", catalog, false, {"f"}, Role::guest);
  add("/id/models/{model}", get_model);
  add("/id/models/{model}/layers/{layer}", get_layer);
  add("/id/models/{model}/manifest", get_manifest, false, {});
  add("/id/projects/{project}/objects/{object}", get_object);
  add("/id/tables/{table}", get_table, false, {"f", "page"});
  add("/id/tables/{table}/records/{key}", get_record, true, {"f", "lang"});
}

}  // namespace strata::net
