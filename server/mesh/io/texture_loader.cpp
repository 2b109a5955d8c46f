#include "mesh/io/texture_loader.h"

#include <algorithm>
#include <cmath>

#include "core/text/utf8.h"
#include "media/picture.h"
#include "mesh/io/load_formats.h"

namespace strata::mesh {
namespace {

constexpr std::string_view kUdim = "<UDIM>";
constexpr int kMaxUdimColumns = 10, kMaxUdimRows = 100;
constexpr std::size_t kMaxNotes = 200;

std::string printable(std::string_view text) {
  std::string result;
  for (const char c : text.substr(0, 200))
    result += static_cast<unsigned char>(c) < 32 || c == 127 ? '?' : c;
  return mended_utf8(result);
}

}  // namespace

void TextureLoader::missing(std::string_view reference) {
  if (repairs_.size() < kMaxNotes)
    note(repairs_, "texture not among the files: " + printable(reference), 1);
}

int TextureLoader::of_file(std::string_view reference) {
  if (const auto known = known_.find(reference); known != known_.end()) return known->second;
  const auto* entry = files_.find(reference);
  int texture = -1;
  if (!entry) {
    missing(reference);
  } else if (const auto same = of_entry_.find(entry); same != of_entry_.end()) {
    texture = same->second;
  } else {
    texture = of_bytes(entry->name, {entry->bytes.begin(), entry->bytes.end()});
    of_entry_.emplace(entry, texture);
  }
  known_.emplace(reference, texture);
  return texture;
}

int TextureLoader::of_bytes(const std::string& name, std::vector<std::uint8_t> bytes) {
  if (const auto info = inspect_picture(bytes); !info) {
    if (repairs_.size() < kMaxNotes)
      note(repairs_, "texture not read: " + printable(name) + ": " + info.error().detail, 1);
    return -1;
  }
  mesh_.textures.push_back({printable(name), std::move(bytes)});
  return static_cast<int>(mesh_.textures.size()) - 1;
}

void adopt_lone_picture(const InputFiles& files, TriangleMesh& mesh, std::vector<Repair>& repairs) {
  if (mesh.corner_uvs.empty() || !mesh.textures.empty() || mesh.materials.size() > 1) return;
  const InputFiles::Entry* lone = nullptr;
  for (const InputFiles::Entry* entry : files.own()) {
    if (!picture_format(entry->bytes)) continue;
    if (lone) return;
    lone = entry;
  }
  if (!lone || !inspect_picture(lone->bytes)) return;
  mesh.textures.push_back({printable(lone->name), {lone->bytes.begin(), lone->bytes.end()}});
  mesh.materials = {Material{
      .name = mesh.materials.empty() ? std::string() : mesh.materials[0].name, .texture = 0}};
  mesh.triangle_materials.assign(mesh.triangle_count(), 0);
  note(repairs, "texture taken because it is the only picture: " + printable(lone->name), 1);
}

bool UdimTiles::is_pattern(std::string_view reference) {
  return reference.find(kUdim) != std::string_view::npos;
}

void UdimTiles::resolve(TextureLoader& shelf, const std::vector<std::string>& references,
                        TriangleMesh& mesh) {
  if (std::none_of(references.begin(), references.end(), is_pattern)) return;
  for (std::size_t m = 0; m < references.size(); ++m)
    if (is_pattern(references[m])) mesh.materials[m].texture = -1;
  if (mesh.corner_uvs.empty()) return;
  std::map<std::pair<std::uint16_t, int>, std::uint16_t> of_tile;
  for (std::size_t t = 0; t < mesh.triangle_materials.size(); ++t) {
    const std::uint16_t material = mesh.triangle_materials[t];
    if (material == kNoMaterial || material >= references.size() ||
        !is_pattern(references[material]))
      continue;
    const glm::vec2 middle =
        (mesh.corner_uvs[3 * t] + mesh.corner_uvs[3 * t + 1] + mesh.corner_uvs[3 * t + 2]) / 3.0f;
    const int column = static_cast<int>(std::floor(std::clamp(middle.x, -1.0f, 1000.0f))),
              row = static_cast<int>(std::floor(std::clamp(middle.y, -1.0f, 1000.0f)));
    const bool on_grid = column >= 0 && column < kMaxUdimColumns && row >= 0 && row < kMaxUdimRows;
    const int tile = on_grid ? 1001 + column + 10 * row : 0;
    auto found = of_tile.find({material, tile});
    if (found == of_tile.end()) {
      std::uint16_t fresh = kNoMaterial;
      if (tile != 0 && mesh.materials.size() < kNoMaterial) {
        std::string file = references[material];
        file.replace(file.find(kUdim), kUdim.size(), std::to_string(tile));
        Material copy = mesh.materials[material];
        copy.texture = shelf.of_file(file);
        fresh = static_cast<std::uint16_t>(mesh.materials.size());
        mesh.materials.push_back(std::move(copy));
      }
      found = of_tile.emplace(std::pair(material, tile), fresh).first;
    }
    mesh.triangle_materials[t] = found->second;
  }
}

}  // namespace strata::mesh
