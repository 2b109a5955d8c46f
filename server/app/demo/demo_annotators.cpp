#include "app/demo/demo_annotators.h"

#include <algorithm>
#include <glm/gtc/matrix_transform.hpp>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "app/demo/demo_story.h"
#include "app/demo/story_places.h"
#include "app/edits.h"
#include "core/uuid.h"
#include "domain/people/person_color.h"
#include "domain/scene/camera.h"
#include "domain/tables/term_list.h"
#include "jobs/demo.h"
#include "room/edit.h"
#include "room/layers.h"
#include "room/participants.h"
#include "room/room.h"
#include "room/rooms.h"
#include "room/surface.h"
#include "store/people/accounts.h"
#include "store/store.h"
#include "store/tables/records.h"

namespace strata::app {
namespace {

using namespace std::chrono_literals;
using Place = StoryPlaces::Place;

constexpr const char* kLayer = "condition";

// A stroke in an area that the story does not paint. The wall is intact there, so the stroke is
// visible.
struct RecordedStroke {
  bool by_curator = false;
  const char* term = "";
  std::vector<Place> path;
  double radius_mm = 4;
};
const std::vector<RecordedStroke>& recorded_strokes() {
  static const std::vector<RecordedStroke> strokes{
      {false, "craquele", {{-140, .68}, {-134, .70}, {-128, .67}, {-122, .69}}, 3.5},
      {true, "loss-of-matrix", {{-48, .63}, {-41, .66}, {-34, .64}}, 4},
      {false, "biological-colonization", {{-100, .24}, {-92, .21}, {-84, .23}}, 4.5},
      {true, "flaking", {{-40, .74}, {-33, .76}, {-26, .74}}, 3.5},
      {false, "soiling", {{-70, .20}, {-62, .17}, {-53, .19}}, 4},
  };
  return strokes;
}

// Returns a stroke with a camera in front of `middle` and with the path in the window of the
// camera.
StrokeBatch seen_from_outside(const StoryPlaces& places, const std::vector<glm::dvec3>& path,
                              const Place& middle) {
  StrokeBatch batch;
  Camera& camera = batch.camera;
  camera.width = 800;
  camera.height = 600;
  const glm::dvec3 target = places.place(middle);
  camera.view = glm::lookAt(target + 180.0 * places.outward(middle), target, glm::dvec3(0, 0, 1));
  camera.projection = glm::perspective(glm::radians(35.0), 4.0 / 3, 20.0, 1000.0);
  for (const glm::dvec3& point : path) {
    const glm::dvec4 clip = camera.projection * camera.view * glm::dvec4(point, 1);
    batch.path.emplace_back((clip.x / clip.w * 0.5 + 0.5) * camera.width,
                            (0.5 - clip.y / clip.w * 0.5) * camera.height);
  }
  return batch;
}

}  // namespace

struct DemoAnnotators::Scene {
  struct Annotator {  // a demo user in the room
    Author author;
    std::unique_ptr<room::Participant> here;
    int strokes = 0;
  };

  Scene(std::shared_ptr<room::Room> in, Layer on, EditCounters& count)
      : room(std::move(in)),
        layer(std::move(on)),
        counters(count),
        places(*room->surface().geometry()),
        lena{Author(kDemoConservator, Role::annotator), nullptr},
        marco{Author(kDemoCurator, Role::curator), nullptr} {}

  Result<void> enter(store::Store& store, Annotator& who) {
    const auto person = STRATA_TRY(store.accounts().find(who.author.user));
    who.here = room->participants().join(
        who.author,
        room::Portrait{person.full_name + " (recorded)", std::string(person_color(person.id))},
        nullptr, [](const auto&) {});
    who.here->edits();
    return {};
  }

  room::EditRequest request(const Annotator& who) const {
    return {random_uuid(), who.author, layer.id, {}, {{"by", "the demo"}}, {}};
  }

  // Undoes all strokes of the two demo users. Other users' strokes over them stay.
  void undo_all() {
    for (Annotator* who : {&lena, &marco})
      for (; who->strokes > 0; --who->strokes) {
        auto edit = request(*who);
        edit.edit = room::UndoEdit{};
        edit.record["op"] = "undo";
        edit_and_wait(*room, std::move(edit), counters);
      }
  }

