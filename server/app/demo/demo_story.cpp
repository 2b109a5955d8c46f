#include "app/demo/demo_story.h"

#include <stdlib.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <functional>
#include <future>
#include <glm/gtc/matrix_transform.hpp>
#include <map>
#include <optional>
#include <utility>

#include "app/demo/story_brush.h"
#include "app/demo/story_photo.h"
#include "app/demo/story_places.h"
#include "core/temporary_file.h"
#include "core/text/timestamp.h"
#include "core/uuid.h"
#include "domain/people/role.h"
#include "domain/scene/camera.h"
#include "domain/scene/light.h"
#include "domain/tables/surface_feature.h"
#include "domain/tables/term_list.h"
#include "jobs/demo.h"
#include "mesh/surface/geometry.h"
#include "protocol/json_values.h"
#include "store/content/comments.h"
#include "store/content/layers.h"
#include "store/content/models.h"
#include "store/content/named_parts.h"
#include "store/content/projects.h"
#include "store/content/trash.h"
#include "store/journal/journal_reads.h"
#include "store/journal/journal_writer.h"
#include "store/nodes/nodes.h"
#include "store/people/accounts.h"
#include "store/people/kiosks.h"
#include "store/people/members.h"
#include "store/tables/attachments.h"
#include "store/tables/records.h"
#include "store/tables/tables.h"

namespace strata::app {
namespace {

using Time = std::chrono::system_clock::time_point;
using Place = StoryPlaces::Place;
using Stroke = StoryBrush::Stroke;
using namespace std::chrono_literals;

constexpr const char* kTemplate = "stone-condition";
// New names for the template's tables and layers, so users can also apply the template itself to
// the demo project.
struct Renamed {
  const char *from, *slug, *name, *german, *spanish;
};
constexpr Renamed kTables[] = {
    {"stone-condition-terms", "condition-terms", "Condition terms", "Begriffe zum Zustand",
     "Términos del estado"},
    {"stone-materials", "material-terms", "Material terms", "Begriffe zum Material",
     "Términos del material"},
    {"stone-measures", "measure-terms", "Measure terms", "Begriffe zu Maßnahmen",
     "Términos de medidas"},
    {"stone-observations", "observations", "Observations", "Beobachtungen", "Observaciones"}};
constexpr Renamed kLayers[] = {
    {"measure-terms", "measures", "Planned measures", "Geplante Maßnahmen", "Medidas previstas"},
    {"condition-terms", "condition", "Condition", "Zustand", "Estado"},
    {"observations", "observations", "Observations", "Beobachtungen", "Observaciones"}};

class Story {
 public:
  Story(store::Store& store, const TemplateRegistry& templates, Progress& progress)
      : store_(store),
        templates_(templates),
        progress_(progress),
        today_(std::chrono::floor<std::chrono::days>(std::chrono::system_clock::now())) {}

  Result<DemoStory> make(double detail) {
    begun_ = std::chrono::system_clock::now();
    progress_.begin_stage(0, 0.7);
    const Model pot = STRATA_TRY(jobs::make_demo_at(store_, progress_, detail, day(56) + 9h));
    const auto tables = STRATA_TRY(store_.tables().of_project(pot.project_id, Role::owner));
    if (std::ranges::any_of(tables, [](const Table& t) { return t.slug == kTables[0].slug; }))
      return DemoStory{pot, {}};
    model_ = pot;
    project_ = pot.project_id;
    progress_.begin_stage(0.7, 0.8);
    progress_.report(0, "Mapping the surface");
    const auto stored = STRATA_TRY(store_.models().geometry(pot.id));
    const auto geometry = STRATA_TRY(mesh::decode_geometry(stored));
    const auto map =
        STRATA_TRY(mesh::bake_surface_map(geometry, pot.default_resolution, progress_));
    const StoryPlaces places(geometry);
    places_ = &places;
    const StoryBrush brush(places, map);
    brush_ = &brush;
    store::JournalWriter writer(store_, {});
    writer_ = &writer;
    progress_.begin_stage(0.8, 1);
    progress_.report(0, "Adding the story of the demo");
    STRATA_TRY(at(day(56) + 9h));
    STRATA_TRY(make_people());
    STRATA_TRY(make_tables_and_layers());
    STRATA_TRY(at(day(49) + 10h));
    STRATA_TRY(map_condition());
    if (progress_.cancelled()) return cancelled_problem();
    progress_.report(0.5, "Adding the story of the demo");
    STRATA_TRY(observe());
    STRATA_TRY(discuss_and_clean());
    const std::string kiosk = STRATA_TRY(show());
    STRATA_TRY(suggest());
    auto model = STRATA_TRY(store_.models().find(to_string(pot.id)));
    progress_.report(1, "Done");
    return DemoStory{std::move(model), kiosk};
  }

