#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "app/cancellable.h"
#include "app/deposit/crate_json.h"
#include "app/deposit/deposit_parts.h"
#include "app/deposit/identifiers.h"
#include "core/memory_ledger.h"
#include "core/text/csv.h"
#include "core/text/timestamp.h"
#include "media/media_type.h"
#include "media/picture_writer.h"
#include "mesh/io/gltf/write_glb.h"
#include "query/rasters/raster.h"
#include "room/rooms.h"
#include "store/content/layers.h"
#include "store/content/models.h"
#include "store/content/photographs.h"
#include "store/content/surface_images.h"
#include "store/content/tour_files.h"
#include "store/journal/journal_reads.h"
#include "store/store.h"

namespace strata::app {
namespace {

constexpr const char* kCsv = "text/csv";
constexpr const char* kBinary = "application/octet-stream";
constexpr int kPage = 1000;

std::string license_uri(const std::string& rights) {
  const License* license = find_license(rights);
  return license ? std::string(license->uri) : rights;
}

// Adds the files of one model.
class ModelDeposit {
 public:
  ModelDeposit(Bag& bag, const DepositReader& from, const Model& model)
      : bag_(bag), from_(from), store_(from.services.store), model_(model) {
    folder_ = "models/" + model.slug + "/";
  }

  Result<std::string> add(const std::string& object) {
    all_ = {{"model", crate::to_crate(model_)}, {"object", object}};
    for (auto step : {&ModelDeposit::add_scan, &ModelDeposit::add_images, &ModelDeposit::add_mesh,
                      &ModelDeposit::add_layers, &ModelDeposit::add_photographs,
                      &ModelDeposit::add_named_parts, &ModelDeposit::add_comments}) {
      if (from_.progress.cancelled()) return cancelled_problem();
      STRATA_TRY((this->*step)());
    }
    const std::string path = folder_ + kModelFile;
    STRATA_TRY(bag_.add(file(kModelFile, "application/json", "Properties of " + model_.name),
                        all_.dump(1)));
    return path;
  }

 private:
  BagFile file(const std::string& path, std::string media_type, std::string description) const {
    BagFile added;
    added.path = bag_.free_path(folder_ + path);
    added.media_type = std::move(media_type);
    added.description = std::move(description);
    added.license = license_uri(model_.rights_uri);
    return added;
  }

  Result<void> add_scan() {
    all_["scan"] = nlohmann::json::array();
    for (const SourceFile& source : model_.source_files) {
      BagFile added = file("scan/" + portable_name(source.name, "scan"), kBinary,
                           "File of the scan, as uploaded");
      added.sha256 = source.sha256;
      added.bytes = source.bytes;
      all_["scan"].push_back({{"name", source.name}, {"file", added.path}});
      bag_.add_stored(std::move(added));
    }
    return {};
  }

  Result<void> add_images() {
    all_["images"] = nlohmann::json::array();
    images_ = STRATA_TRY(store_.surface_images().of_model(model_.id));
    for (const SurfaceImage& image : images_) {
      const char* ending = image.media_type == "image/png" ? ".png" : ".jpg";
      BagFile added = file("images/" + image.slug + ending, image.media_type,
                           "Image of the surface, in the atlas: " + image.name);
      added.sha256 = image.sha256;
      added.bytes = image.bytes;
      all_["images"].push_back(crate::to_crate(image));
      all_["images"].back()["file"] = added.path;
      bag_.add_stored(std::move(added));
    }
    return {};
  }

  // The mesh with the coordinates of the atlas, once for other programs and once exactly as stored.
  Result<void> add_mesh() {
    from_.progress.report(0, "Reading the mesh of " + model_.name);
    {
      const auto stored = STRATA_TRY(store_.models().geometry(model_.id));
      BagFile added =
          file("mesh/geometry.bin", kBinary, "Mesh and atlas, in the form that Strata stores");
      all_["geometry"] = added.path;
      STRATA_TRY(bag_.add(std::move(added), std::span<const std::uint8_t>(stored)));
      STRATA_TRY(add_glb(stored));
    }
    all_["detail_levels"] = nlohmann::json::array();
    const auto levels = STRATA_TRY(store_.models().detail_levels(model_.id));
    for (std::size_t i = 0; i < levels.size(); ++i) {
      BagFile added = file("mesh/coarser-" + std::to_string(i + 1) + ".bin", kBinary,
                           "Coarser mesh, in the form that Strata stores");
      all_["detail_levels"].push_back(added.path);
      STRATA_TRY(bag_.add(std::move(added), std::span<const std::uint8_t>(levels[i])));
    }
    return {};
  }

