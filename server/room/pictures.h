#pragma once

#include <chrono>
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
  // exactly these, by slug; nothing: the visible ones
  std::optional<std::vector<std::string>> layers{};
  ViewSettings shown{};
  At at{};  // of the layers
  // With `at`, by layer: texels that waited for review then, which are hatched. Without `at`, those
  // that wait now are hatched.
  std::map<LayerId, TileMap> provisional{};
  bool on_floor = true;  // with the model's contact shadow, in the light that has one
  int samples = 1;       // of each pixel: render::FrameRequest::samples
  // of each band of 2 million pixels: render::FrameRequest::samples_time
  std::chrono::milliseconds samples_time{0};
  Role seen_by = Role::owner;  // columns that it does not see affect neither drawing nor colors
};

// A camera with a separate picture, which has `pixels` pixels for each one of the camera's window.
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

// Pictures of an open model for scripts and figures. Blocks. Thread-safe.
class Pictures {
 public:
  virtual ~Pictures() = default;
  // Draws pictures as RGBA8, top row first; waits for the surface images that they show. `see`
  // receives each picture in turn, in bands of its whole width from the top, and may end it with an
  // Error: a large picture is never in memory as a whole, and between its bands, other requests are
  // drawn. With `at`, all bands show one state, even during painting.
  virtual Result<void> draw(const PictureRequest& request, std::span<const PicturePart> parts,
                            const SeePicture& see) = 0;
  // Draws one picture as a file.
  Result<std::vector<std::uint8_t>> draw_file(const PictureRequest& request, const Camera& camera,
                                              PictureFormat format, JpegSettings jpeg);
  // Returns the visible values of a layer of whole numbers: in the middle of each cell of a grid
  // over the camera's window, row by row from the top left. Nothing: no surface, or no value there.
  virtual Result<std::vector<std::optional<std::uint32_t>>> seen_keys(const std::string& layer,
                                                                      const Camera& camera,
                                                                      int columns, int rows,
                                                                      At at = {}) = 0;
  // Returns the visible parts of layers (bottom to top) in a camera's window; `covers`: one for
  // each layer. See query::seen_layers.
  virtual Result<std::vector<query::SeenLayer>> seen_layers(
      const std::vector<std::string>& layers, const std::vector<query::LayerCover>& covers,
      const Camera& camera, int columns, int rows, At at = {}) = 0;
};

}  // namespace strata::room
