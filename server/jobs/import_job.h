#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "core/memory_ledger.h"
#include "core/progress.h"
#include "domain/scene/model.h"
#include "mesh/io/input_files.h"
#include "store/content/idempotent_response.h"
#include "store/store.h"

namespace strata::jobs {

using ImportFile = mesh::InputFile;

struct ImportRequest {
  // One scan: a mesh alone or with the files that it refers to (.mtl, textures, .bin), in any
  // order, or one zip of them. All are stored bit for bit.
  std::vector<ImportFile> files;
  std::string name;  // of the model; empty: from the name of the mesh
  std::string project = "default";
  std::optional<Unit> unit;  // empty: from the file, or else meters, `unit_assumed`
  // values that the file lacks are as proposed (mesh/repair/scale_proposal.h), `unit_assumed`
  bool unit_proposed = false;
  std::string up;  // "" (from the file, or else z) or of kUpDirections
  bool up_proposed = false;
  std::string crs;
  int resolution = 0;        // default of new layers; 0: 2048
  double weld_distance = 0;  // vertices closer than this are joined; in the file's units
  bool strict = false;       // refuse a file that needs repair
};

// Checks everything except the content of the files, before they are uploaded: `invalid` or
// unsupported, with the field's name. Of the files, only the names are checked.
Result<void> check(const ImportRequest& request);

// Files → mesh → atlas → geometry → one transaction, which also stores the caller's answer. All or
// nothing: a bad file or a cancel leaves nothing. The memory of textures while they become the base
// color is reserved in `memory` (null: not counted); if it is insufficient, the base color is
// smaller, and `repairs` reports it.
Result<Model> import_model(store::Store& store, const ImportRequest& request, Progress& progress,
                           const store::IdempotentResponse<Model>& answer = {},
                           MemoryLedger* memory = nullptr);

// Makes the demo project: the pot of mesh::make_demo_pot with two filled layers, `cracks` and
// `pieces` (as in the paper's figure 1), painted by rule on its surface map. Idempotent: returns
// the existing model, if any.
Result<Model> make_demo(store::Store& store, Progress& progress, double detail = 1.0);

}  // namespace strata::jobs
