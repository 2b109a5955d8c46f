#include <algorithm>
#include <chrono>
#include <future>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>

#include "app/deposit/crate_json.h"
#include "app/deposit/import_parts.h"
#include "domain/layers/revision.h"
#include "media/picture.h"
#include "mesh/surface/geometry.h"
#include "mesh/texels/surface_map.h"
#include "query/rasters/raster.h"
#include "room/pipeline/tile_changes.h"
#include "store/content/layers.h"
#include "store/content/models.h"
#include "store/content/photographs.h"
#include "store/content/surface_images.h"
#include "store/journal/journal_reads.h"
#include "store/journal/journal_writer.h"
#include "store/nodes/nodes.h"
#include "store/store.h"

namespace strata::app {
namespace {

using nlohmann::json;

tl::unexpected<Error> refused(const std::string& path, const std::string& why) {
  return fail(ErrorCode::invalid, "Deposit not imported",
              "The file " + path + " of the deposit cannot be imported: " + why);
}

// Makes one model.
class ModelImport {
 public:
  ModelImport(const Import& import, const json& all)
      : import_(import), store_(import.store), all_(all) {}

  Result<void> run() {
    STRATA_TRY(make_model());
    STRATA_TRY(set_images());
    STRATA_TRY(make_layers());
    return add_photographs();
  }

 private:
  Result<std::vector<std::uint8_t>> bytes_of_file(const json& path) const {
    const auto file = STRATA_TRY(import_.open(path.get<std::string>()));
    return std::vector<std::uint8_t>(file.bytes().begin(), file.bytes().end());
  }

  // Reads a mesh and checks it, because rooms rely on it.
  Result<std::vector<std::uint8_t>> coarser_mesh(const json& path) const {
    auto bytes = STRATA_TRY(bytes_of_file(path));
    const auto geometry = mesh::decode_geometry(bytes);
    if (!geometry) return refused(path, geometry.error().detail);
    if (geometry->part_ends.size() != geometry_.part_ends.size())
      return refused(path, "It does not have the parts of this model.");
    return bytes;
  }

  Result<void> read_mesh(store::NewModel& fresh) {
    const auto path = all_.at("geometry").get<std::string>();
    fresh.geometry = STRATA_TRY(bytes_of_file(path));
    auto geometry = mesh::decode_geometry(fresh.geometry);
    if (!geometry) return refused(path, geometry.error().detail);
    if (geometry->triangle_count() != fresh.model.triangles ||
        geometry->positions.size() != fresh.model.vertices ||
        geometry->origin != fresh.model.origin ||
        geometry->part_ends.size() != fresh.model.parts.size())
      return refused(path, "It does not belong to this model.");
    geometry_ = std::move(*geometry);
    return {};
  }

  Result<void> make_model() {
    store::NewModel fresh;
    fresh.model = crate::model_of(all_.at("model"));
    import_.progress.report(0, "Writing the model " + fresh.model.name);
    const ModelId before = fresh.model.id;
    fresh.model.id = {};
    fresh.model.project_id = import_.made.project.id;
    fresh.object_name = all_.at("object").get<std::string>();
    if (fresh.object_name.empty()) fresh.model.survey_date.clear();
    STRATA_TRY(read_mesh(fresh));
    for (const json& level : all_.at("detail_levels")) {
      auto bytes = STRATA_TRY(coarser_mesh(level));
      fresh.detail_levels.push_back(std::move(bytes));
    }
    for (const json& source : all_.at("scan")) {
      auto place = STRATA_TRY(import_.place_of(source.at("file").get<std::string>()));
      fresh.sources.push_back({source.at("name").get<std::string>(), std::move(place)});
    }
    for (const json& each : all_.at("images")) {
      const SurfaceImage image = crate::surface_image_of(each);
      auto bytes = STRATA_TRY(bytes_of_file(each.at("file")));
      const auto info = inspect_picture(bytes);
      if (!info || !is_surface_image_format(info->format))
        return refused(each.at("file"), "It is not a JPEG or PNG.");
      fresh.images.push_back({image.name, std::string(media_type(info->format)), std::move(bytes),
                              info->width, info->height});
    }
    model_ = STRATA_TRY(store_.models().create(
        fresh, [&progress = import_.progress] { return progress.cancelled(); }));
    import_.ids.models[before] = model_.id;
    import_.made.files += static_cast<std::int64_t>(fresh.sources.size());
    return {};
  }

