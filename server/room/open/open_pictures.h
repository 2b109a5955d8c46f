#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "room/open/open_room.h"
#include "room/pictures.h"

namespace strata::room {

// Draws each image once, in a separate view.
class OpenRoom::PicturesPart final : public Pictures {
 public:
  explicit PicturesPart(OpenRoom& room) : room_(room) {}
  Result<void> draw(const PictureRequest& request, std::span<const PicturePart> parts,
                    const SeePicture& see) override;
  Result<std::vector<std::optional<std::uint32_t>>> seen_keys(const std::string& layer,
                                                              const Camera& camera, int columns,
                                                              int rows, At at) override;
  Result<std::vector<query::SeenLayer>> seen_layers(const std::vector<std::string>& layers,
                                                    const std::vector<query::LayerCover>& covers,
                                                    const Camera& camera, int columns, int rows,
                                                    At at) override;

 private:
  // Draws one image. The camera and the size in `request` are not set.
  Result<void> draw_in_bands(render::FrameRequest request, const PicturePart& part,
                             std::size_t number, const SeePicture& see);

  OpenRoom& room_;
};

}  // namespace strata::room
