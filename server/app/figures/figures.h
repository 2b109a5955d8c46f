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

// A measured figure to draw. Everything that can be wrong with the user's request is checked before
// this is made.
struct FigureRequest {
  std::shared_ptr<room::Room> room;  // as who asks sees it
  Role role = Role::viewer;
  room::PictureRequest shown;  // with the sequence that all of it shows
  std::vector<Layer> layers;   // that are seen, bottom to top
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
  std::string waiting_label;  // what the legend calls what waits for review
  // in which it calls layers and columns that have a name in it; empty: in none
  std::string language;
  struct Labels {
    Layer layer;
    Column column;
  };
  std::optional<Labels> labels;
};

// Draws and writes it; the file lies in `folder`. Refused (422): nothing of the model
// is left by the section; (503): others are being made. Blocks.
Result<std::shared_ptr<const TemporaryFile>> make_figure(store::Store& store, ByteBudget& budget,
                                                         const FigureRequest& request,
                                                         const std::filesystem::path& folder,
                                                         Progress& progress);

}  // namespace strata::app