  Result<void> set_images() {
    const auto made = STRATA_TRY(store_.surface_images().of_model(model_.id));
    for (std::size_t i = 0; i < made.size(); ++i) {
      const SurfaceImage stored = crate::surface_image_of(all_.at("images").at(i));
      SurfaceImage image = made[i];
      image.slug = stored.slug;
      image.description = stored.description;
      image.opacity = stored.opacity;
      image.visible = stored.visible;
      image.order = stored.order;
      STRATA_TRY(store_.surface_images().update(image));
      import_.ids.images[stored.id] = image.id;
    }
    return {};
  }

  Result<void> make_layers() {
    std::vector<const json*> waiting;
    for (const json& each : all_.at("layers")) waiting.push_back(&each);
    std::set<LayerId> unknown;
    for (const json* each : waiting) unknown.insert(each->at("id").get<LayerId>());
    store::JournalWriter writer(store_, {});
    // A computed layer is made after the layers that its formula names.
    while (!waiting.empty()) {
      const auto is_ready = [&](const json* each) {
        const Layer layer = crate::layer_of(*each);
        return !layer.formula || std::ranges::all_of(layer.formula->inputs, [&](const auto& input) {
          return !input.layer || !unknown.contains(*input.layer);
        });
      };
      auto next = std::ranges::find_if(waiting, is_ready);
      if (next == waiting.end()) next = waiting.begin();
      const Layer layer = STRATA_TRY(make_layer(**next));
      STRATA_TRY(write_texels(writer, **next, layer));
      unknown.erase((*next)->at("id").get<LayerId>());
      waiting.erase(next);
      ++import_.made.layers;
    }
    return {};
  }

  Result<Layer> make_layer(const json& all) {
    Layer layer = crate::layer_of(all);
    const LayerId before = layer.id;
    layer.id = {};
    layer.model_id = model_.id;
    if (layer.table) {
      const auto table = import_.ids.tables.find(*layer.table);
      if (table == import_.ids.tables.end())
        return refused(all.at("file"), "Its table is not in the deposit.");
      layer.table = table->second;
    }
    if (layer.formula) {
      // The layer must not be computed before the records exist (finish_formulas).
      layer.formula->automatic = false;
      for (auto& input : layer.formula->inputs) {
        if (input.layer) input.layer = mapped(import_.ids.layers, *input.layer);
        if (input.table) input.table = mapped(import_.ids.tables, *input.table);
      }
    }
    if (layer.palette_of_terms) layer.palette.points.clear();
    auto made = store_.layers().create(layer);
    if (!made) return refused(all.at("file"), made.error().detail);
    import_.ids.layers[before] = made->id;
    return made;
  }

  template <class Id>
  static std::optional<Id> mapped(const std::map<Id, Id>& ids, Id before) {
    const auto found = ids.find(before);
    return found == ids.end() ? std::nullopt : std::optional(found->second);
  }

  // Returns the surface map of a resolution. Keeps only the last one, which most layers share.
  Result<std::shared_ptr<const mesh::SurfaceMap>> map_of(int resolution) {
    if (map_ && map_->resolution == resolution) return map_;
    map_.reset();
    auto map = STRATA_TRY(mesh::bake_surface_map(geometry_, resolution, import_.progress));
    map_ = std::make_shared<const mesh::SurfaceMap>(std::move(map));
    return map_;
  }

  Result<void> write_texels(store::JournalWriter& writer, const json& all, const Layer& layer) {
    const auto path = all.at("file").get<std::string>();
    import_.progress.report(0, "Writing the layer " + layer.name);
    if (import_.progress.cancelled()) return cancelled_problem();
    TileMap tiles;
    {
      const auto file = STRATA_TRY(import_.open(path));
      auto decoded = query::decode_tiff(layer, file.bytes());
      if (!decoded) return refused(path, decoded.error().detail);
      tiles = std::move(*decoded);
    }
    if (tiles.empty()) return {};
    // With the sums of its tiles. Otherwise a running server would open the model to compute them.
    const auto map = STRATA_TRY(map_of(layer.resolution));
    store::JournalEntry entry = entry_of(layer, tiles, *map);
    entry.sum_tile = [map, layer, tiles](TileAddress address) {
      return room::sum_tile(layer, *map, address, *tiles.at(address));
    };
    return write_entry(writer, std::move(entry));
  }

