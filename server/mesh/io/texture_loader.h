#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "mesh/io/input_files.h"
#include "mesh/surface/triangle_mesh.h"

namespace strata::mesh {

// Collects the pictures that the materials of a file name, each once, into TriangleMesh::textures.
// What was not sent along or cannot be read is noted in `repairs` by its name.
class TextureLoader {
 public:
  TextureLoader(const InputFiles& files, TriangleMesh& mesh, std::vector<Repair>& repairs)
      : files_(files), mesh_(mesh), repairs_(repairs) {}

  // The texture of a file as another one refers to it, or −1.
  int of_file(std::string_view reference);
  // Of a picture inside the mesh's own file, or −1.
  int of_bytes(const std::string& name, std::vector<std::uint8_t> bytes);
  void missing(std::string_view reference);

 private:
  const InputFiles& files_;
  TriangleMesh& mesh_;
  std::vector<Repair>& repairs_;
  std::map<std::string, int, std::less<>> known_;  // by reference
  std::map<const void*, int> of_entry_;
};

// Where nothing names a picture, but the mesh has texture coordinates and exactly one picture was
// sent along: it is meant.
void adopt_lone_picture(const InputFiles& files, TriangleMesh& mesh, std::vector<Repair>& repairs);

// A texture named NAME.<UDIM>.EXT stands for tiles 1001, 1002 …: unit square (i, j) of the texture
// coordinates is in the file of tile 1001 + i + 10 j. Gives every tile that a triangle uses a
// material of its own, in place of such a material.
class UdimTiles {
 public:
  static bool is_pattern(std::string_view reference);
  // `references`: of each material's texture, empty where it has none.
  static void resolve(TextureLoader& shelf, const std::vector<std::string>& references,
                      TriangleMesh& mesh);
};

}  // namespace strata::mesh
