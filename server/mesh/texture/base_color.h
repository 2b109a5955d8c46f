#pragma once

#include <optional>

#include "core/memory_ledger.h"
#include "core/progress.h"
#include "media/picture.h"
#include "mesh/atlas/atlas.h"
#include "mesh/surface/triangle_mesh.h"

namespace strata::mesh {

constexpr int kMaxBaseColor = 16384;

// An encoded image of the surface on its atlas.
struct BaseColor {
  PictureFormat format = PictureFormat::jpeg;  // or PNG
  int width = 0, height = 0;
  std::vector<std::uint8_t> bytes;
};

// Combines all materials, textures and UDIM tiles of a mesh into one image on its atlas.
//
// If the file's own texture coordinates were kept and there is only one texture, its bytes are
// unchanged. TIFF, WebP, BMP and TGA become a PNG with the same pixels. If triangles were moved,
// their pixels are added. Otherwise every texel of the surface is sampled from its triangle's
// texture, at a size that keeps the textures' density. A side has 256…kMaxBaseColor texels: a power
// of two up to 2048, and a multiple of 1024 above. The samples are multiplied by the material's
// color, and with colors_tint_materials also by the vertex colors. The image continues around the
// surface, so coarser levels contain no other colors. It is a JPEG if all textures are JPEGs.
//
// Pixels are lost if the textures together exceed the largest image or `memory` has too little
// room. They are also lost if some textures are much denser than others. `repairs` then lists the
// original and the kept size. The result is empty if the mesh has only one color, which is applied
// to its vertices. The result is also empty if the mesh has vertex colors that no texture hides.
// Black is ignored as the color of a textured material, and as the only color of the mesh.
// Textures that cannot be decoded are noted in `repairs`, and their triangles are treated like
// triangles without a texture. The bytes of the textures are removed from the mesh.
//
// The function needs about 6 bytes per texel of the image and 4 bytes per pixel of the largest
// texture. This memory is reserved in `memory` (null: not counted). Fails when cancelled, and if
// `memory` has no room for the smallest image. Can be called on any thread, and uses two threads.
Result<std::optional<BaseColor>> bake_base_color(TriangleMesh& mesh, const Atlas& atlas,
                                                 std::vector<Repair>& repairs, Progress& progress,
                                                 MemoryLedger* memory = nullptr);

}  // namespace strata::mesh