  Result<void> add_glb(std::span<const std::uint8_t> stored) {
    mesh::GlbModel glb;
    auto geometry = STRATA_TRY(mesh::decode_geometry(stored));
    // A mesh above the limit of the format is in the scan only.
    if (!mesh::check_glb_size(geometry)) return {};
    const auto memory = STRATA_TRY(
        from_.services.rooms.memory().reserve(geometry.bytes(), "the mesh of a deposit"));
    glb.name = model_.name;
    glb.copyright = model_.credit;
    glb.geometry = std::make_shared<const mesh::Geometry>(std::move(geometry));
    glb.metres_per_unit = model_.metres();
    glb.up = model_.up;
    const auto shown = std::ranges::find(images_, true, &SurfaceImage::visible);
    if (shown != images_.end()) {
      glb.color.bytes = STRATA_TRY(store_.surface_images().picture(shown->id));
      glb.color.media_type = shown->media_type;
    } else {
      constexpr std::array<std::uint8_t, 4> kWhite{255, 255, 255, 255};
      PictureWriter writer(PictureFormat::png, 1, 1, {});
      writer.put(kWhite);
      glb.color = {"image/png", writer.finish()};
    }
    STRATA_TRY(mesh::write_glb(glb, bag_.next_file(), from_.progress));
    BagFile added = file("mesh/surface.glb", "model/gltf-binary",
                         "Mesh in meters, with the texture coordinates of the layers");
    all_["surface"] = added.path;
    return bag_.add_made(std::move(added));
  }

  Result<void> add_layers() {
    all_["layers"] = nlohmann::json::array();
    const auto layers = STRATA_TRY(store_.layers().of_model(model_.id, from_.reader.role));
    for (const Layer& layer : layers) {
      if (from_.progress.cancelled()) return cancelled_problem();
      from_.progress.report(0, "Reading the layer " + layer.name);
      nlohmann::json shown = crate::to_crate(layer);
      BagFile raster = file("layers/" + layer.slug + ".tif", "image/tiff",
                            "Layer " + layer.name + ": values in the atlas of the mesh");
      shown["file"] = raster.path;
      STRATA_TRY(add_raster(layer, std::move(raster)));
      BagFile history =
          file("layers/" + layer.slug + "-history.csv", kCsv, "History of the layer " + layer.name);
      shown["history"] = history.path;
      const std::string text = STRATA_TRY(history_of(layer));
      STRATA_TRY(bag_.add(std::move(history), text));
      all_["layers"].push_back(std::move(shown));
    }
    return {};
  }

  Result<void> add_raster(const Layer& layer, BagFile added) {
    const auto texels =
        static_cast<std::uint64_t>(layer.resolution) * static_cast<std::uint64_t>(layer.resolution);
    const auto memory = STRATA_TRY(from_.services.rooms.memory().reserve(
        texels * 3 * static_cast<std::uint64_t>(bytes_per_texel(layer.type)),
        "a layer of a deposit"));
    const auto snapshot = STRATA_TRY(store_.journal().load_tiles(layer));
    const auto tiff = STRATA_TRY(query::encode_tiff(layer, snapshot.tiles));
    return bag_.add(std::move(added), std::span<const std::uint8_t>(tiff));
  }

  Result<std::string> history_of(const Layer& layer) {
    std::string text =
        csv_line({"sequence", "time", "person", "operation", "in_force", "review", "request"}, ',');
    std::optional<std::int64_t> before;
    for (;;) {
      const auto page = STRATA_TRY(store_.journal().history(layer.id, kPage, 0, before));
      for (const store::JournalRow& row : page.rows) {
        text += csv_line(
            {std::to_string(row.sequence), utc_text(row.time), guard_formula(row.user), row.op,
             row.in_force ? "true" : "false", std::string(name(row.review)), row.record.dump()},
            ',');
        before = row.sequence;
      }
      if (page.rows.size() < kPage) return text;
    }
  }

