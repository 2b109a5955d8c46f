#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "mesh/io/face_builder.h"
#include "mesh/io/ply_header.h"
#include "mesh/texture/vertex_color.h"

namespace strata::mesh {

// The positions of the color channels among the properties of a PLY element. −1 means that the
// channel is missing.
struct PlyColorProperties {
  std::array<int, 4> rgba{-1, -1, -1, -1};
  bool present() const { return rgba[0] >= 0; }
  bool alpha() const { return rgba[3] >= 0; }
};

inline PlyColorProperties find_ply_colors(const PlyElement& element) {
  const auto red = element.find({"red", "diffuse_red", "r"}),
             green = element.find({"green", "diffuse_green", "g"}),
             blue = element.find({"blue", "diffuse_blue", "b"}),
             alpha = element.find({"alpha", "a"});
  PlyColorProperties colors;
  if (!red || !green || !blue) return colors;
  colors.rgba = {*red, *green, *blue, alpha.value_or(-1)};
  for (const int at : colors.rgba) {
    if (at >= 0 && element.properties[at].count_type) return {};
  }
  return colors;
}

// Converts integer colors to 0…255. Real colors are unchanged.
inline double to_byte_scale(PlyType type, double value) {
  return type == PlyType::u16 ? value / 257.0 : value;
}
inline bool is_real(PlyType type) { return type == PlyType::f32 || type == PlyType::f64; }

// The colors of faces, for vertices without colors. A vertex gets the mean color of the surrounding
// faces.
class PlyFaceColors {
 public:
  void begin(std::size_t vertices) { sums_.resize(vertices); }

  void add(const PlyElement& element, const PlyColorProperties& colors,
           const std::vector<double>& values, const std::vector<FaceBuilder::Corner>& corners) {
    const PlyType type = element.properties[colors.rgba[0]].type;
    const double scale = is_real(type) ? 255.0 : 1.0;
    for (const FaceBuilder::Corner& corner : corners) {
      Sum& sum = sums_[corner.position];
      for (int k = 0; k < 4; ++k) {
        const double value =
            k == 3 && !colors.alpha() ? 255.0 : to_byte_scale(type, values[colors.rgba[k]]) * scale;
        sum.rgba[k] +=
            static_cast<float>(std::clamp(std::isfinite(value) ? value : 0.0, 0.0, 255.0));
      }
      sum.faces += 1;
    }
  }

  void spread(LoadedMesh& loaded) {
    for (const Sum& sum : sums_) {
      const float share = sum.faces > 0 ? 1 / sum.faces : 0;
      loaded.mesh.vertex_colors.push_back(pack_color(sum.rgba[0] * share, sum.rgba[1] * share,
                                                     sum.rgba[2] * share, sum.rgba[3] * share));
    }
    note(loaded.repairs, "face colours spread to vertices", sums_.size());
    sums_ = {};
  }

 private:
  struct Sum {
    std::array<float, 4> rgba{};
    float faces = 0;
  };
  std::vector<Sum> sums_;
};

}  // namespace strata::mesh
