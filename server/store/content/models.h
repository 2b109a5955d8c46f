#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/ids.h"
#include "domain/scene/model.h"
#include "store/content/idempotent_response.h"

namespace strata::store {

class Blobs;
class Pool;

struct NewModel {
  Model model;  // the model, with id 0; its slug is made unique
  // The object of which the model is a survey, which is created if the project has no object with
  // this name. Empty: `model.object`
  std::string object_name{};
  std::vector<std::uint8_t> geometry;  // mesh::encode_geometry
  std::vector<std::vector<std::uint8_t>>
      detail_levels;  // from mesh::make_detail_levels, encoded in the same way, finest first
  struct Source {
    std::string name;
    std::filesystem::path file;
  };
  std::vector<Source> sources;  // streamed, and hashed byte for byte
  struct NewSurfaceImage {
    std::string name, media_type;     // "image/jpeg" or "image/png"
    std::vector<std::uint8_t> bytes;  // the encoded image
    int width = 0, height = 0;
  };
  std::vector<NewSurfaceImage> images;  // bottom to top; initially, only the first is visible
};

// 3D models with their geometry and source files. Part of Store, whose rules for threads and errors
// apply.
class Models {
 public:
  Models(Pool& pool, Blobs& blobs) : pool_(pool), blobs_(blobs) {}

  Result<Model> create(const NewModel& model, const std::function<bool()>& cancelled,
                       const IdempotentResponse<Model>& answer = {});  // one transaction
  Result<std::vector<Model>> all(std::optional<ProjectId> project_id = {});
  Result<Model> find(const std::string& ref);
  Result<Model> update(Model model, const IdempotentResponse<Model>& answer = {});
  // Deletes the model permanently. Users move it to the Trash instead.
  Result<void> remove(ModelId id, const IdempotentResponse<>& answer = {});
  Result<std::vector<std::uint8_t>> geometry(ModelId model_id);
  // Returns the coarser copies of the geometry, finest first.
  Result<std::vector<std::vector<std::uint8_t>>> detail_levels(ModelId model_id);
  // Streams a source file in chunks of at most 1 MiB. `sink` returns false to stop.
  Result<SourceFile> read_source(ModelId model_id, const std::string& name,
                                 const std::function<bool(std::span<const std::uint8_t>)>& sink);

 private:
  Pool& pool_;
  Blobs& blobs_;
};

}  // namespace strata::store
