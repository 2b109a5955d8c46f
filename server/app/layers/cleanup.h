#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "app/services.h"
#include "core/ids.h"
#include "core/memory_ledger.h"
#include "core/progress.h"
#include "core/uuid.h"
#include "domain/layers/layer.h"
#include "domain/people/role.h"
#include "domain/scene/model.h"
#include "mesh/texels/texel_graph.h"
#include "query/regions/sieve.h"
#include "room/room.h"

// Operations on the regions of a painted layer. They are computed on the calling thread from a
// state of the layer, while other users paint. The result is one edit, which keeps newer paint
// (room::PatchEdit). All functions block.
//
// To add an operation: add its computation to query/regions, its name here, to `cleaned_values`, to
// the schema `Cleanup` and to the dialog of the page.
namespace strata::app {

struct Cleanup {
  enum class Operation { sieve, fill_holes, majority, border, open, close };
  Operation operation = Operation::sieve;
  double area_m2 = 0;                                  // sieve, fill_holes
  query::SieveTo to = query::SieveTo::longest_border;  // sieve
  double radius_m = 0;                                 // majority
  // border, open, close: the value of the regions. Empty: all borders, or the only value of the
  // layer
  std::optional<std::uint32_t> of_bits{};
  double width_m = 0;  // border: of the line; open, close: of the parts and gaps
  // border
  std::optional<LayerId> from{};  // layer with the regions; empty: the layer itself
  bool inside = false;
  query::TexelValue line{};  // without a value: erase
};

// The author, id and journal record of the edit. With `apply` false, there is no edit.
struct CleanupEdit {
  bool apply = true;
  Uuid id;
  Author author;
  nlohmann::json record;
};

struct CleanupResult {
  bool applied = false;       // texels were changed
  std::uint64_t regions = 0;  // that get another value; for records of pieces, the new records
  std::uint64_t texels = 0;   // that change
  double area_m2 = 0;         // of these texels
  std::uint64_t skipped_texels = 0;  // that were edited in the meantime
  std::int64_t sequence = 0;         // of the edit; 0 without an edit
  bool provisional = false;
  // For records of pieces: the keys of the new records.
  std::vector<std::int64_t> keys{};
  // The keys whose records have no texels, because others painted their pieces in the meantime.
  std::vector<std::int64_t> unpainted_keys{};
};

// Checks the radius of a majority as clean_up does, so that users need not wait for a job that must
// fail. Checks nothing if the model does not know the size of its texels.
Result<void> check_radius(const Model& model, const Layer& layer, const Cleanup& cleanup);

// Changes the layer. Refuses a locked layer (403), a radius that is too large and layers with
// different resolutions (422).
Result<CleanupResult> clean_up(const Services& services, room::Room& room, const Layer& layer,
                               const Cleanup& cleanup, const CleanupEdit& edit, Progress& progress);

// A layer with everything that an operation on its regions reads. The memory for the operation is
// reserved while this object exists.
struct RegionSource {
  Layer layer;
  TileMap tiles;
  std::shared_ptr<const mesh::SurfaceMap> map;
  std::shared_ptr<const mesh::TexelGraph> graph;
  double metres_per_unit = 1;
  MemoryLedger::Share memory;

  query::SurfaceValues values() const {
    return query::read_surface_values(tiles, layer.type, *map);
  }
};
Result<RegionSource> region_source(const Services& services, room::Room& room, LayerId layer);

// Checks that regions of `source` can be shown on the painted layer: the layers have the same
// resolution, and users who see the painted layer may also see the source. The error names `field`.
Result<void> check_can_show(const Layer& painted, const Layer& source, const std::string& field);

// Submits the patch as an edit of the layer. `result` contains the regions and keys, which the
// journal stores for find_saved.
Result<CleanupResult> apply_patch(const Services& services, room::Room& room,
                                  const RegionSource& target, query::TexelPatch patch,
                                  CleanupResult result, const CleanupEdit& edit,
                                  Progress& progress);

// Returns the result of the edit if the journal contains it. This is possible even if the edit
// returned an Error, because a commit can succeed although its confirmation is lost.
// `skipped_texels` and `unpainted_keys` are empty, because the journal does not contain them.
// Refuses (422, `Idempotency-Key`) the id of an edit with another record.
Result<std::optional<CleanupResult>> find_saved(const Services& services, ModelId model,
                                                const CleanupEdit& edit);

}  // namespace strata::app
