#pragma once

#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "query/conditions/texel_selection.h"
#include "query/sampling/texel_appearance.h"
#include "room/open/open_room.h"
#include "room/queries.h"

namespace strata::room {

// Answers questions from mirrors and maps in main memory, in parallel with painting.
class OpenRoom::QueriesPart final : public Queries {
 public:
  explicit QueriesPart(OpenRoom& room) : room_(room) {}
  Result<query::SurfacePoint> position(const glm::dvec3& world,
                                       const std::vector<std::string>& layers, At at) override;
  Result<std::vector<query::SurfacePoint>> positions(const std::vector<glm::dvec3>& world,
                                                     const std::vector<std::string>& layers,
                                                     At at) override;
  Result<query::SurfacePoint> pick(const Camera& camera, double x, double y,
                                   const std::vector<std::string>& layers, At at) override;
  Result<query::Statistics> statistics(const std::string& layer, const Selection& selection,
                                       StatisticsOptions options) override;
  Result<SelectedArea> select(const Selection& selection, const std::vector<std::string>& layers,
                              StatisticsOptions options) override;
  Result<SelectedArea::Texels> selected_texels(const Selection& selection) override;
  Result<query::Profile> profile(const ProfileLine& line, const std::vector<std::string>& layers,
                                 At at) override;
  Result<query::CrossTable> cross_table(const std::string& rows, const std::string& columns,
                                        const Selection& selection) override;
  Result<query::Quantities> quantities(const std::string& layer, At at) override;
  Result<LayerAreas> layer_areas(const std::string& layer, At at) override;
  Result<query::SurfaceTexels> surface_texels(const std::string& layer,
                                              const Selection& selection) override;
  Result<std::map<std::int64_t, query::KeyArea>> key_areas(const std::string& layer,
                                                           At at) override;
  Result<LayerDifference> difference(const std::string& layer, At one, At other,
                                     const std::optional<Outline>& outline) override;
  Result<TileMirror::Snapshot> tiles(const std::string& layer, At at) override;

 private:
  // Returns the resolution of the finest layer that the selection reads, or 0.
  int resolution_read_by(const Selection& selection) const;
  struct LayerGraph {
    query::LayerView view;
    std::shared_ptr<const mesh::SurfaceMap> map;
    std::shared_ptr<const mesh::TexelGraph> graph;
  };
  Result<LayerGraph> layer_graph(const std::string& layer, At at);
  // The earlier and later content of a layer in Selection::Changed. Only the tiles that differ need
  // additional memory.
  struct ChangedLayer {
    Layer layer;
    TileMirror::Snapshot from, to;
  };
  // The last edit of each layer before or at the two states.
  struct ChangedSequences {
    std::map<LayerId, std::int64_t> from, to;
  };
  Result<ChangedLayer> changed_layer(const std::string& slug, const ChangedSequences& last);
  // Returns a selection for each map. Reads one layer at a time, once for all maps.
  Result<std::vector<query::TexelSelection>> changed_texels(
      const Selection::Changed& states, std::span<const mesh::SurfaceMap* const> maps);
  // Returns nullopt for the whole surface.
  Result<std::optional<query::TexelSelection>> texels_within(const Selection& selection,
                                                             const mesh::SurfaceMap& map);
  // Returns the texels of one region of the selection. Only those in `inside` matter; null means
  // all.
  Result<query::TexelSelection> texels_of(const Selection::Region& region,
                                          const Selection& selection, const mesh::SurfaceMap& map,
                                          const query::TexelSelection* inside);
  Result<query::TexelSelection> texels_of(const Selection::Combined& combined,
                                          const Selection& selection, const mesh::SurfaceMap& map);
  // Evaluates a condition only for the texels in `inside`, so a small area needs little time.
  Result<query::TexelSelection> texels_where(const Expression& condition,
                                             const Selection& selection,
                                             const mesh::SurfaceMap& map, const std::string& field,
                                             const query::TexelSelection* inside);
  // `field` is the name of the region in errors.
  Result<query::TexelSelection> texels_like(const Selection::Like& like, At at,
                                            const mesh::SurfaceMap& map, const std::string& field);
  // Errors are at members of `field`.
  Result<std::shared_ptr<const mesh::FittedSheet>> fitted_sheet(const mesh::FitRequest& fit,
                                                                const std::optional<double>& cut,
                                                                const std::string& field);
  Result<query::TexelSelection> texels_unrolled(const Selection::Unrolled& unrolled,
                                                const mesh::SurfaceMap& map,
                                                const std::string& field);
  // Like `texels_within`, for each map.
  Result<std::vector<std::optional<query::TexelSelection>>> select_texels(
      const Selection& selection, std::span<const mesh::SurfaceMap* const> maps);
  Result<std::optional<query::TexelSelection>> select_texels(const Selection& selection,
                                                             const mesh::SurfaceMap& map);
  // `changed` is null if the selection does not depend on changes.
  Result<std::optional<query::TexelSelection>> select_texels(const Selection& selection,
                                                             const mesh::SurfaceMap& map,
                                                             const query::TexelSelection* changed);
  // `within` is null for the whole surface. `is_now` is true if the view is the newest state, whose
  // sums are cached.
  Result<query::Statistics> count(const query::LayerView& view, const mesh::SurfaceMap& map,
                                  const query::TexelSelection* within, bool is_now,
                                  const StatisticsOptions& options);

  OpenRoom& room_;
};

}  // namespace strata::room
