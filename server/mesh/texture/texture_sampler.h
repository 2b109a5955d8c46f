#pragma once

#include <glm/glm.hpp>

#include "media/picture.h"
#include "mesh/surface/triangle_mesh.h"

namespace strata::mesh {

// Returns an image with half the width and height (at least 1). Each pixel is the mean light of
// four pixels, weighted by their alpha. So the color of transparent pixels, which is often black,
// does not darken the border of an image.
Picture halve(const Picture& picture);

// Halves each side of an image of the atlas that has at least 2 · `side` pixels. Returns false if
// none has. Call it until then, so that a texture with `side` pixels shows the mean of finer
// pixels.
bool halve_toward(Picture& picture, int side);

// A decoded texture with the lookup of a GPU: texel centers at (i + 0.5) / size, UV origin at the
// lower left, bilinear interpolation.
class TextureSampler {
 public:
  explicit TextureSampler(const Picture& picture) : picture_(picture) {}

  // Returns red, green and blue as stored, 0…255.
  glm::vec3 sample(glm::dvec2 uv, Wrap wrap_u, Wrap wrap_v) const {
    return sample_with_alpha(uv, wrap_u, wrap_v);
  }
  // Returns the same colors with alpha. The colors are not multiplied by alpha.
  glm::vec4 sample_with_alpha(glm::dvec2 uv, Wrap wrap_u, Wrap wrap_v) const;

 private:
  glm::vec4 pixel(int x, int y) const {
    const std::uint8_t* p = &picture_.rgba[(static_cast<std::size_t>(y) * picture_.width + x) * 4];
    return {p[0], p[1], p[2], p[3]};
  }

  const Picture& picture_;
};

}  // namespace strata::mesh
