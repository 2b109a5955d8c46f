#include "app/layers/geopackage.h"
#include "app/layers/layer_features.h"
#include "net/api/route_help.h"
#include "net/api/routes.h"
#include "net/serialization/as_of.h"
#include "net/serialization/feature_json.h"
#include "net/serialization/map_query.h"
#include "net/transport/server_options.h"
#include "room/edits.h"
#include "room/room.h"

namespace strata::net {
namespace {

enum class FeatureFormat { geojson, gpkg };

// Returns the format in the query parameter `f` or, if it is absent, the format in `Accept`. The
// default is GeoJSON. Returns 406 for unsupported formats.
Result<FeatureFormat> feature_format(const Request& request) {
  const auto format = request.query.find("f");
  if (format == request.query.end())
    return request.header("accept").find(app::kGeoPackageType) == std::string_view::npos
               ? FeatureFormat::geojson
               : FeatureFormat::gpkg;
  if (format->second == "geojson") return FeatureFormat::geojson;
  if (format->second == "gpkg") return FeatureFormat::gpkg;
  return fail(ErrorCode::not_acceptable, "Unknown format", "`f` must be geojson or gpkg.", "f");
}

Result<Response> read_features(const RouteContext& context, const Request& request) {
  const auto format = STRATA_TRY(feature_format(request));
  const auto axis = STRATA_TRY(map_axis(request));
  const auto language = STRATA_TRY(requested_language(request));
  const auto query = STRATA_TRY(LayerQuery::from(context, request));
  auto set = STRATA_TRY(app::layer_features(context.store, {query.room,
                                                            query.layer,
                                                            query.at,
                                                            {axis.u, axis.v, 3 - axis.u - axis.v},
                                                            request.role(),
                                                            language}));
  Response response =
      format == FeatureFormat::geojson
          ? feature_json(std::move(set))
          : file_response(STRATA_TRY(app::geopackage(set, context.options.upload_dir)));
  add_sequences(response, query.sequence, query.room->edits().durable_sequence());
  response.with("Vary", "Accept");
  return response;
}

}  // namespace

void add_feature_routes(Router& router, const RouteContext& context) {
  router.add({.method = Method::get,
              .pattern = "/api/v1/models/{model}/layers/{layer}/features",
              .handler = answering(
                  [&context](const Request& request) { return read_features(context, request); }),
              .query = {"f", "along", "at", "lang"},
              .is_question = true,
              .state = state_of_model(context)});
}

}  // namespace strata::net