 private:
  Time day(int before) const { return today_ - std::chrono::days(before); }

  // Backdates all changes since the last call. Their new time is this time of the story.
  Result<void> at(Time time) {
    begun_ = STRATA_TRY(store::JournalWriter::date_back(store_, project_, begun_, time));
    return {};
  }

  Result<void> make_people() {
    for (const auto& [name, full_name, role] :
         {std::tuple(kDemoConservator, "Lena Hoff", Role::annotator),
          std::tuple(kDemoCurator, "Marco Ruiz", Role::curator)}) {
      auto person = store_.accounts().find(name);
      if (!person && person.error().code != ErrorCode::not_found)
        return tl::unexpected(person.error());
      if (!person) STRATA_TRY(store_.accounts().create(name, full_name, Role::guest));
      STRATA_TRY(store_.members().put(project_, name, role));
    }
    return {};
  }

  Result<void> make_tables_and_layers() {
    const protocol::Template* of = templates_.find(kTemplate);
    if (!of)
      return fail(
          ErrorCode::not_found, "Template not found",
          "The demo needs the template `" + std::string(kTemplate) + "`, which is not installed.");
    auto fresh = STRATA_TRY(new_tables(*of, project_, {}));
    for (store::NewTable& made : fresh)
      for (const Renamed& renamed : kTables)
        if (made.table.slug == renamed.from) {
          made.table.slug = renamed.slug;
          made.table.name = renamed.name;
          made.table.labels = labels_of(renamed);
        }
    const auto changes =
        STRATA_TRY(store_.tables().create_several(fresh, false, kDemoCurator, "template"));
    for (const store::TableChange& change : changes) {
      if (!change.problems.empty()) return tl::unexpected(change.problems.front().problem);
      tables_[change.table.slug] = change.table;
      if (!term_columns(change.table)) continue;
      store::RecordQuery all;
      all.limit = 1000;
      const auto page = STRATA_TRY(store_.records().page(change.table.id, Role::owner, all));
      const auto columns = *term_columns(page.table);
      for (const ListedTerm& listed : list_terms(columns, page.records))
        keys_[listed.term.code] = listed.key;
    }
    int order = 2;  // above the layers of the pot
    for (const Renamed& renamed : kLayers) {
      Layer layer;
      layer.model_id = model_.id;
      layer.name = renamed.name;
      layer.slug = renamed.slug;
      layer.labels = labels_of(renamed);
      layer.kind = LayerKind::database;
      layer.type = ValueType::u16;
      layer.resolution = model_.default_resolution;
      layer.table = tables_.at(renamed.from).id;
      layer.order = order++;
      layer.visible = layer.slug != "measures";
      layer.review = layer.slug == "condition";
      layer.palette =
          layer.slug == "observations" ? default_palette(layer.type, true) : terms_palette({});
      store::IdempotentResponse<Layer> by_curator;
      by_curator.user = kDemoCurator;
      layers_[layer.slug] = STRATA_TRY(store_.layers().create(layer, by_curator));
    }
    // Hides these layers because they would cover the mapped condition.
    for (const char* slug : {"pieces", "cracks"}) {
      auto layer = STRATA_TRY(store_.layers().find(model_.id, slug, Role::owner));
      layer.visible = false;
      layers_[slug] = STRATA_TRY(store_.layers().update(layer));
    }
    return {};
  }

  static Labels labels_of(const Renamed& renamed) {
    return {{"en", renamed.name}, {"de", renamed.german}, {"es", renamed.spanish}};
  }