  // A user of a running server may open the model at any time, so the epoch can end before the
  // entry is written.
  Result<void> write_entry(store::JournalWriter& writer, const store::JournalEntry& entry) {
    constexpr int kAttempts = 5;
    for (int attempt = 1;; ++attempt) {
      store::JournalEntry next = entry;
      next.epoch = STRATA_TRY(store_.nodes().begin_epoch(model_.id));
      next.sequence = STRATA_TRY(store_.journal().last_sequence(model_.id)) + 1;
      next.answer["sequence"] = next.sequence;
      std::promise<Result<void>> saved;
      if (!writer.submit(std::move(next),
                         [&saved](Result<void> result) { saved.set_value(std::move(result)); }))
        return fail(ErrorCode::unavailable, "Database unavailable",
                    "The database did not answer, so the deposit was not imported. Try again.");
      auto done = saved.get_future().get();
      if (done || done.error().code != ErrorCode::moved || attempt == kAttempts) return done;
    }
  }

  store::JournalEntry entry_of(const Layer& layer, const TileMap& tiles,
                               const mesh::SurfaceMap& map) const {
    std::vector<TileAddress> addresses;
    for (const auto& [address, tile] : tiles) addresses.push_back(address);
    std::ranges::sort(addresses);
    store::JournalEntry entry;
    std::uint64_t texels = 0;
    double area = 0;  // in unit²
    for (const TileAddress address : addresses) {
      const TileData& tile = *tiles.at(address);
      const TileMask written = tile.valid;
      for (const store::KeySum& sum : room::sum_tile(layer, map, address, tile)) {
        texels += sum.texels;
        area += sum.area;
      }
      entry.revisions.push_back(
          {address,
           encode_revision(make_revision(address, TileData(layer.type), tile, written)),
           {}});
    }
    entry.model_id = layer.model_id;
    entry.layer_id = layer.id;
    entry.id = entry.stroke = random_uuid();
    entry.user = kImporter;
    entry.op = "import";
    entry.record = {{"op", "import"}};
    entry.answer = {{"texels_changed", texels},
                    {"area_m2", area * model_.metres() * model_.metres()}};
    entry.time = std::chrono::system_clock::now();
    return entry;
  }

  Result<void> add_photographs() {
    std::vector<photo::PosedPhotograph> poses;
    for (const json& each : all_.at("photographs"))
      poses.push_back(crate::photograph_of(each).posed);
    if (poses.empty()) return {};
    const auto merged = STRATA_TRY(store_.photographs().merge(model_.id, poses));
    if (!merged.refused.empty()) return refused(kPhotographs, merged.refused.front().reason.detail);
    const auto names = STRATA_TRY(store_.photographs().names(model_.id));
    std::map<std::string, store::PhotographId> ids;
    for (const auto& [id, name] : names) ids[name] = id;
    std::map<std::pair<std::string, std::string>, std::vector<store::PhotographId>> rights;
    for (const json& each : all_.at("photographs")) {
      if (import_.progress.cancelled()) return cancelled_problem();
      const store::Photograph photograph = crate::photograph_of(each);
      const auto id = ids.at(photograph.posed.name);
      if (!photograph.rights_uri.empty() || !photograph.rights_holder.empty())
        rights[{photograph.rights_uri, photograph.rights_holder}].push_back(id);
      if (photograph.original) STRATA_TRY(set_original(each.at("file"), id));
    }
    for (const auto& [right, of] : rights)
      STRATA_TRY(store_.photographs().set_rights(model_.id, of, right.first, right.second));
    import_.made.photographs += merged.total;
    return {};
  }

  Result<void> set_original(const std::string& path, store::PhotographId id) {
    const auto file = STRATA_TRY(import_.open(path));
    const auto info = inspect_picture(file.bytes(), photo::kMaxPhotographSide);
    if (!info) return refused(path, info.error().detail);
    if (info->format != PictureFormat::jpeg && info->format != PictureFormat::png &&
        info->format != PictureFormat::tiff)
      return refused(path, "It is not a JPEG, PNG or TIFF.");
    const auto place = STRATA_TRY(import_.place_of(path));
    const auto set = store_.photographs().set_original(
        model_.id, id, {place, std::string(media_type(info->format)), info->width, info->height});
    return set ? Result<void>() : refused(path, set.error().detail);
  }

  static constexpr const char* kPhotographs = "model.json";

  const Import& import_;
  store::Store& store_;
  const json& all_;
  Model model_;
  mesh::Geometry geometry_;
  std::shared_ptr<const mesh::SurfaceMap> map_;
};

}  // namespace

Result<void> import_model(const Import& import, const json& all) {
  return ModelImport(import, all).run();
}

}  // namespace strata::app
