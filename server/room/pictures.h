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
  // The layers to draw, by slug. nullopt: the visible layers.
  std::optional<std::vector<std::string>> layers{};
  ViewSettings shown{};
  At at{};  // the state of the layers
  // With `at`: by layer, the texels that waited for review at that time. They are drawn hatched.
  // Without `at`, the texels that wait at present are drawn hatched.
  std::map<LayerId, TileMap> provisional{};
  bool marks = true;     // draw the lines and points of records
  bool on_floor = true;  // draw the model's contact shadow, if the light has one
  int samples = 1;       // samples of each pixel (render::FrameRequest::samples)
  // Per band of 2 million pixels: render::FrameRequest::samples_time.
  std::chrono::milliseconds samples_time{0};
  Role seen_by = Role::owner;  // hidden columns affect neither drawing nor colors
};

// A camera with its own image. The image has `pixels` pixels for each pixel of the camera's window.
struct PicturePart {
  Camera camera;
  double pixels = 1;
};

struct PictureBand {
  int width = 0, height = 0;  // size of the whole image
  int top = 0, rows = 0;      // position and size of the band
  std::span<const std::uint8_t> rgba;
};
using SeePicture = std::function<Result<void>(std::size_t part, const PictureBand& band)>;

// Draws images of an open model, for scripts and figures. Blocks. Thread-safe.
class Pictures {
 public:
  virtual ~Pictures() = default;
  // Draws images as RGBA8, with the top row first. Waits for the surface images in them. `see`
  // receives each image in turn, in bands of its whole width from the top. It may return an Error
  // to stop the drawing. A large image is never in memory as a whole, and other requests are drawn
  // between its bands. With `at`, all bands show the same state, even during painting.
  virtual Result<void> draw(const PictureRequest& request, std::span<const PicturePart> parts,
                            const SeePicture& see) = 0;
  // Draws one image and encodes it as a file.
  Result<std::vector<std::uint8_t>> draw_file(const PictureRequest& request, const Camera& camera,
                                              PictureFormat format, JpegSettings jpeg);
  // Returns the visible values of a layer of whole numbers (see query::seen_keys) on a grid over
  // the camera's window. Each value is from the middle of a cell, row by row from the top left. A
  // value is nullopt where there is no surface or no value.
  virtual Result<std::vector<std::optional<std::uint32_t>>> seen_keys(const std::string& layer,
                                                                      const Camera& camera,
                                                                      int columns, int rows,
                                                                      At at = {}) = 0;
  // Returns the visible parts of layers (bottom to top) in a camera's window. `covers` has one
  // element for each layer. See query::seen_layers.
  virtual Result<std::vector<query::SeenLayer>> seen_layers(
      const std::vector<std::string>& layers, const std::vector<query::LayerCover>& covers,
      const Camera& camera, int columns, int rows, At at = {}) = 0;
};

}  // namespace strata::room