  Result<void> paint(Time time, const std::string& user, const std::string& layer_slug,
                     const std::string& code, const Stroke& stroke, Review review = Review::none) {
    const Layer& layer = layers_.at(layer_slug);
    const bool erases = code.empty();
    const auto value = erases ? std::nullopt
                              : std::optional(static_cast<std::uint32_t>(
                                    keys_.contains(code) ? keys_.at(code) : std::stoll(code)));
    store::JournalEntry entry =
        brush_->paint(layer, contents_[layer_slug], stroke, value, model_.metres());
    entry.model_id = model_.id;
    entry.layer_id = layer.id;
    // A room that was opened in the meantime must not write, because it lacks this entry.
    entry.epoch = STRATA_TRY(store_.nodes().begin_epoch(model_.id));
    entry.sequence = STRATA_TRY(store_.journal().last_sequence(model_.id)) + 1;
    entry.id = entry.stroke = random_uuid();
    entry.user = user;
    entry.op = "stroke";
    entry.record = {{"op", "stroke"}, {"by", "the story of the demo"}, {"erase", erases}};
    if (value) entry.record["value"] = *value;
    entry.answer["sequence"] = entry.sequence;
    entry.time = time;
    entry.review = review;
    std::promise<Result<void>> saved;
    if (!writer_->submit(std::move(entry),
                         [&saved](Result<void> result) { saved.set_value(std::move(result)); }))
      return fail(ErrorCode::unavailable, "Database unavailable",
                  "The database did not answer, so the server could not save the demo. Try again.");
    return saved.get_future().get();
  }

  Result<void> map_condition() {
    const auto lena = [&](Time time, const char* code, const Stroke& stroke) {
      return paint(time, kDemoConservator, "condition", code, stroke);
    };
    STRATA_TRY(lena(day(42) + 9h + 40min, "soiling", {{{-152, .30}, {-128, .27}, {-112, .31}}, 7}));
    STRATA_TRY(lena(day(42) + 10h + 5min, "soiling", {{{-66, .30}, {-48, .28}, {-28, .32}}, 7}));
    STRATA_TRY(lena(day(41) + 14h + 20min, "black-crust", {{{-124, .62}, {-113, .60}}, 4}));
    STRATA_TRY(lena(day(35) + 11h, "efflorescence", {{{-116, .07}, {-92, .06}, {-66, .08}}, 3.5}));
    STRATA_TRY(lena(day(34) + 9h + 15min, "flaking", {{{-58, .50}}, 4}));
    STRATA_TRY(lena(day(28) + 15h + 30min, "alga", {{{-168, .16}, {-154, .13}}, 5}));
    STRATA_TRY(lena(day(21) + 10h, "flaking", {{{-60, .52}, {-49, .47}, {-42, .50}}, 5}));
    STRATA_TRY(lena(day(21) + 10h + 25min, "missing-part", {{{-88, .55}, {-80, .56}}, 2.5}));
    return {};
  }

  nlohmann::json line_of(const std::vector<Place>& path) const {
    return to_json(std::vector<SurfaceFeature>{{model_.id, places_->line(path)}});
  }
  nlohmann::json point_of(const Place& place) const {
    return to_json(std::vector<SurfaceFeature>{{model_.id, {places_->place(place)}}});
  }

  // Writes a record. `values` contains a value for each column slug. Returns the record's key.
  Result<std::int64_t> write(const std::string& table_slug, const std::string& user,
                             const std::map<std::string, nlohmann::json>& values,
                             std::optional<std::int64_t> key = {}) {
    const Table& table = tables_.at(table_slug);
    store::WriteRecords request;
    store::RecordInput input;
    input.key = key;
    for (const auto& [slug, value] : values)
      input.values[find_column(table.columns, slug)->id] = value;
    request.records.push_back(std::move(input));
    const auto change = STRATA_TRY(store_.records().write(table.id, request, user));
    if (!change.problems.empty()) return tl::unexpected(change.problems.front().problem);
    return key ? *key : change.created.front();
  }

