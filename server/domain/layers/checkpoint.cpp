#include "domain/layers/checkpoint.h"

#include <algorithm>
#include <ranges>
#include <vector>

#include "domain/layers/mask_texels.h"
#include "domain/layers/tile_difference.h"

namespace strata {
namespace {

TileData empty_like(const TileData& tile) {
  TileData empty;
  empty.values.resize(tile.values.size());
  return empty;
}

// Copies the texels of a difference. `copy_texels` is for tiles: it clears the value of an invalid
// texel, but the difference of two valid texels is not valid.
void copy_differences(const TileData& from, const TileMask& mask, TileData& to) {
  for (int w = 0; w < kMaskWords; ++w)
    to.valid.words[w] =
        (to.valid.words[w] & ~mask.words[w]) | (from.valid.words[w] & mask.words[w]);
  const auto width = static_cast<std::size_t>(from.texel_bytes());
  for_each_texel(mask, [&](int texel) {
    const std::size_t at = static_cast<std::size_t>(texel) * width;
    std::copy_n(&from.values[at], width, &to.values[at]);
  });
}

struct Resolved {
  TileData tile;
  TileMask found;  // texels that an edit in force wrote
  TileData after;
  bool operator==(const Resolved&) const = default;
};

// Resolves all texels of a tile that is `before` before the revisions.
Resolved resolve(std::span<const PastRevision> revisions, const TileData& before) {
  Resolved resolved{{}, {}, before};
  for (const PastRevision& each : revisions) apply(each.revision, resolved.after);
  TileMask all;
  all.words.fill(~std::uint64_t{0});
  TileResolver resolver(resolved.after, all);
  for (const PastRevision& each : std::views::reverse(revisions)) {
    PastRevision marked = each;
    marked.provisional = true;
    resolver.add(marked);
  }
  resolved.found = resolver.provisional();
  resolved.tile = std::move(resolver).finish();
  return resolved;
}

}  // namespace

Checkpoint join_revisions(std::span<const PastRevision> revisions) {
  const TileRevision& first = revisions.front().revision;
  TileRevision total{first.address, {}, empty_like(first.difference)};
  TileRevision written = total;
  for (const PastRevision& each : revisions) {
    apply(each.revision, total.difference);
    if (!each.writer || !each.in_force) continue;
    for (int w = 0; w < kMaskWords; ++w) written.written.words[w] |= each.revision.written.words[w];
    copy_differences(total.difference, each.revision.written, written.difference);
  }
  TileRevision rest = total;
  apply(written, rest.difference);
  rest.written = differing(rest.difference, empty_like(rest.difference));
  Checkpoint checkpoint;
  if (rest.written.any()) checkpoint.rest = std::move(rest);
  if (written.written.any()) checkpoint.written = std::move(written);
  return checkpoint;
}

bool is_equivalent(std::span<const PastRevision> revisions, const Checkpoint& checkpoint) {
  std::vector<PastRevision> joined;
  if (checkpoint.written) joined.push_back({0, true, true, false, *checkpoint.written});
  if (checkpoint.rest) joined.push_back({0, true, false, false, *checkpoint.rest});
  // The tile before the revisions is not known. A resolver ignores the values of invalid texels.
  // For each texel, one of these two tiles makes it valid at the revision that counts.
  TileData empty = empty_like(revisions.front().revision.difference), full = empty;
  full.valid.words.fill(~std::uint64_t{0});
  return resolve(revisions, empty) == resolve(joined, empty) &&
         resolve(revisions, full) == resolve(joined, full);
}

}  // namespace strata
