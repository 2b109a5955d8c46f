#pragma once

#include "figure/files.h"
#include "figure/layout.h"
#include "jobs/job_queue.h"
#include "net/api/routes.h"
#include "net/byte_budget.h"
#include "net/serialization/wire.h"

namespace strata::net {

// A measured figure as it was asked for: everything that can be wrong with it is found out before
// it is drawn.
struct FigureWish {
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

// Refused (422): a view and what stands in its place, two directions, a normal without one, labels
// of what holds no keys.
Result<FigureWish> figure_wish(const RouteContext& context, const Request& request);

// Draws and writes it; the file lies in the folder for uploads. Refused (422): nothing of the model
// is left by the section; (503): others are being made. Blocks.
Result<std::shared_ptr<const jobs::JobFile>> make_figure(const RouteContext& context,
                                                         ByteBudget& budget, const FigureWish& wish,
                                                         Progress& progress);

}  // namespace strata::net
