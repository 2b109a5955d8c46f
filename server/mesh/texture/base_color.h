#pragma once

#include <optional>

#include "core/memory_ledger.h"
#include "core/progress.h"
#include "media/picture.h"
#include "mesh/atlas/atlas.h"
#include "mesh/surface/triangle_mesh.h"

namespace strata::mesh {

constexpr int kMaxBaseColor = 16384;

// A picture of the surface on its atlas, encoded.
struct BaseColor {
  PictureFormat format = PictureFormat::jpeg;  // or PNG
  int width = 0, height = 0;
  std::vector<std::uint8_t> bytes;
};

// Combines all materials, textures and UDIM tiles of a mesh into one picture on its atlas.
//
// If the file's own texture coordinates were kept and there is only one texture, its bytes are
// unchanged (TIFF, WebP, BMP and TGA become a PNG of the same pixels); if triangles were moved,
// their pixels are added. Otherwise every texel of the surface is sampled from its triangle's
// texture, at a size that keeps the textures' density (256…kMaxBaseColor a side; a power of two up
// to 2048, then a multiple of 1024), multiplied by the material's color, and with
// colors_tint_materials the vertices'. The picture continues around the surface, so that coarser
// levels do not bleed. JPEG if all textures are.
//
// If pixels are lost, because the textures together exceed the largest picture, or `memory` has not
// enough room, or some are much denser than others, `repairs` lists the original and the kept size.
// Nothing if the mesh has one color only, which is applied to its vertices, or vertex colors that
// no texture hides. Textures that cannot be decoded are noted in `repairs`, and their triangles are
// treated as without a texture. The textures' bytes are removed from the mesh.
//
// Memory: about 6 bytes a texel of the picture and 4 a pixel of the largest texture, reserved in
// `memory` (null: not counted). Refused when cancelled, and if `memory` has no room for the
// smallest picture. Any thread; uses two.
Result<std::optional<BaseColor>> bake_base_color(TriangleMesh& mesh, const Atlas& atlas,
                                                 std::vector<Repair>& repairs, Progress& progress,
                                                 MemoryLedger* memory = nullptr);

}  // namespace strata::mesh
