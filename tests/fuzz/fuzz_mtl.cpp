#include <string_view>

#include "fuzz/mesh_invariants.h"
#include "media/picture.h"

// Fuzzes the materials of a fixed OBJ. The input is also the content of their image files.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static constexpr std::string_view kObj =
      "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nvt 0.2 0.3\nvt 1.5 2\nvt 3 0\nusemtl m\nf 1/1 2/2 3/3\nusemtl n o\nf "
      "3/3 2/2 4/1\n";
  strata::Progress progress;
  std::vector<strata::mesh::InputFiles::Entry> entries;
  entries.push_back(
      {"a.obj", {reinterpret_cast<const std::uint8_t*>(kObj.data()), kObj.size()}, std::nullopt});
  for (const char* name : {"a.mtl", "a.png", "skin.1001.jpg"})
    entries.push_back({name, {data, size}, std::nullopt});
  auto files = strata::mesh::InputFiles::of(std::move(entries), "/tmp", progress);
  if (!files) std::abort();
  const auto loaded = strata::mesh::load_mesh(std::move(*files), progress);
  if (!loaded) std::abort();  // a mesh with invalid materials is accepted without them
  strata::test::check_loaded(*loaded);
  if (const auto picture = strata::decode_picture({data, size}, 256);
      picture && picture->rgba.size() != std::size_t(picture->width) * picture->height * 4)
    std::abort();
  return 0;
}
