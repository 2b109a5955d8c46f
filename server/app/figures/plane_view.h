#pragma once

#include "app/figures/figure_vectors.h"
#include "app/figures/sheet_view.h"
#include "figure/drawing.h"

namespace strata::app {

// A view without perspective.
class PlaneView : public SheetView {
 public:
  // Returns 422 if section and hidden parts remove the whole model.
  static Result<std::unique_ptr<PlaneView>> make(const Services& services, ByteBudget& budget,
                                                 const FigureRequest& request);

  const FigureRequest& request() const override { return request_; }
  figure::ViewSize size() const override;
  void place(const figure::ViewPlace& place) override;
  const figure::ViewPlace& placed() const override { return place_; }
  Result<std::vector<query::SeenLayer>> seen_layers(Progress& progress) const override;
  Result<ViewContent> content(const Stage& stage, Progress& progress) const override;
  Result<void> draw(Picture& sheet, Progress& progress) const override;

  const figure::Drawing& drawing() const { return drawing_; }
  Result<std::vector<figure::Label>> labels() const;
  std::vector<figure::Dimension> dimensions() const;
  Result<FigureVectors> vectors(const Stage& stage, Progress& progress) const;

 private:
  PlaneView(const Services& services, ByteBudget& budget, const FigureRequest& request,
            const figure::Extent& extent);

  const Services& services_;
  ByteBudget& budget_;
  const FigureRequest& request_;
  figure::Drawing drawing_;
  glm::dvec2 size_{0};  // in model units
  figure::ViewPlace place_;
};

}  // namespace strata::app
