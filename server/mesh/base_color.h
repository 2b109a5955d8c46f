#pragma once

#include <optional>

#include "core/picture.h"
#include "core/progress.h"
#include "mesh/atlas.h"
#include "mesh/triangle_mesh.h"

namespace strata::mesh {

constexpr int kLargestBaseColor = 8192;

// A picture of the surface on its atlas, encoded.
struct BaseColor {
  PictureFormat format = PictureFormat::jpeg;
  int width = 0, height = 0;
  std::vector<std::uint8_t> bytes;
};

// All materials, textures and UDIM tiles of a mesh as one picture on its atlas.
//
// Where the file's own texture coordinates were kept and one texture is all there is, its bytes come unchanged. Otherwise every
// texel of the surface is sampled from its triangle's texture, at the power of two that keeps the textures' density
// (256…kLargestBaseColor; finer textures are averaged), times the material's colour, and with colors_tint_materials the
// vertices'; around the surface the picture goes on, so that coarser levels do not bleed. JPEG where all textures are.
//
// Nothing where the mesh has one colour only, which goes to its vertices, or vertex colours that no texture hides. Textures
// that cannot be decoded are noted in `repairs`; their triangles get the material's colour alone. The textures' bytes are
// taken out of the mesh on the way. Refused when cancelled. Thread: any; two while it runs.
Result<std::optional<BaseColor>> bake_base_color(TriangleMesh& mesh, const Atlas& atlas, std::vector<Repair>& repairs,
                                                 Progress& progress);

}  // namespace strata::mesh
