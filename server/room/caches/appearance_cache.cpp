#include "room/caches/appearance_cache.h"

#include <algorithm>

#include "domain/people/question.h"
#include "mesh/parallel.h"
#include "mesh/texels/texel_owners.h"

namespace strata::room {
namespace {

constexpr std::uint64_t kBytesPerTexel = sizeof(std::uint32_t);
// The triangle and the weights of mesh::TexelOwners, and the result.
constexpr std::uint64_t kBytesPerTexelOfMaking = 3 * sizeof(std::uint32_t);

bool has_vertex_colors(const mesh::Geometry& geometry) {
  constexpr std::uint32_t kRgb = 0xffffffu;
  return std::ranges::any_of(geometry.vertices, [&](const mesh::Vertex& vertex) {
    return (vertex.color & kRgb) != (geometry.vertices.front().color & kRgb);
  });
}

// A JPEG has no alpha.
bool covers(const SurfaceImage& image) {
  return image.media_type == "image/jpeg" && image.opacity >= 1;
}

// Removes everything that an image without transparency covers.
void remove_covered(AppearanceCache::Sources& sources) {
  auto& images = sources.images;
  const auto top = std::find_if(images.rbegin(), images.rend(), covers);
  if (top == images.rend()) return;
  sources.vertices = false;
  images.erase(images.begin(), std::prev(top.base()));
}

}  // namespace

Result<AppearanceCache::Texels> AppearanceCache::normals(const mesh::SurfaceMap& map) {
  return find_or_make(
      std::to_string(map.resolution) + " normals", map, [&]() -> Result<query::TexelAppearance> {
        const auto owners =
            STRATA_TRY(mesh::bake_texel_owners(*geometry_, map.resolution, progress_));
        return query::normals_of_texels(geometry_, owners, progress_, mesh::background_threads());
      });
}

Result<AppearanceCache::Texels> AppearanceCache::colors(const mesh::SurfaceMap& map,
                                                        Sources sources, const ReadImage& read) {
  if (sources.images.empty() && !has_vertex_colors(*geometry_))
    return fail(ErrorCode::invalid, "Model has no colors",
                "The model has no colors and shows no surface image. Add a surface image.");
  sources.vertices = sources.vertices && has_vertex_colors(*geometry_);
  remove_covered(sources);
  std::string key = std::to_string(map.resolution) + (sources.vertices ? " vertices" : "");
  for (const SurfaceImage& image : sources.images)
    key += " " + image.sha256 + " " + std::to_string(image.opacity);
  return find_or_make(key, map, [&] { return make_colors(map, sources, read); });
}

Result<query::TexelAppearance> AppearanceCache::make_colors(const mesh::SurfaceMap& map,
                                                            const Sources& sources,
                                                            const ReadImage& read) {
  const int threads = mesh::background_threads();
  query::TexelAppearance colors;
  if (sources.vertices) {
    const auto owners = STRATA_TRY(mesh::bake_texel_owners(*geometry_, map.resolution, progress_));
    colors = STRATA_TRY(query::vertex_colors_of_texels(*geometry_, owners, progress_, threads));
  } else {
    colors.resize(map.block_of_slot.size() * 64);
  }
  for (const SurfaceImage& image : sources.images) {
    auto held = STRATA_TRY(read(image, map.resolution));
    const auto opacity = static_cast<float>(image.opacity);
    STRATA_TRY(query::draw_over(colors, std::move(held.picture), opacity, map, progress_, threads));
  }
  return colors;
}

AppearanceCache::Texels AppearanceCache::find(const std::string& key) {
  std::lock_guard lock(mutex_);
  const auto found = std::ranges::find(entries_, key, &Entry::key);
  if (found == entries_.end()) return nullptr;
  entries_.splice(entries_.end(), entries_, found);
  return found->texels;
}

Result<AppearanceCache::Texels> AppearanceCache::find_or_make(const std::string& key,
                                                              const mesh::SurfaceMap& map,
                                                              const Make& make) {
  if (auto known = find(key)) return known;
  const Question::Aside aside;  // questions of other users use the result, too
  std::lock_guard making(making_);
  if (auto known = find(key)) return known;
  const std::uint64_t texels_in_map = map.block_of_slot.size() * 64;
  auto share = STRATA_TRY(
      memory_.reserve(texels_in_map * kBytesPerTexelOfMaking, "the colors of a model's texels"));
  auto made = STRATA_TRY(make());
  share.recount(texels_in_map * kBytesPerTexel);
  auto texels = std::make_shared<const query::TexelAppearance>(std::move(made));
  std::lock_guard lock(mutex_);
  if (entries_.size() >= kMaxEntries) entries_.pop_front();
  entries_.push_back({key, texels, std::move(share)});
  return texels;
}

bool AppearanceCache::drop() {
  std::list<Entry> gone;
  std::lock_guard lock(mutex_);
  gone.swap(entries_);
  return !gone.empty();
}

}  // namespace strata::room
