#include "app/figures/figure_file.h"

#include <algorithm>

#include "core/text/number_text.h"
#include "core/uuid.h"
#include "domain/scene/model.h"

namespace strata::app {
namespace {

std::string file_name(const FigureRequest& request, std::optional<double> scale) {
  const std::string text = !scale        ? ""
                           : *scale >= 1 ? "-1-" + short_number(*scale)
                                         : "-" + short_number(1 / *scale) + "-1";
  return request.room->model().slug + "-" + request.from + text +
         std::string(figure::extension(request.format));
}

std::shared_ptr<TemporaryFile> new_file(const FigureRequest& request, std::optional<double> scale,
                                        const std::filesystem::path& folder) {
  auto file = std::make_shared<TemporaryFile>();
  file->path = folder / (to_string(random_uuid()) + ".figure");
  file->name = file_name(request, scale);
  file->media_type = figure::media_type(request.format);
  return file;
}

}  // namespace

ChosenSheet choose_sheet(const FigureRequest& request, const std::vector<figure::Legend>& legends,
                         const std::vector<figure::ViewSize>& views) {
  std::optional<ChosenSheet> best;
  for (const bool landscape : {false, true}) {
    if (request.landscape && *request.landscape != landscape) continue;
    if (request.sheet_mm && landscape) break;
    figure::SheetLayout layout(
        request.sheet_mm.value_or(figure::paper_mm(request.paper, landscape)), request.captions,
        legends, request.dpi, request.sheet_mm ? 0 : figure::SheetLayout::kMargin_mm);
    auto arranged = layout.arrange(views, request.scale);
    if (best && std::pair(arranged.scale, arranged.tightness) >=
                    std::pair(best->views.scale, best->views.tightness))
      continue;
    best = ChosenSheet{std::move(layout), std::move(arranged)};
  }
  return std::move(*best);
}

Result<std::shared_ptr<const TemporaryFile>> write_figure_file(
    const FigureRequest& request, const figure::Sheet& sheet, const Picture& picture,
    std::optional<double> scale, const std::filesystem::path& folder, Progress& progress) {
  auto file = new_file(request, scale, folder);
  const figure::Document document{request.captions.title, request.captions.credit};
  STRATA_TRY(figure::write_figure(sheet, picture, request.dpi, request.format, document, file->path,
                                  progress));
  file->bytes = std::filesystem::file_size(file->path);
  return file;
}

Result<std::shared_ptr<const TemporaryFile>> write_dxf_file(const FigureRequest& request,
                                                            const figure::DxfDrawing& drawing,
                                                            const std::filesystem::path& folder,
                                                            const Progress& progress) {
  auto file = new_file(request, drawing.scale, folder);
  STRATA_TRY(figure::write_dxf(drawing, file->path, progress));
  file->bytes = std::filesystem::file_size(file->path);
  return file;
}

}  // namespace strata::app
