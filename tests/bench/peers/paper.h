#pragma once

#include <memory>

#include "domain/scene/stroke.h"
#include "gl/framebuffer.h"
#include "gl/program.h"
#include "gl/vertex_array.h"
#include "mesh/surface/geometry.h"

namespace strata::bench {

// The "small bias" of the paper, in window depth; the paper gives no number. With a camera whose
// near and far planes are as close to the model as in `look_at`, this is 1.6 % of the model's
// radius. A bias of 2e-4 would reject parts of every surface with a tilt of more than 13 degrees,
// because the depth varies by more than this bias within a pixel. The edit would be speckled, and
// rounding at its many thresholds would decide 3 to 11 of 100 000 texels.
constexpr double kPaperDepthBias = 5e-3;

// The paper's method, implemented literally. The Texture Editing Algorithm draws the whole mesh at
// its texture coordinates into data, mask and edited-area textures. It discards fragments that fail
// the window test, the depth test (with a fixed bias) or the tool test. Then the Texture Padding
// Algorithm filters the whole texture and sets the outline texels next to the edited area; the
// outline is 1 texel wide. Two passes make the outline mask when the model is loaded. A formula
// defines the tool as a disc. The map from window to tool is derived here, because the printed
// translation factor has the wrong sign and lacks ½. Each edit is one dab with values of 8 bits.
// The published padding is a raster pass; the alternative is a compute pass, because only a few
// multiprocessors of GPUs such as the H100 rasterize. All functions run on the GPU thread only.
class PaperEditor {
 public:
  enum class Padding { raster, compute };
  static Result<std::unique_ptr<PaperEditor>> create(const mesh::Geometry& geometry,
                                                     int resolution);

  // `depth` is the system's depth texture: the depth of the mesh from this camera, in the size of
  // its window.
  void edit(const Camera& camera, const gl::Texture& depth, glm::dvec2 center, double radius_px,
            std::uint8_t value, Padding padding = Padding::raster);
  void clear();

  int resolution() const { return resolution_; }
  std::vector<std::uint8_t> data() const { return read(data_); }
  std::vector<std::uint8_t> mask() const { return read(mask_); }
  // Returns 1 where the parametrization has texels.
  std::vector<std::uint8_t> coverage() const { return read(coverage_); }
  std::uint64_t layer_bytes() const { return data_.bytes() + mask_.bytes(); }
  // The bytes that one resolution needs in addition to its layers.
  std::uint64_t structure_bytes() const { return edited_.bytes() + outline_.bytes(); }

 private:
  static std::vector<std::uint8_t> read(const gl::Texture& texture);
  void draw_mesh(const gl::Framebuffer& target) const;
  void draw_texture(const gl::Framebuffer& target) const;
  Result<void> make_textures();
  void make_outline();

  int resolution_ = 0;
  GLsizei index_count_ = 0;
  glm::dvec3 origin_{0};
  std::uint32_t edit_number_ = 0;
  gl::Buffer vertices_, indices_;
  gl::VertexArray mesh_array_, empty_array_;
  gl::Texture data_, mask_, edited_, coverage_, outline_;
  gl::Framebuffer editing_, padding_, coverage_target_, outline_target_;
  gl::Program cover_, outline_pass_, texture_editing_, texture_padding_, compute_padding_;
};

}  // namespace strata::bench
