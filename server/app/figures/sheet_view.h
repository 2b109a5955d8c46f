#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "app/figures/figures.h"
#include "app/services.h"
#include "query/sampling/seen_layers.h"

namespace strata::app {

// The part of a task, as for Progress::begin_stage.
struct Stage {
  double from = 0, to = 1;
  Stage part(std::size_t index, std::size_t count) const {
    const double step = (to - from) / static_cast<double>(count);
    return {from + step * static_cast<double>(index), from + step * static_cast<double>(index + 1)};
  }
};

// What a view shows in addition to its picture.
struct ViewContent {
  std::optional<glm::dvec2> north{};
  std::vector<figure::Label> labels{};
  std::vector<figure::Group> below{};  // of everything but the picture
  std::vector<figure::Group> above{};  // of everything
  std::shared_ptr<const void> held{};  // the part of the budget that the content uses
};

// A view on a sheet: a drawing on a plane, or a rollout. The request must exist as long as the
// view. All functions may block.
class SheetView {
 public:
  virtual ~SheetView() = default;

  virtual const FigureRequest& request() const = 0;
  virtual figure::ViewSize size() const = 0;

  // Sets the place of the view. All functions below need it.
  virtual void place(const figure::ViewPlace& place) = 0;
  virtual const figure::ViewPlace& placed() const = 0;
  // Returns the visible layers, with one element for each layer of the request.
  virtual Result<std::vector<query::SeenLayer>> seen_layers(Progress& progress) const = 0;
  virtual Result<ViewContent> content(const Stage& stage, Progress& progress) const = 0;
  // Draws the view at its place in the picture of the sheet.
  virtual Result<void> draw(Picture& sheet, Progress& progress) const = 0;
};

}  // namespace strata::app