  Result<void> add_photographs() {
    all_["photographs"] = nlohmann::json::array();
    const auto photographs = STRATA_TRY(store_.photographs().of_model(model_.id));
    for (const store::Photograph& photograph : photographs) {
      nlohmann::json shown = crate::to_crate(photograph);
      if (const auto& original = photograph.original) {
        BagFile added = file("photographs/" + with_ending(photograph.posed.name, *original),
                             original->media_type, "Photograph, as uploaded");
        added.sha256 = original->sha256;
        added.bytes = original->bytes;
        if (!photograph.rights_uri.empty()) added.license = license_uri(photograph.rights_uri);
        shown["file"] = added.path;
        bag_.add_stored(std::move(added));
      }
      all_["photographs"].push_back(std::move(shown));
    }
    return {};
  }

  // Programs of photogrammetry may leave out the ending of a name.
  static std::string with_ending(const std::string& name, const store::Original& original) {
    const std::string portable = portable_name(name, "photograph");
    if (portable.find('.') != std::string::npos) return portable;
    return portable + (original.media_type == "image/png"    ? ".png"
                       : original.media_type == "image/tiff" ? ".tif"
                                                             : ".jpg");
  }

  Result<nlohmann::json> parts_of(store::NamedParts& parts) {
    nlohmann::json list = nlohmann::json::array();
    // Deposits are published, so they do not contain the personal selections of their maker.
    const auto page = STRATA_TRY(parts.of_model(model_.id, kPage, 0, 0, {}));
    for (const store::NamedPart& part : page.parts) list.push_back(crate::to_crate(part));
    return list;
  }

  Result<void> add_named_parts() {
    all_["views"] = STRATA_TRY(parts_of(store_.views()));
    all_["snapshots"] = STRATA_TRY(parts_of(store_.snapshots()));
    all_["selections"] = STRATA_TRY(parts_of(store_.selections()));
    all_["tours"] = STRATA_TRY(parts_of(store_.tours()));
    for (nlohmann::json& tour : all_["tours"]) {
      tour["files"] = nlohmann::json::array();
      const auto files = STRATA_TRY(store_.tour_files().of_tour(tour["id"].get<NamedPartId>()));
      for (const store::TourFile& each : files) {
        BagFile added = file(
            "tours/" + tour["slug"].get<std::string>() + "/" + portable_name(each.name, "file"),
            each.media_type, "File of a tour");
        added.sha256 = each.sha256;
        added.bytes = each.bytes;
        tour["files"].push_back({{"id", each.id.number()},
                                 {"name", each.name},
                                 {"media_type", each.media_type},
                                 {"width", each.width ? nlohmann::json(*each.width) : nullptr},
                                 {"height", each.height ? nlohmann::json(*each.height) : nullptr},
                                 {"file", added.path}});
        bag_.add_stored(std::move(added));
      }
    }
    return {};
  }

  Result<void> add_comments() {
    all_["comments"] = nlohmann::json::array();
    store::Comments::Query query;
    query.limit = kPage;
    for (;;) {
      const auto page = STRATA_TRY(store_.comments().of_model(model_.id, from_.reader.role, query));
      for (const store::Comment& comment : page.comments) {
        all_["comments"].push_back(crate::to_crate(comment));
        query.after = comment.id.number();
      }
      if (page.comments.size() < kPage) return {};
    }
  }

  Bag& bag_;
  const DepositReader& from_;
  store::Store& store_;
  const Model& model_;
  std::string folder_;
  std::vector<SurfaceImage> images_;
  nlohmann::json all_;  // model.json
};

}  // namespace

Result<std::string> add_model(Bag& bag, const DepositReader& from, const Model& model,
                              const std::string& object) {
  return ModelDeposit(bag, from, model).add(object);
}

}  // namespace strata::app
