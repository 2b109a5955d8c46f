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
  // One scan: a mesh, alone or with the files that it refers to (.mtl, textures, .bin), in any
  // order, or one zip of these files. All files are stored unchanged.
  std::vector<ImportFile> files;
  std::string name;  // of the model; empty: the name of the mesh file
  std::string project = "default";
  std::optional<Unit> unit;  // no value: from the file, or else meters, with `unit_assumed`
  // If the file has no unit, use the proposed one (mesh/repair/scale_proposal.h), with
  // `unit_assumed`.
  bool unit_proposed = false;
  std::string up;  // one of kUpDirections; empty: from the file, or else z
  bool up_proposed = false;
  std::string crs;
  // The name of the object of which the model is a survey, which is created if the project has none
  // with this name, and the date of the survey. Both or neither is empty.
  std::string object, survey_date;
  int resolution = 0;        // default resolution of new layers; 0: 2048
  double weld_distance = 0;  // joins vertices at a smaller distance; in the file's units
  bool strict = false;       // reject a file that needs repair
  // For files with points only, in the file's units; 0: the default (mesh::PointOptions).
  double cell = 0, gap = 0;
  // The files contain several scans, which become the parts of the model (mesh/io/join_parts.h).
  bool parts = false;
};

// Checks a request before the files are uploaded. It checks the names of the files, but not their
// content. Returns the Errors `invalid` or `unsupported` with the name of the field.
Result<void> check(const ImportRequest& request);

// Imports a model: files → mesh → atlas → geometry → one transaction, which also stores the
// caller's response. Stores no data if a file is bad or the import is canceled. The memory of
// textures during the computation of the base color is reserved in `memory` (null: not counted). If
// the memory is insufficient, the base color is smaller, and `repairs` reports this.
Result<Model> import_model(store::Store& store, const ImportRequest& request, Progress& progress,
                           const store::IdempotentResponse<Model>& answer = {},
                           MemoryLedger* memory = nullptr);

// Makes the demo project: the pot of mesh::make_demo_pot with two layers, `cracks` and `pieces` (as
// in figure 1 of the paper). DemoRules fills the layers. Idempotent: returns the existing model, if
// there is one.
Result<Model> make_demo(store::Store& store, Progress& progress, double detail = 1.0);

}  // namespace strata::jobs
