#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/byte_budget.h"
#include "core/progress.h"
#include "core/temporary_file.h"
#include "domain/layers/layer.h"
#include "domain/people/role.h"
#include "domain/tables/table.h"
#include "figure/files.h"
#include "figure/layout.h"
#include "room/pictures.h"
#include "room/room.h"
#include "store/store.h"

namespace strata::app {

// A figure to draw. All checks of the user's request precede it.
struct FigureRequest {
  std::shared_ptr<room::Room> room;  // as visible to the caller
  Role role = Role::viewer;
  room::PictureRequest shown;  // with the sequence that the whole figure shows
  std::vector<Layer> layers;   // visible layers, bottom to top
  figure::Plane plane;
  std::string from;                    // "top", "view": for the file's name
  std::optional<glm::dvec3> center{};  // world
  std::vector<glm::dvec4> section;
  std::optional<double> scale;
  figure::Paper paper = figure::Paper::a4;
  std::optional<bool> landscape;
  int dpi = 300;
  figure::Format format = figure::Format::pdf;
  figure::Captions captions;
  bool legend = true;
  std::string waiting_label;  // the legend's label for unreviewed edits
  // of the names of layers and columns in the legend, if they have one; empty: the default names
  std::string language;
  struct Labels {
    Layer layer;
    Column column;
  };
  std::optional<Labels> labels;
};

// Draws the figure and writes it to a file in `folder`. Refuses a section that removes the whole
// model (422), or if too many figures are being made (503). Blocks.
Result<std::shared_ptr<const TemporaryFile>> make_figure(store::Store& store, ByteBudget& budget,
                                                         const FigureRequest& request,
                                                         const std::filesystem::path& folder,
                                                         Progress& progress);

}  // namespace strata::app