  std::shared_ptr<room::Room> room;
  Layer layer;
  EditCounters& counters;
  StoryPlaces places;
  Annotator lena, marco;
};

DemoAnnotators::DemoAnnotators(const Services& services, Pace pace)
    : services_(services), pace_(pace), thread_([this] { run(); }) {}

void DemoAnnotators::visited(const Model& model) {
  if (model.slug != jobs::kDemoModel) return;
  const std::lock_guard lock(mutex_);
  visited_ = model.id;
  wake_.notify_all();
}

void DemoAnnotators::stop() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  wake_.notify_all();
  if (thread_.joinable()) thread_.join();
}

void DemoAnnotators::run() {
  for (;;) {
    ModelId model_id{};
    {
      std::unique_lock lock(mutex_);
      wake_.wait(lock, [this] { return stopping_ || visited_; });
      if (stopping_) return;
      model_id = *std::exchange(visited_, std::nullopt);
      const auto before = played_.find(model_id);
      if (before != played_.end() && std::chrono::steady_clock::now() < before->second + pace_.rest)
        continue;
    }
    play(model_id);
  }
}

bool DemoAnnotators::pause(std::chrono::milliseconds time, const room::Room& room) {
  {
    std::unique_lock lock(mutex_);
    if (wake_.wait_for(lock, time, [this] { return stopping_; })) return false;
  }
  int others = 0;
  for (const auto& person : room.participants().presence({}))
    others += person.user != kDemoConservator && person.user != kDemoCurator;
  return others == 1;
}

void DemoAnnotators::play(ModelId model_id) {
  auto room = services_.rooms.open(to_string(model_id), Role::owner);
  if (!room) return;
  auto layer = (*room)->layers().find(kLayer);  // missing in a demo without the story
  if (!layer || !layer->table || !pause(pace_.before_first, **room)) return;
  store::RecordQuery all;
  all.limit = 1000;
  const auto terms = services_.store.records().page(*layer->table, Role::owner, all);
  if (!terms) return;
  const auto columns = term_columns(terms->table);
  if (!columns) return;
  std::map<std::string, std::int64_t> keys;
  for (const ListedTerm& listed : list_terms(*columns, terms->records))
    keys[listed.term.code] = listed.key;

  Scene scene(*room, *layer, services_.edits);
  if (!scene.enter(services_.store, scene.lena) || !scene.enter(services_.store, scene.marco))
    return;
  {
    const std::lock_guard lock(mutex_);
    played_[model_id] = std::chrono::steady_clock::now();
  }
  const auto paint = [&](const RecordedStroke& recorded) {
    const auto key = keys.find(recorded.term);
    if (key == keys.end()) return true;
    auto& who = recorded.by_curator ? scene.marco : scene.lena;
    const auto points = scene.places.line(recorded.path);
    const StrokeBatch whole =
        seen_from_outside(scene.places, points, recorded.path[recorded.path.size() / 2]);
    const Uuid stroke = random_uuid();
    constexpr std::size_t kPointsPerBatch = 3;
    int n = 0;
    for (std::size_t first = 0; first + 1 < points.size(); first += kPointsPerBatch) {
      const std::size_t last = std::min(first + kPointsPerBatch, points.size() - 1);
      who.here->pointer(room::Pointing{points[last], recorded.radius_mm});
      room::StrokeEdit edit;
      edit.batch = whole;
      edit.batch.path.assign(whole.path.begin() + static_cast<std::ptrdiff_t>(first),
                             whole.path.begin() + static_cast<std::ptrdiff_t>(last) + 1);
      edit.batch.radius_world = recorded.radius_mm;
      edit.batch.value_bits = static_cast<std::uint32_t>(key->second);
      edit.stroke = stroke;
      edit.n = n++;
      auto request = scene.request(who);
      request.record["op"] = "stroke";
      request.record["value"] = key->second;
      request.edit = std::move(edit);
      if (!edit_and_wait(**room, std::move(request), services_.edits)) return false;
      if (n == 1) ++who.strokes;
      if (!pause(pace_.per_batch, **room)) return false;
    }
    return pause(pace_.between_strokes, **room);
  };
  const bool whole = std::ranges::all_of(recorded_strokes(), paint);
  if (whole) pause(pace_.before_undo, **room);
  scene.undo_all();
}

}  // namespace strata::app
