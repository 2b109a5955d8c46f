#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/ids.h"
#include "domain/layers/tile_mirror.h"
#include "domain/people/role.h"
#include "domain/scene/camera.h"
#include "media/picture.h"
#include "query/sampling/seen_layers.h"
#include "room/at.h"
#include "room/view_settings.h"

namespace strata::room {

struct PictureRequest {
  // exactly these, by slug; nothing: those that are visible
  std::optional<std::vector<std::string>> layers{};
  ViewSettings shown{};
  At at{};  // of the layers
  // With `at`, by layer: what waited for review then, and is hatched. Without, what waits now is.
  std::map<LayerId, TileMap> provisional{};
  Role seen_by = Role::owner;  // columns that it does not see neither draw nor colour
};

// A camera with a picture of its own, which has so many pixels to one of its window's.
struct PicturePart {
  Camera camera;
  double pixels = 1;
};

struct PictureBand {
  int width = 0, height = 0;  // of the whole picture
  int top = 0, rows = 0;      // of the band
  std::span<const std::uint8_t> rgba;
};
using SeePicture = std::function<Result<void>(std::size_t part, const PictureBand& band)>;

// Pictures of an open model for scripts and sheets, and what they show. Blocks. Thread-safe.
class Pictures {
 public:
  virtual ~Pictures() = default;
  // RGBA8, top row first; waits for the looks that they show. `see` gets each in turn, in bands of
  // its whole width from the top, and may end it with an Error: a large picture is nowhere as a
  // whole, and between its bands others have theirs. With `at` all show one state, also while
  // others paint.
  virtual Result<void> draw(const PictureRequest& request, std::span<const PicturePart> parts,
                            const SeePicture& see) = 0;
  // One, as a file.
  Result<std::vector<std::uint8_t>> draw_file(const PictureRequest& request, const Camera& camera,
                                              PictureFormat format, JpegSettings jpeg);
  // What a layer of whole numbers has where it is seen: in the middle of each cell of a grid over
  // the camera's window, row by row from the top left. Nothing: no surface, or nothing painted
  // there.
  virtual Result<std::vector<std::optional<std::uint32_t>>> seen_keys(const std::string& layer,
                                                                      const Camera& camera,
                                                                      int columns, int rows,
                                                                      At at = {}) = 0;
  // What is seen of layers (bottom to top) over a camera's window; `covers`: one for each. See
  // query::seen_layers.
  virtual Result<std::vector<query::SeenLayer>> seen_layers(
      const std::vector<std::string>& layers, const std::vector<query::LayerCover>& covers,
      const Camera& camera, int columns, int rows, At at = {}) = 0;
};

}  // namespace strata::room
