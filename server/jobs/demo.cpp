#include <algorithm>
#include <chrono>
#include <future>
#include <utility>

#include "core/text/slug.h"
#include "jobs/demo.h"
#include "jobs/demo_rules.h"
#include "jobs/import_job.h"
#include "jobs/model_geometry.h"
#include "mesh/atlas/atlas.h"
#include "mesh/demo/demo_pot.h"
#include "mesh/surface/geometry.h"
#include "mesh/texels/surface_map.h"
#include "store/content/layers.h"
#include "store/content/models.h"
#include "store/content/projects.h"
#include "store/journal/journal_reads.h"
#include "store/journal/journal_writer.h"
#include "store/nodes/nodes.h"

namespace strata::jobs {
namespace {

constexpr int kResolution = 2048;
constexpr const char* kProject = kDemoProject;
constexpr const char* kModel = "Demo pot";
constexpr const char* kAuthor = "Strata";

Layer sherds_layer() {
  // Light and dark tones alternate, so neighbors are distinct for all types of color vision.
  static constexpr Rgba kColors[DemoRules::kSherds] = {
      {230, 159, 0, 255},   {86, 180, 233, 255},  {0, 114, 178, 255},  {240, 228, 66, 255},
      {213, 94, 0, 255},    {204, 121, 167, 255}, {120, 94, 240, 255}, {255, 176, 124, 255},
      {51, 34, 136, 255},   {170, 221, 221, 255}, {136, 34, 85, 255},  {221, 204, 119, 255},
      {153, 153, 153, 255}, {170, 68, 153, 255}};
  Layer layer;
  layer.name = layer.slug = "pieces";
  layer.description = "The numbered sherds from which the pot was reassembled.";
  layer.palette = {PaletteMode::categorical, 1, DemoRules::kSherds, {}, {}};
  for (int i = 0; i < DemoRules::kSherds; ++i)
    layer.palette.points.push_back({double(i + 1), kColors[i], "Sherd " + std::to_string(i + 1)});
  layer.opacity = 0.55;  // keeps the relief and the color of the clay visible
  layer.order = 0;
  return layer;
}

Layer cracks_layer() {
  Layer layer;
  layer.name = layer.slug = "cracks";
  layer.description = "Cracks, classified by their width.";
  layer.palette = {PaletteMode::categorical, DemoRules::hairline, DemoRules::open_crack, {}, {}};
  layer.palette.points = {{DemoRules::hairline, {156, 230, 120, 255}, "Hairline"},
                          {DemoRules::crack, {34, 160, 70, 255}, "Crack"},
                          {DemoRules::open_crack, {0, 84, 48, 255}, "Open crack"}};
  layer.opacity = 0.95;
  layer.order = 1;
  return layer;
}

Result<Project> demo_project(store::Store& store) {
  auto project = store.projects().find(kProject);
  if (project || project.error().code != ErrorCode::not_found) return project;
  Project fresh;
  fresh.name = "Demo";
  fresh.slug = kProject;
  fresh.description = "An invented pot for trying out Strata.";
  return store.projects().create(fresh);
}

Result<Model> create_pot(store::Store& store, const Project& project, double detail,
                         Progress& progress) {
  progress.begin_stage(0, 0.05);
  progress.report(0, "Making the pot");
  const mesh::TriangleMesh pot = mesh::make_demo_pot(detail);
  progress.begin_stage(0.05, 0.5);
  auto atlas = STRATA_TRY(mesh::make_atlas(pot, kResolution, progress));
  mesh::Geometry geometry = mesh::build_geometry(pot, atlas);

  store::NewModel fresh;
  Model& model = fresh.model;
  model.project_id = project.id;
  model.name = kModel;
  model.slug = make_slug(kModel);
  model.unit = Unit::mm;
  model.unit_assumed = false;
  model.scale_verified = true;
  model.atlas = atlas.report;
  model.default_resolution = kResolution;
  model.creator = kAuthor;
  model.method = "Computed from formulas, not scanned";
  progress.begin_stage(0.5, 0.6);
  progress.report(0, "Saving the pot");
  STRATA_TRY(put_geometry(std::move(geometry), progress, fresh));
  return store.models().create(fresh, [&progress] { return progress.cancelled(); });
}

Result<Model> find_or_create_pot(store::Store& store, double detail, Progress& progress) {
  const auto project = STRATA_TRY(demo_project(store));
  const auto models = STRATA_TRY(store.models().all(project.id));
  const auto pot = std::find_if(models.begin(), models.end(),
                                [](const Model& model) { return model.name == kModel; });
  return pot != models.end() ? *pot : create_pot(store, project, detail, progress);
}

Result<Layer> find_or_create_layer(store::Store& store, const Model& model, Layer requested) {
  auto layer = store.layers().find(model.id, requested.slug, Role::owner);
  if (layer || layer.error().code != ErrorCode::not_found) return layer;
  requested.model_id = model.id;
  requested.type = ValueType::u8;
  requested.resolution = kResolution;
  return store.layers().create(requested);
}

// Makes one fill: each texel gets the value that the rule returns for its position. 0 means no
// value. Tiles are in the order of their addresses.
template <class Rule>
store::JournalEntry fill_by_rule(const mesh::SurfaceMap& map, const Layer& layer,
                                 double metres_per_unit, const Rule& rule) {
  store::JournalEntry entry;
  const int tiles = map.resolution / kTileSize, blocks = kTileSize / kBlockSize;
  std::uint64_t texels = 0;
  double area = 0;
  for (int ty = 0; ty < tiles; ++ty)
    for (int tx = 0; tx < tiles; ++tx) {
      const TileAddress address{static_cast<std::uint16_t>(tx), static_cast<std::uint16_t>(ty)};
      TileData tile(layer.type);
      TileMask written;
      for (int block = 0; block < blocks * blocks; ++block) {
        const int bx = block % blocks, by = block / blocks;
        const auto slot = map.slot_of_block[std::size_t(ty * blocks + by) * map.blocks_per_side +
                                            tx * blocks + bx];
        if (slot == mesh::kNoSlot) continue;
        for (int i = 0; i < kBlockSize * kBlockSize; ++i) {
          const std::size_t at = std::size_t(slot) * 64 + i;
          if (map.packed_position[at] == mesh::kNoPosition) continue;
          const std::uint8_t value = rule(map.position(slot, i));
          if (value == 0) continue;
          const int texel =
              (by * kBlockSize + i / kBlockSize) * kTileSize + bx * kBlockSize + i % kBlockSize;
          tile.write(texel, value);
          written.set(texel);
          texels += map.surface_mask[slot] >> i & 1u;
          area += map.area[at];
        }
      }
      if (!written.any()) continue;
      entry.revisions.push_back(
          {address,
           encode_revision(make_revision(address, TileData(layer.type), tile, written)),
           {}});
    }
  entry.answer = {{"texels_changed", texels},
                  {"area_m2", area * metres_per_unit * metres_per_unit}};
  return entry;
}

Result<void> write_entry(store::Store& store, const Model& model, const Layer& layer,
                         const char* rule, std::chrono::system_clock::time_point time,
                         store::JournalEntry entry) {
  // The new epoch prevents writes by a room that is already open and lacks this entry.
  entry.epoch = STRATA_TRY(store.nodes().begin_epoch(model.id));
  const auto last = STRATA_TRY(store.journal().last_sequence(model.id));
  entry.model_id = model.id;
  entry.layer_id = layer.id;
  entry.sequence = last + 1;
  entry.id = entry.stroke = random_uuid();
  entry.user = kAuthor;
  entry.op = "fill";
  entry.record = {{"op", "fill"}, {"mode", "rule"}, {"rule", rule}};
  entry.answer["sequence"] = entry.sequence;
  entry.time = time;
  std::promise<Result<void>> saved;
  store::JournalWriter writer(store, {});
  if (!writer.submit(std::move(entry),
                     [&saved](Result<void> result) { saved.set_value(std::move(result)); }))
    return fail(ErrorCode::unavailable, "Database unavailable",
                "The database did not answer, so the server could not save the layers of the "
                "demo. Try again.");
  return saved.get_future().get();
}

}  // namespace

Result<Model> make_demo_at(store::Store& store, Progress& progress, double detail,
                           std::chrono::system_clock::time_point time) {
  const auto pot = STRATA_TRY(find_or_create_pot(store, detail, progress));
  const auto pieces = STRATA_TRY(find_or_create_layer(store, pot, sherds_layer()));
  const auto cracks = STRATA_TRY(find_or_create_layer(store, pot, cracks_layer()));
  // Does not change a layer that a user has painted on or emptied.
  if (pieces.sequence == 0 || cracks.sequence == 0) {
    const auto stored = STRATA_TRY(store.models().geometry(pot.id));
    const auto geometry = STRATA_TRY(mesh::decode_geometry(stored));
    progress.begin_stage(0.6, 0.75);
    progress.report(0, "Mapping the surface");
    const auto map = STRATA_TRY(mesh::bake_surface_map(geometry, kResolution, progress));

    std::vector<glm::vec3> surface;
    for (const auto& vertex : geometry.vertices) surface.push_back(vertex.position);
    const DemoRules rules(surface);
    progress.begin_stage(0.75, 1);
    progress.report(0, "Painting the demo's layers");
    if (pieces.sequence == 0) {
      auto entry = fill_by_rule(map, pieces, pot.metres(),
                                [&](const glm::vec3& p) { return rules.at(p).sherd; });
      if (progress.cancelled()) return cancelled_problem();
      if (auto saved =
              write_entry(store, pot, pieces, "sherds of the demo pot", time, std::move(entry));
          !saved)
        return tl::unexpected(saved.error());
    }
    progress.report(0.5, "Painting the demo's layers");
    if (cracks.sequence == 0) {
      auto entry = fill_by_rule(map, cracks, pot.metres(), [&](const glm::vec3& p) {
        return std::uint8_t(rules.at(p).crack);
      });
      if (progress.cancelled()) return cancelled_problem();
      if (auto saved =
              write_entry(store, pot, cracks, "cracks of the demo pot", time, std::move(entry));
          !saved)
        return tl::unexpected(saved.error());
    }
  }
  progress.begin_stage(0, 1);
  progress.report(1, "Done");
  return store.models().find(to_string(pot.id));
}

Result<Model> make_demo(store::Store& store, Progress& progress, double detail) {
  return make_demo_at(store, progress, detail, std::chrono::system_clock::now());
}

}  // namespace strata::jobs
