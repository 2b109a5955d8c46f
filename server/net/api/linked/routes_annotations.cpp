// The annotations of a model: areas, lines and points of its layers, and comments.
#include <algorithm>
#include <map>
#include <optional>
#include <string_view>
#include <unordered_map>

#include "app/layers/layer_features.h"
#include "app/maps/gis_plane.h"
#include "core/no_such.h"
#include "domain/layers/layer.h"
#include "domain/people/question.h"
#include "domain/scene/model.h"
#include "net/api/addressed.h"
#include "net/api/linked/linked_response.h"
#include "net/api/linked/linked_terms.h"
#include "net/api/linked/web_annotation.h"
#include "net/api/route_help.h"
#include "net/api/routes.h"
#include "net/auth/project_authorization.h"
#include "net/http/entity_tags.h"
#include "net/serialization/people_serialization.h"
#include "room/layers.h"
#include "room/room.h"
#include "store/content/comments.h"
#include "store/content/layers.h"
#include "store/content/models.h"
#include "store/store.h"

namespace strata::net {
namespace {

constexpr std::size_t kPerPage = 200;

// Returns the coordinates in the order x, y, z.
void turn_to_world(std::vector<query::FlatPolygon>& geometry, const query::OutlinePlane& plane) {
  for (query::FlatPolygon& polygon : geometry)
    for (query::FlatRing& ring : polygon.rings)
      for (glm::dvec3& corner : ring) {
        const glm::dvec3 flat = corner;
        corner[plane.right] = flat.x;
        corner[plane.up] = flat.y;
        corner[plane.depth] = flat.z;
      }
}

// Features without an outline take that of the feature with the same id.
void take_outlines(std::vector<app::Feature>& features, std::vector<app::Feature>& others) {
  std::unordered_map<std::string_view, app::Feature*> by_id;
  for (app::Feature& other : others) by_id.emplace(other.id, &other);
  for (app::Feature& feature : features) {
    if (!feature.geometry.empty()) continue;
    const auto other = by_id.find(feature.id);
    if (other != by_id.end()) feature.geometry = std::move(other->second->geometry);
  }
}

struct LayerAnnotations {
  Model model;
  Layer layer;
  std::vector<app::FeatureTable> tables;
};

// Chooses among the areas of a layer, by their number and content.
using Choice = std::function<bool(std::size_t number, const app::Feature& feature)>;

// Returns the features with world coordinates. The chosen areas are outlined on the plane on which
// the model is largest. An area that is seen edge-on there is outlined on another plane.
Result<LayerAnnotations> annotations_in(const RouteContext& context, const Request& request,
                                        const Choice& chosen) {
  const auto room = STRATA_TRY(open_room(context, request));
  LayerAnnotations found{
      room->model(), STRATA_TRY(room->layers().find(request.param("layer"))), {}};
  const query::OutlinePlane first = app::GisPlane(found.model, std::nullopt).outline();
  const auto lacks_outline = [&](std::size_t number, const app::Feature& feature) {
    return chosen(number, feature) && feature.geometry.empty();
  };
  for (const query::OutlinePlane& plane :
       {first, query::OutlinePlane{first.up, first.depth, first.right},
        query::OutlinePlane{first.depth, first.right, first.up}}) {
    const bool is_first = found.tables.empty();
    const auto outlined = [&](std::size_t number, const app::Feature& feature) {
      if (is_first) return chosen(number, feature);
      // The layer may have changed since the first outlines.
      const auto& areas = found.tables.front().features;
      return number < areas.size() && areas[number].id == feature.id &&
             lacks_outline(number, areas[number]);
    };
    auto set = STRATA_TRY(app::layer_features(
        context.store,
        {room, found.layer, {}, plane, request.role(), {}, true, is_first, outlined}));
    for (app::FeatureTable& table : set.tables)
      for (app::Feature& feature : table.features) turn_to_world(feature.geometry, plane);
    if (is_first)
      found.tables = std::move(set.tables);
    else
      take_outlines(found.tables.front().features, set.tables.front().features);
    const auto& areas = found.tables.front().features;
    std::size_t number = 0;
    if (std::ranges::none_of(
            areas, [&](const app::Feature& area) { return lacks_outline(number++, area); }))
      break;
  }
  return found;
}

// A page of a collection.
struct PageOf {
  std::size_t number = 0;
  std::string address(const std::string& base, std::size_t page) const {
    return page == 0 ? base : base + "?page=" + std::to_string(page);
  }
};

Result<PageOf> asked_page(const Request& request) {
  const auto asked = request.query.find("page");
  if (asked == request.query.end()) return PageOf{};
  const auto number = STRATA_TRY(parse_integer(asked->second, 0, 1'000'000, "page"));
  return PageOf{static_cast<std::size_t>(number)};
}

// Adds the members of a page. `base` is the address of the first page, and `after` that of the page
// after the last one of these.
nlohmann::json annotation_page(const LinkedAddresses& addresses, ModelId model,
                               const std::string& base, const PageOf& page, std::size_t total,
                               const std::string& after, nlohmann::json items) {
  nlohmann::json json{
      {"id", page.address(base, page.number)},
      {"type", "AnnotationPage"},
      {"partOf", {{"id", addresses.annotations(model)}, {"type", "AnnotationCollection"}}},
      {"items", std::move(items)}};
  const auto reference = [](const std::string& id) -> nlohmann::json {
    return {{"id", id}, {"type", "AnnotationPage"}};
  };
  if ((page.number + 1) * kPerPage < total)
    json["next"] = reference(page.address(base, page.number + 1));
  else if (!after.empty())
    json["next"] = reference(after);
  if (page.number > 0) json["prev"] = reference(page.address(base, page.number - 1));
  return json;
}

Result<Response> collection(const RouteContext& context, const Request& request) {
  const auto model = STRATA_TRY(stored_model(context, request));
  const auto layers = STRATA_TRY(context.store.layers().of_model(model.id, request.role()));
  const LinkedAddresses addresses(context, request);
  nlohmann::json json{
      {"id", addresses.annotations(model.id)},
      {"type", "AnnotationCollection"},
      {"label", "Annotations of " + model.name},
      {"first", {{"id", addresses.comments_of(model.id)}, {"type", "AnnotationPage"}}}};
  return linked_response(context, request, std::move(json), web_annotation(),
                         addresses.page(model));
}

std::string author_of(const RouteContext& context, const Request& request,
                      const std::string& user) {
  const std::string name = visible_name(request, user);
  return name.empty() ? name : written_name(context.store, name);
}

Result<Response> comments_page(const RouteContext& context, const Request& request) {
  const auto page = STRATA_TRY(asked_page(request));
  const auto model = STRATA_TRY(stored_model(context, request));
  store::Comments::Query query;
  query.limit = static_cast<int>(kPerPage);
  query.offset = static_cast<int>(page.number * kPerPage);
  const auto found = STRATA_TRY(context.store.comments().of_model(model.id, request.role(), query));
  const LinkedAddresses addresses(context, request);
  const SceneFrame frame(model);
  nlohmann::json items = nlohmann::json::array();
  std::map<std::string, std::string> authors;  // by user
  for (const store::Comment& comment : found.comments) {
    if (comment.deleted) continue;
    const auto [author, is_new] = authors.try_emplace(comment.user);
    if (is_new) author->second = author_of(context, request, comment.user);
    items.push_back(comment_annotation(addresses, frame, comment, author->second));
  }
  const auto layers = STRATA_TRY(context.store.layers().of_model(model.id, request.role()));
  return linked_response(
      context, request,
      annotation_page(addresses, model.id, addresses.comments_of(model.id), page,
                      static_cast<std::size_t>(found.total),
                      layers.empty() ? std::string() : addresses.annotations(layers.front()),
                      std::move(items)),
      web_annotation(), addresses.page(model));
}

Result<Response> layer_page(const RouteContext& context, const Request& request) {
  const auto page = STRATA_TRY(asked_page(request));
  const auto found =
      STRATA_TRY(annotations_in(context, request, [&](std::size_t number, const app::Feature&) {
        return number / kPerPage == page.number;
      }));
  const LinkedAddresses addresses(context, request);
  const SceneFrame frame(found.model);
  nlohmann::json items = nlohmann::json::array();
  std::size_t total = 0;
  for (const app::FeatureTable& table : found.tables)
    for (const app::Feature& feature : table.features) {
      check_question();
      if (total++ / kPerPage == page.number)
        items.push_back(
            feature_annotation(addresses, frame, {found.model, found.layer, table, feature}));
    }
  const auto layers = STRATA_TRY(context.store.layers().of_model(found.model.id, request.role()));
  auto next = std::ranges::find(layers, found.layer.id, &Layer::id);
  if (next != layers.end()) ++next;
  return linked_response(
      context, request,
      annotation_page(addresses, found.model.id, addresses.annotations(found.layer), page, total,
                      next == layers.end() ? std::string() : addresses.annotations(*next),
                      std::move(items)),
      web_annotation(), addresses.page(found.model));
}

Result<Response> layer_annotation(const RouteContext& context, const Request& request) {
  const std::string& name = request.param("annotation");
  const auto found =
      STRATA_TRY(annotations_in(context, request, [&](std::size_t, const app::Feature& feature) {
        return name == "areas." + feature.id;
      }));
  const LinkedAddresses addresses(context, request);
  for (const app::FeatureTable& table : found.tables)
    for (const app::Feature& feature : table.features)
      if (annotation_name(table, feature) == request.param("annotation"))
        return linked_response(context, request,
                               feature_annotation(addresses, SceneFrame(found.model),
                                                  {found.model, found.layer, table, feature}),
                               web_annotation(), addresses.page(found.model));
  return no_such("annotation", request.param("annotation"));
}

Result<Response> comment(const RouteContext& context, const Request& request) {
  const auto id = STRATA_TRY(id_of<CommentId>(request, "comment"));
  const auto found = STRATA_TRY(context.store.comments().comment(id, request.role()));
  const auto model = STRATA_TRY(context.store.models().find(to_string(found.model_id)));
  const LinkedAddresses addresses(context, request);
  return linked_response(
      context, request,
      comment_annotation(addresses, SceneFrame(model), found,
                         author_of(context, request, found.user)),
      web_annotation(),
      addresses.page(model) + "#comment=" + to_string(found.thread.value_or(found.id)));
}

}  // namespace

void add_annotation_routes(Router& router, const RouteContext& context) {
  using Answer = Result<Response> (*)(const RouteContext&, const Request&);
  const auto add = [&](const std::string& pattern, Answer answer, bool is_question,
                       std::vector<std::string> query) {
    router.add({.method = Method::get,
                .pattern = pattern,
                .handler = answering([&context, answer](const Request& request) {
                  return answer(context, request);
                }),
                .query = std::move(query),
                .is_question = is_question,
                .state = is_question ? state_of_model(context) : StateOf()});
  };
  const std::string model = "/id/models/{model}";
  add(model + "/annotations", collection, false, {"f"});
  add(model + "/comments", comments_page, false, {"f", "page"});
  add(model + "/layers/{layer}/annotations", layer_page, true, {"f", "page"});
  add(model + "/layers/{layer}/annotations/{annotation}", layer_annotation, true, {"f"});
  add("/id/comments/{comment}", comment, false, {"f"});
}

}  // namespace strata::net
