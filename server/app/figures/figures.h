#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/services.h"
#include "core/byte_budget.h"
#include "core/progress.h"
#include "core/temporary_file.h"
#include "domain/layers/layer.h"
#include "domain/people/role.h"
#include "domain/tables/table.h"
#include "figure/dimension.h"
#include "figure/drawing.h"
#include "figure/files.h"
#include "figure/layout.h"
#include "mesh/rollout/fit_developed_surface.h"
#include "room/pictures.h"
#include "room/room.h"
#include "store/store.h"

namespace strata::app {

// The settings of a figure. The caller has checked the user's request.
struct FigureRequest {
  std::shared_ptr<room::Room> room;  // as visible to the caller
  Role role = Role::viewer;
  room::PictureRequest shown;  // contains the sequence that the whole figure shows
  std::vector<Layer> layers;   // visible layers, from bottom to top
  figure::Plane plane;
  std::string from;                    // "top", "view": part of the file name
  std::optional<glm::dvec3> center{};  // in world coordinates
  // Unrolls the surface instead of drawing it on the plane. Labels, section, hidden parts and light
  // then have no effect.
  struct Rollout {
    mesh::FitRequest fit;
    std::optional<double> cut;  // in radians
    bool relief = true;
  };
  std::optional<Rollout> rollout;
  std::vector<glm::dvec4> section;
  PartSet hidden_parts;
  std::optional<double> scale;
  figure::Paper paper = figure::Paper::a4;
  // A part of a page instead of paper with a margin.
  std::optional<glm::dvec2> sheet_mm{};
  std::optional<bool> landscape;
  int dpi = 300;
  figure::Format format = figure::Format::pdf;
  // Layers of classes and the lines and points of records are vectors whose outlines are at most
  // this distance on paper from the texels. nullopt: they are a part of the picture.
  std::optional<double> outline_tolerance_mm{};
  figure::Captions captions;
  bool legend = true;
  std::string waiting_label;  // label for unreviewed edits in the legend
  // The language of layer and column names in the legend, for names that have a translation. An
  // empty text selects the default names.
  std::string language;
  struct Labels {
    Layer layer;
    Column column;
  };
  std::optional<Labels> labels;
  struct Dimension {
    glm::dvec3 from{0}, to{0};  // in world coordinates
    figure::DimensionDirection direction = figure::DimensionDirection::aligned;
  };
  std::vector<Dimension> dimensions{};
  // Several views on one sheet instead of one. Of a view, the members above that describe the sheet
  // have no effect. `scale` is that of the view only, and `view_title` the text below it.
  std::vector<FigureRequest> views{};
  std::string view_title{};
};

// Draws a figure and writes it to a file in `folder`. Returns 422 for a section that removes the
// whole model, for a DXF file without content, and for a rollout that nothing fits, and 503 if too
// many figures are being created. Blocks.
Result<std::shared_ptr<const TemporaryFile>> make_figure(const Services& services,
                                                         ByteBudget& budget,
                                                         const FigureRequest& request,
                                                         const std::filesystem::path& folder,
                                                         Progress& progress);

}  // namespace strata::app
