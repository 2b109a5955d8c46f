#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "mesh/io/input_files.h"
#include "mesh/surface/triangle_mesh.h"

namespace strata::mesh {

// Collects the images named by the materials of a file into TriangleMesh::textures, each image
// once. Images that were not uploaded or cannot be read are listed by name in `repairs`.
class TextureLoader {
 public:
  TextureLoader(const InputFiles& files, TriangleMesh& mesh, std::vector<Repair>& repairs)
      : files_(files), mesh_(mesh), repairs_(repairs) {}

  // Returns the texture of a file by the reference of another file, or −1.
  int of_file(std::string_view reference);
  // Returns the texture of an image inside the mesh file, or −1.
  int of_bytes(const std::string& name, std::vector<std::uint8_t> bytes);
  void missing(std::string_view reference);

 private:
  const InputFiles& files_;
  TriangleMesh& mesh_;
  std::vector<Repair>& repairs_;
  std::map<std::string, int, std::less<>> known_;  // by reference
  std::map<const void*, int> of_entry_;
};

// Uses the only uploaded image as the texture of a mesh that has texture coordinates but names no
// image.
void adopt_lone_picture(const InputFiles& files, TriangleMesh& mesh, std::vector<Repair>& repairs);

// A texture named NAME.<UDIM>.EXT means the tiles 1001, 1002 and so on. The unit square (i, j)
// of the texture coordinates is in the file of tile 1001 + i + 10 j. Such a material is replaced by
// one material for each tile that a triangle uses.
class UdimTiles {
 public:
  static bool is_pattern(std::string_view reference);
  // `references` has the texture of each material, or an empty string for a material without a
  // texture.
  static void resolve(TextureLoader& shelf, const std::vector<std::string>& references,
                      TriangleMesh& mesh);
};

}  // namespace strata::mesh
