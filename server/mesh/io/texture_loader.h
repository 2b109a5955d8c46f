#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "mesh/io/input_files.h"
#include "mesh/surface/triangle_mesh.h"

namespace strata::mesh {

// Collects the pictures that the materials of a file name, each once, into TriangleMesh::textures.
// Pictures that were not uploaded or cannot be read are listed by name in `repairs`.
class TextureLoader {
 public:
  TextureLoader(const InputFiles& files, TriangleMesh& mesh, std::vector<Repair>& repairs)
      : files_(files), mesh_(mesh), repairs_(repairs) {}

  // The texture of a file, by the reference of another file, or −1.
  int of_file(std::string_view reference);
  // The texture of a picture inside the mesh's own file, or −1.
  int of_bytes(const std::string& name, std::vector<std::uint8_t> bytes);
  void missing(std::string_view reference);

 private:
  const InputFiles& files_;
  TriangleMesh& mesh_;
  std::vector<Repair>& repairs_;
  std::map<std::string, int, std::less<>> known_;  // by reference
  std::map<const void*, int> of_entry_;
};

// Uses the only uploaded picture as the texture of a mesh that has texture coordinates but names no
// picture.
void adopt_lone_picture(const InputFiles& files, TriangleMesh& mesh, std::vector<Repair>& repairs);

// A texture named NAME.<UDIM>.EXT means tiles 1001, 1002 …: unit square (i, j) of the texture
// coordinates is in the file of tile 1001 + i + 10 j. Replaces such a material by one material for
// each tile that a triangle uses.
class UdimTiles {
 public:
  static bool is_pattern(std::string_view reference);
  // `references`: the texture of each material, empty without one.
  static void resolve(TextureLoader& shelf, const std::vector<std::string>& references,
                      TriangleMesh& mesh);
};

}  // namespace strata::mesh