  Result<void> attach_photo(std::int64_t key, const std::string& name, int seed) {
    const std::vector<std::uint8_t> jpeg = story_photo(seed);
    std::string pattern = (std::filesystem::temp_directory_path() / "strata-demo-XXXXXX").string();
    const int descriptor = ::mkstemp(pattern.data());
    if (descriptor < 0)
      return fail(
          ErrorCode::internal, "Cannot create temporary file",
          "The server cannot write to " + std::filesystem::temp_directory_path().string() + ".");
    ::close(descriptor);
    const TemporaryFile file{pattern};
    std::ofstream(file.path, std::ios::binary)
        .write(reinterpret_cast<const char*>(jpeg.data()),
               static_cast<std::streamsize>(jpeg.size()));
    store::NewAttachment attachment;
    attachment.name = name;
    attachment.file = file.path;
    attachment.media_type = "image/jpeg";
    attachment.width = 640;
    attachment.height = 480;
    STRATA_TRY(store_.attachments().attach(tables_.at("observations").id, key, {}, {attachment}, {},
                                           Author(kDemoConservator, Role::annotator)));
    return {};
  }

  Result<void> observe() {
    const Time time = day(20) + 11h + 10min;
    const std::string date = utc_text(time).substr(0, 10);
    struct Observation {
      const char *term, *urgency, *note, *photo;
      Place place;
      double radius_mm;
      std::vector<Place> crack;
    };
    const Observation all[] = {{"flaking",
                                "within a year",
                                "Flakes lift at the edge of the spiral.",
                                "flaking_1.jpg",
                                {-52, .49},
                                2.5,
                                {}},
                               {"hair-crack",
                                "watch",
                                "Runs from the loss to the rope. Stable since the first survey?",
                                "crack_2.jpg",
                                {-84, .42},
                                1.5,
                                {{-88, .53}, {-85, .47}, {-86, .42}, {-81, .37}, {-82, .33}}},
                               {"efflorescence",
                                "none",
                                "White crystals. The test strip shows gypsum.",
                                "salt_3.jpg",
                                {-90, .065},
                                2,
                                {}}};
    int number = 0;
    for (const Observation& each : all) {
      ++number;
      std::map<std::string, nlohmann::json> values{{"term", keys_.at(each.term)},
                                                   {"observer", "Lena Hoff"},
                                                   {"date", date},
                                                   {"method", "magnifier"},
                                                   {"certainty", "certain"},
                                                   {"urgency", each.urgency},
                                                   {"note", each.note},
                                                   {"sample-number", "P" + std::to_string(number)},
                                                   {"samples", point_of(each.place)},
                                                   {"depth", 0.4 * number}};
      if (!each.crack.empty()) {
        values["cracks"] = line_of(each.crack);
        values["crack-width"] = 0.08;
      }
      const std::int64_t key = STRATA_TRY(write("observations", kDemoConservator, values));
      STRATA_TRY(attach_photo(key, each.photo, number));
      STRATA_TRY(paint(time + number * 6min, kDemoConservator, "observations", std::to_string(key),
                       {{each.place}, each.radius_mm}));
      observations_.push_back(key);
    }
    // Stores the lines of a crack in the record of the term.
    STRATA_TRY(write("condition-terms", kDemoConservator,
                     {{"lines", line_of({{-128, .50}, {-123, .44}, {-125, .38}, {-119, .33}})}},
                     keys_.at("hair-crack")));
    return at(time);
  }

  Result<store::Comment> comment(const std::string& user, const std::string& text,
                                 const Place& place, const char* layer,
                                 std::optional<CommentId> thread = {}) {
    store::Comment fresh;
    fresh.model_id = model_.id;
    fresh.user = user;
    fresh.text = text;
    fresh.thread = thread;
    if (!thread) {
      fresh.place = {places_->place(place), places_->outward(place)};
      fresh.layer_id = layers_.at(layer).id;
    }
    return store_.comments().create(fresh);
  }

