// The selection of surface that looks like the surface at a position.
#include "domain/people/question.h"
#include "mesh/parallel.h"
#include "query/conditions/similar.h"
#include "room/caches/appearance_cache.h"
#include "room/open/open_queries.h"
#include "room/open/open_surface.h"
#include "room/pipeline/region.h"

namespace strata::room {

Result<query::TexelSelection> OpenRoom::QueriesPart::texels_like(const Selection::Like& like, At at,
                                                                 const mesh::SurfaceMap& map,
                                                                 const std::string& field) {
  const auto start =
      STRATA_TRY(find_place(like.at, map, *room_.surface_lookup_, field + ".like.at"));
  const auto graph = STRATA_TRY(room_.surface_lookup_->graph(map));
  query::Similarity similarity{
      .start = start.texel, .tolerance = like.tolerance, .contiguous = like.contiguous};
  if (like.radius) similarity.radius = static_cast<float>(*like.radius);
  if (like.path.empty()) similarity.around.push_back({start.texel, start.position});
  const QuestionTurn turn;
  for (const glm::dvec2& pixel : like.path) {
    turn.check();
    const Camera& camera = std::get<PixelPlace>(like.at).camera;
    // A path can leave the model.
    if (const auto place = find_place(PixelPlace{camera, pixel.x, pixel.y}, map,
                                      *room_.surface_lookup_, field + ".like.path"))
      similarity.around.push_back({place->texel, place->position});
  }
  const int threads = mesh::background_threads();
  switch (like.by) {
    case Selection::Like::By::color: {
      const auto texels = room_.surface_part_->colors(map.resolution, like.image);
      if (!texels) {
        Error problem = texels.error();
        if (problem.code == ErrorCode::invalid && problem.field.empty()) {
          problem.field = field + ".like.by";
          problem.detail += " Or select by orientation or by the values of a layer.";
        } else if (problem.code == ErrorCode::invalid) {
          problem.field = field + ".like." + problem.field;
        }
        return tl::unexpected(std::move(problem));
      }
      return query::select_similar_colors(map, *graph, **texels, similarity, threads);
    }
    case Selection::Like::By::normal: {
      const auto texels = STRATA_TRY(room_.appearance_->normals(map));
      return query::select_similar_normals(map, *graph, *texels, similarity, threads);
    }
    case Selection::Like::By::value: break;
  }
  const auto views = STRATA_TRY(room_.layer_views({like.layer}, at));
  return query::select_similar_values(map, *graph, views.front(), similarity, threads);
}

}  // namespace strata::room
