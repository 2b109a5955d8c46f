#pragma once

#include "app/figures/figures.h"
#include "figure/files.h"
#include "figure/write_dxf.h"

namespace strata::app {

// The sheet and the file of a figure.

struct ChosenSheet {
  figure::SheetLayout layout;
  figure::SheetLayout::Arrangement views;
};
// Chooses the orientation that allows the larger scale, or portrait if both are equal. Uses the
// requested scale or the largest scale at which the views fit.
ChosenSheet choose_sheet(const FigureRequest& request, const std::vector<figure::Legend>& legends,
                         const std::vector<figure::ViewSize>& views);

// Writes the sheet to a file with a name such as "pot-front-1-5.pdf". Without `scale`, the name has
// no scale.
Result<std::shared_ptr<const TemporaryFile>> write_figure_file(
    const FigureRequest& request, const figure::Sheet& sheet, const Picture& picture,
    std::optional<double> scale, const std::filesystem::path& folder, Progress& progress);

// Writes a drawing for CAD programs to such a file.
Result<std::shared_ptr<const TemporaryFile>> write_dxf_file(const FigureRequest& request,
                                                            const figure::DxfDrawing& drawing,
                                                            const std::filesystem::path& folder,
                                                            const Progress& progress);

}  // namespace strata::app
