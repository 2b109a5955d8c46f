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

// All materials, textures and UDIM tiles of a mesh as one picture on its atlas.
//
// Where the file's own texture coordinates were kept and one texture is all there is, its bytes
// come unchanged (TIFF, WebP, BMP and TGA as a PNG of the same pixels); with triangles that were
// moved, its pixels with theirs added. Otherwise every texel of the surface is sampled from its
// triangle's texture, at a size that keeps the textures' density (256…kMaxBaseColor a side; a
// power of two up to 2048, then a multiple of 1024), times the material's colour, and with
// colors_tint_materials the vertices'; around the surface the picture goes on, so that coarser
// levels do not bleed. JPEG where all textures are.
//
// Where pixels are lost, because textures together have more than the largest picture holds, or
// `memory` has no room for more, or some are much denser than others, `repairs` says how large they
// were and what is kept. Nothing where the mesh has one colour only, which goes to its vertices, or
// vertex colours that no texture hides. Textures that cannot be decoded are noted in `repairs`, and
// their triangles are as if they had none. The textures' bytes are taken out of the mesh on the
// way.
//
// Memory: about 6 bytes a texel of the picture and 4 a pixel of the largest texture, reserved in
// `memory` (null: not counted). Refused when cancelled, and where `memory` has no room for the
// smallest picture. Thread: any; two while it runs.
Result<std::optional<BaseColor>> bake_base_color(TriangleMesh& mesh, const Atlas& atlas,
                                                 std::vector<Repair>& repairs, Progress& progress,
                                                 MemoryLedger* memory = nullptr);

}  // namespace strata::mesh