  Result<void> discuss_and_clean() {
    STRATA_TRY(paint(day(16) + 9h + 30min, kDemoCurator, "measures", "dry-cleaning",
                     {{{-152, .30}, {-128, .27}, {-112, .31}}, 9}));
    STRATA_TRY(paint(day(16) + 9h + 45min, kDemoCurator, "measures", "consolidating",
                     {{{-60, .52}, {-49, .47}, {-42, .50}}, 6}));
    const auto active = STRATA_TRY(
        comment(kDemoCurator, "@lena.demo Is the flaking still active? It has grown since spring.",
                {-52, .49}, "condition"));
    const auto soiling = STRATA_TRY(
        comment(kDemoCurator, "Dry-clean the left side first.", {-132, .28}, "condition"));
    STRATA_TRY(at(day(14) + 16h));
    STRATA_TRY(comment(kDemoConservator,
                       "Yes: the edges are fresh. See observation P1. I propose to consolidate.",
                       {}, "", active.id));
    STRATA_TRY(at(day(13) + 8h + 50min));
    STRATA_TRY(paint(day(7) + 13h, kDemoConservator, "condition", "",
                     {{{-152, .30}, {-128, .27}, {-112, .31}}, 10.5}));
    STRATA_TRY(
        comment(kDemoConservator, "Done, with a soft brush and sponge.", {}, "", soiling.id));
    auto resolved = STRATA_TRY(store_.comments().comment(soiling.id, Role::owner));
    resolved.resolved = store::Comment::Resolution{kDemoCurator, {}};
    STRATA_TRY(store_.comments().update(resolved));
    return at(day(7) + 14h);
  }

  Result<store::NamedPart> view(const std::string& name, const std::string& text, double angle,
                                double height, double distance_mm, LightMode light,
                                const std::vector<const char*>& shown) {
    const glm::dvec3 target = places_->place({angle, .45}) * glm::dvec3(0, 0, 1) +
                              glm::dvec3(model_.origin.x, model_.origin.y, 0);
    Camera camera;
    camera.width = 1280;
    camera.height = 800;
    const glm::dvec3 eye = target + distance_mm * glm::normalize(places_->outward({angle, 0}) +
                                                                 glm::dvec3(0, 0, height));
    camera.view = glm::lookAt(eye, target, glm::dvec3(0, 0, 1));
    camera.projection = glm::perspective(glm::radians(30.0), 1.6, 20.0, 1000.0);
    nlohmann::json layers = nlohmann::json::array();
    for (const auto& [slug, layer] : layers_)
      layers.push_back({{"layer", layer.id},
                        {"visible", std::ranges::any_of(
                                        shown, [&](const char* each) { return slug == each; })}});
    Light how;
    how.mode = light;
    store::NamedPart part;
    part.model_id = model_.id;
    part.name = name;
    part.text = text;
    part.user = kDemoCurator;
    part.content = {{"camera", protocol::write_core(camera)},
                    {"layers", std::move(layers)},
                    {"light", protocol::write_core(how)}};
    store::IdempotentResponse<store::NamedPart> by_curator;
    by_curator.user = kDemoCurator;
    return store_.views().create(part, by_curator);
  }

  Result<std::string> show() {
    const auto condition =
        STRATA_TRY(view("Figure 1: condition of the front",
                        "Ready for a figure: choose Figure, then this view, and 1 : 1.", -88, .12,
                        255, LightMode::museum, {"condition", "observations"}));
    const auto raking =
        STRATA_TRY(view("Relief in raking light", "", -100, .2, 200, LightMode::raking, {}));
    const auto sherds = STRATA_TRY(
        view("Sherds and cracks", "", -60, .45, 280, LightMode::museum, {"pieces", "cracks"}));
    const Table& table = tables_.at("observations");
    const auto stop = [&](const store::NamedPart& of, nlohmann::json title, nlohmann::json text) {
      return nlohmann::json{{"view", of.id},
                            {"title", std::move(title)},
                            {"text", std::move(text)},
                            {"attract_s", 10},
                            {"transition", "move"},
                            {"transition_s", 2},
                            {"layers", nlohmann::json::array()},
                            {"records", nlohmann::json::array()}};
    };
    store::NamedPart tour;
    tour.model_id = model_.id;
    tour.name = "A pot and its conservators";
    tour.text = "Three stops for visitors.";
    tour.user = kDemoCurator;
    tour.content = {
        {"languages", {"en", "de", "es"}},
        {"idle_s", 60},
        {"stops",
         {stop(sherds, {{"en", "Broken"}, {"de", "Zerbrochen"}, {"es", "Rota"}},
               {{"en", "The pot was put together from fourteen sherds."},
                {"de", "Der Topf wurde aus vierzehn Scherben zusammengesetzt."},
                {"es", "La vasija se recompuso a partir de catorce fragmentos."}}),
          stop(raking, {{"en", "Made by hand"}, {"de", "Von Hand gemacht"}, {"es", "Hecha a mano"}},
               {{"en", "Light from the side shows the relief."},
                {"de", "Streiflicht zeigt das Relief."},
                {"es", "La luz rasante muestra el relieve."}}),
          stop(condition, {{"en", "Examined"}, {"de", "Untersucht"}, {"es", "Examinada"}},
               {{"en", "Conservators map what they see, and take samples."},
                {"de", "Restauratorinnen kartieren, was sie sehen, und nehmen Proben."},
                {"es", "Las conservadoras cartografían lo que ven y toman muestras."}})}}};
    nlohmann::json columns = nlohmann::json::array();
    for (const char* slug : {"term", "note", "photos"})
      columns.push_back({{"column", find_column(table.columns, slug)->id}});
    tour.content["stops"][2]["records"].push_back(
        {{"table", table.id}, {"keys", observations_}, {"columns", std::move(columns)}});
    store::IdempotentResponse<store::NamedPart> by_curator;
    by_curator.user = kDemoCurator;
    const auto made = STRATA_TRY(store_.tours().create(tour, by_curator));
    const auto kiosk =
        STRATA_TRY(store_.kiosks().create(made.id, "Demo room", kDemoCurator, std::nullopt));
    STRATA_TRY(at(day(6) + 10h + 30min));
    return "/kiosk/" + kiosk.secret;
  }

