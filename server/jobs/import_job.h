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
  // One scan: a mesh alone or with what it refers to (.mtl, textures, .bin), in any order, or one
  // zip of them. All are kept bit for bit.
  std::vector<ImportFile> files;
  std::string name;  // of the model; empty: from the name of the mesh
  std::string project = "default";
  std::optional<Unit> unit;  // empty: as the file says, or else metres, `unit_assumed`
  // what the file does not say is as proposed (mesh/repair/scale_proposal.h), `unit_assumed`
  bool unit_proposed = false;
  std::string up;  // "" (as the file says, or else z) or of kUpDirections
  bool up_proposed = false;
  std::string crs;
  int resolution = 0;        // default of new layers; 0: 2048
  double weld_distance = 0;  // vertices that lie nearer than this are joined; in the file's units
  bool strict = false;       // refuse a file that needs repair
};

// Whether everything but the files' content can be used, before they travel: `invalid` or
// unsupported, with the field's name. Only the files' names are looked at.
Result<void> check(const ImportRequest& request);

// Files → mesh → atlas → geometry → one transaction, which also keeps the caller's answer.
// Everything or nothing: a bad file or a cancel leaves nothing behind. What textures take while
// they become the base colour is reserved in `memory` (null: not counted); where it has no room the
// base colour is smaller, and `repairs` says so.
Result<Model> import_model(store::Store& store, const ImportRequest& request, Progress& progress,
                           const store::IdempotentResponse<Model>& answer = {},
                           MemoryLedger* memory = nullptr);

// The demo project: the pot of mesh::make_demo_pot with two filled layers, `cracks` and `pieces`
// (as in the paper's figure 1), painted by rule on its surface map. Idempotent: returns the model
// there already is.
Result<Model> make_demo(store::Store& store, Progress& progress, double detail = 1.0);

}  // namespace strata::jobs
