#pragma once

#include "app/figures/figures.h"
#include "figure/files.h"
#include "figure/write_dxf.h"

namespace strata::app {

// The parts of a figure that are the same for drawings and rollouts.

struct ChosenSheet {
  figure::SheetLayout layout;
  double scale;
  double tightness;  // n of the largest scale 1 : n at which the drawing fits
};
// Chooses the orientation that allows the larger scale, or portrait if both are equal. Uses the
// requested scale or the largest scale at which `size` (in model units) fits. `border_mm` of the
// area of the drawing stays empty on each side.
ChosenSheet choose_sheet(const FigureRequest& request, const std::vector<figure::Legend>& legends,
                         const glm::dvec2& size, double metres_per_unit,
                         const glm::dvec2& border_mm = glm::dvec2(0));

// Writes the sheet to a file with a name such as "pot-front-1-5.pdf".
Result<std::shared_ptr<const TemporaryFile>> write_figure_file(const FigureRequest& request,
                                                               const figure::Sheet& sheet,
                                                               const Picture& picture, double scale,
                                                               const std::filesystem::path& folder,
                                                               Progress& progress);

// Writes a drawing for CAD programs to such a file.
Result<std::shared_ptr<const TemporaryFile>> write_dxf_file(const FigureRequest& request,
                                                            const figure::DxfDrawing& drawing,
                                                            const std::filesystem::path& folder,
                                                            const Progress& progress);

}  // namespace strata::app