  // Adds strokes of the annotator that wait for review by the curator.
  Result<void> suggest() {
    const auto lena = [&](Time time, const char* code, const Stroke& stroke) {
      return paint(time, kDemoConservator, "condition", code, stroke, Review::pending);
    };
    STRATA_TRY(lena(day(1) + 15h + 40min, "blistering", {{{-104, .46}, {-97, .43}}, 4}));
    STRATA_TRY(lena(day(1) + 15h + 48min, "salt-crust", {{{-62, .09}, {-50, .10}}, 3.5}));
    STRATA_TRY(lena(day(1) + 15h + 55min, "flaking", {{{-42, .46}, {-36, .44}}, 4}));
    return {};
  }

  store::Store& store_;
  const TemplateRegistry& templates_;
  Progress& progress_;
  const Time today_;
  Time begun_;  // start of the changes that are not backdated yet
  Model model_;
  ProjectId project_ = 0;
  const StoryPlaces* places_ = nullptr;
  const StoryBrush* brush_ = nullptr;
  store::JournalWriter* writer_ = nullptr;
  std::map<std::string, Table> tables_;                  // by slug
  std::map<std::string, Layer> layers_;                  // by slug
  std::map<std::string, std::int64_t> keys_;             // keys of terms by code
  std::map<std::string, StoryBrush::Content> contents_;  // by layer slug
  std::vector<std::int64_t> observations_;
};

}  // namespace

Result<DemoStory> make_demo_story(store::Store& store, const TemplateRegistry& templates,
                                  Progress& progress, double detail) {
  return Story(store, templates, progress).make(detail);
}

Result<void> erase_demo_story(store::Store& store, const std::function<void(ModelId)>& close_room) {
  const auto project = store.projects().find(jobs::kDemoProject);
  if (!project) {
    if (project.error().code == ErrorCode::not_found) return {};
    return tl::unexpected(project.error());
  }
  const auto models = STRATA_TRY(store.models().all(project->id));
  for (const Model& model : models) {
    if (model.slug != jobs::kDemoModel) continue;
    STRATA_TRY(store.trash().put_model(model.id, {}));
    if (close_room) close_room(model.id);
    const auto entry = STRATA_TRY(store.trash().entry(project->id, store::TrashEntry::Kind::model,
                                                      model.id.number(), 0, {Role::owner, {}}));
    STRATA_TRY(store.trash().erase(entry, {}));
  }
  while (STRATA_TRY(store.trash().erase_some())) {
  }
  const auto tables = STRATA_TRY(store.tables().of_project(project->id, Role::owner));
  // Removes the observations first because they refer to terms.
  for (auto renamed = std::rbegin(kTables); renamed != std::rend(kTables); ++renamed)
    for (const Table& table : tables)
      if (table.slug == renamed->slug) STRATA_TRY(store.tables().remove(table.id));
  return {};
}

}  // namespace strata::app
