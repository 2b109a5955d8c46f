#pragma once

#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <vector>

#include "mesh/buckets.h"
#include "mesh/surface/geometry.h"
#include "mesh/surface/uv_islands.h"
#include "mesh/texels/surface_map.h"
#include "mesh/texels/texel_raster.h"

namespace strata::mesh {

// The data stored for each texel: its position and area, or its triangle and the position there.
enum class BakeFor { map, owners };

// The steps of baking a surface map. Work is divided into fixed horizontal bands of the atlas, so
// the result does not depend on the assignment to threads. Within a band, triangles are in
// ascending order. For BakeFor::owners the steps end with place_gutter, and the positions, areas
// and sums of the map stay empty.
class SurfaceBake {
 public:
  SurfaceBake(const Geometry& geometry, int resolution, SurfaceMap& map,
              BakeFor purpose = BakeFor::map);

  int band_count() const { return band_count_; }

  void mark_surface(int band);     // marks surface texels in the masks of all blocks
  void mark_gutter(int band);      // after mark_surface of all bands
  void assign_slots(int threads);  // after mark_gutter of all bands
  void place_surface(int band);    // owners and positions of surface texels
  void place_gutter(int band);     // after place_surface of all bands
  void box_slots(int band);        // after place_gutter of all bands
  void share_grids();              // after box_slots of all bands
  void credit_areas(int band);     // after place_surface of all bands
  void credit_leftovers();         // after credit_areas of all bands
  // Packed positions, bounds and sums; after share_grids and credit_leftovers.
  void pack_slots(int band);
  void bound_tiles();            // after pack_slots of all bands
  void plant_tree(int threads);  // after pack_slots of all bands

  // The results of place_surface and place_gutter for painting by triangle. They have 64 entries
  // per slot and are defined for surface texels only. Weights store the second corner in the low 16
  // bits and the third corner in the high 16 bits, in units of 1/65535. Call these functions once,
  // at the end.
  std::vector<std::uint32_t> take_owners() { return std::move(owner_); }
  std::vector<std::uint32_t> take_weights() { return std::move(weights_); }
  struct Borrowed {
    // a gutter texel with the position of a surface texel; both index the per-slot arrays
    std::uint32_t gutter, owner;
  };
  const std::vector<Borrowed>& borrowed_in(int band) const { return borrowed_[band]; }

 private:
  static constexpr std::uint32_t kNobody = 0xffffffffu;

  // a triangle that covers no texel center claims the texel that contains its centroid
  struct Claim {
    std::uint32_t texel, triangle;
  };
  struct Leftover {  // area on a texel that the triangle's island does not own
    std::uint32_t texel, triangle;
    float area;
  };

  std::uint32_t vertex(std::uint32_t triangle, int k) const {
    return geometry_.indices[3 * std::size_t{triangle} + k];
  }
  glm::dvec2 texels_at(std::uint32_t triangle, int k) const;
  CoverageRaster raster_of(std::uint32_t triangle) const;
  std::uint32_t centroid_texel(std::uint32_t triangle) const;  // y * resolution + x
  int first_block_row(int band) const { return band * map_.blocks_per_side / band_count(); }
  int first_row(int band) const { return first_block_row(band) * kBlockSize; }
  Buckets triangles_by_band() const;
  template <class Visit>
  void for_each_slot(int band, Visit visit);

  BlockTree::Part part_of(std::uint32_t slot) const;  // treats the block as one part
  std::uint64_t block_mask(const std::vector<std::uint64_t>& masks, int block_x, int block_y) const;
  bool is_surface(int x, int y) const;
  // index into the per-slot arrays; the block must have a slot
  std::size_t texel_index(int x, int y) const;
  std::uint32_t owner(int x, int y) const;  // kNobody if not a surface texel
  bool nearest_surface(int x, int y, std::uint32_t island, glm::ivec2& found) const;
  glm::ivec2 heir_of(const Leftover& leftover) const;

  const Geometry& geometry_;
  SurfaceMap& map_;
  const int resolution_;
  const BakeFor purpose_;
  const int band_count_;
  std::vector<SnappedPoint> snapped_;
  std::vector<float> triangle_area_;
  UvIslands islands_;
  Buckets triangles_of_band_;
  std::vector<std::uint64_t> surface_of_block_, gutter_of_block_;
  std::vector<std::vector<Claim>> claims_;
  std::vector<std::vector<Borrowed>> borrowed_;
  std::vector<std::vector<Leftover>> leftovers_;
  std::vector<std::uint64_t> overlaps_of_band_;
  std::vector<std::uint32_t> owner_;    // 64 per slot
  std::vector<std::uint32_t> weights_;  // 64 per slot, for BakeFor::owners only
  // 64 per slot, until they are packed; undefined for texels that are neither surface nor gutter
  std::unique_ptr<glm::vec3[]> position_;
  struct Box {
    glm::vec3 low{INFINITY}, high{-INFINITY};
  };
  std::vector<Box> box_of_slot_;
  std::vector<std::vector<BoundedPart>> parts_of_band_;
};

}  // namespace strata::mesh
