#pragma once

#include <memory>
#include <vector>

#include "media/picture.h"
#include "mesh/surface/geometry.h"
#include "mesh/surface/search_tree.h"
#include "query/sampling/drawn_layer.h"

namespace strata::query {

// The color of any point of a model's surface, composed like the colors of its vertices
// (VertexColors), but with the pixels of the photos and the texels of the layers at this point.
// Thread-safe after the last addition.
class SurfaceColors {
 public:
  explicit SurfaceColors(std::shared_ptr<const mesh::Geometry> geometry)
      : geometry_(std::move(geometry)) {}

  // Adds a photo over the current colors.
  void add_photo(Picture photo, double opacity) { photos_.push_back({std::move(photo), opacity}); }
  // Adds a layer over all photos and the layers below it.
  void add_layer(DrawnLayer layer) { layers_.push_back(std::move(layer)); }

  // Returns red, green and blue from 0 to 255.
  glm::dvec3 at(const mesh::SearchTree::Hit& point) const;

 private:
  struct Photo {
    Picture picture;
    double opacity = 1;
  };
  std::shared_ptr<const mesh::Geometry> geometry_;
  std::vector<Photo> photos_;
  std::vector<DrawnLayer> layers_;  // bottom to top
};

}  // namespace strata::query
