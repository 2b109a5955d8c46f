#include "net/api/layers/region_reader.h"

#include <algorithm>

#include "domain/layers/layer.h"
#include "domain/scene/model.h"
#include "domain/scene/units.h"
#include "expression/expression_parser.h"
#include "net/api/models/rollout_fit.h"
#include "net/api/route_help.h"
#include "net/serialization/at_field.h"
#include "net/serialization/edit_serialization.h"
#include "query/conditions/expression_evaluator.h"
#include "room/room.h"
#include "room/surface_images.h"
#include "store/content/named_parts.h"

namespace strata::net {
namespace {

room::Combination combination_of(const nlohmann::json& part) {
  const std::string name = part.value("combine", "add");
  return name == "subtract"    ? room::Combination::subtract
         : name == "intersect" ? room::Combination::intersect
                               : room::Combination::add;
}

}  // namespace

Result<room::Selection::Like> RegionReader::like(protocol::Like& body,
                                                 const std::string& field) const {
  using By = room::Selection::Like::By;
  room::Selection::Like like;
  like.at = place_of(body.at);
  like.tolerance = body.tolerance;
  like.contiguous = body.contiguous;
  if (body.radius_mm) like.radius = in_model_units(*body.radius_mm, room_.model().unit);
  if (body.path) {
    if (!body.at.camera)
      return fail(ErrorCode::invalid, "Path without a camera",
                  "The path consists of pixels. Send `at` as a pixel of a camera too.",
                  field + ".at");
    if (!like.radius)
      return fail(ErrorCode::invalid, "Radius missing",
                  "Send `radius_mm`, how far the selection reaches from the path.",
                  field + ".radius_mm");
    like.path = *body.path;
  }
  switch (body.by) {
    case protocol::LikeBy::color: like.by = By::color; break;
    case protocol::LikeBy::normal: like.by = By::normal; break;
    case protocol::LikeBy::value: like.by = By::value; break;
  }
  if ((like.by == By::value) != body.layer.has_value())
    return fail(ErrorCode::invalid, "Layer missing or not used",
                "Send `layer` if and only if `by` is value.", field + ".layer");
  if (body.look && like.by != By::color)
    return fail(ErrorCode::invalid, "Surface image not used", "Send `look` only if `by` is color.",
                field + ".look");
  if (body.layer) {
    const auto layers =
        STRATA_TRY(find_layers(room_, {protocol::to_ref(*body.layer)}, field + ".layer"));
    like.layer = layers.front().slug;
    body.layer = layers.front().id.number();
  }
  if (body.look) {
    const auto image = room_.surface_images().find(protocol::to_ref(*body.look));
    if (!image) return at_field(image.error(), field + ".look");
    like.image = image->id;
    body.look = image->id.number();
  }
  return like;
}

Result<room::Selection::Unrolled> RegionReader::unrolled(const protocol::Unrolled& body,
                                                         const std::string& field) const {
  const auto sheet = read_sheet(body);
  if (!sheet) return at_field(sheet.error(), field + "." + sheet.error().field);
  room::Selection::Unrolled unrolled{.fit = sheet->fit, .cut = sheet->cut};
  const double units_per_mm = in_model_units(1, room_.model().unit);
  std::size_t points = 0;
  for (const auto& polygon : body.polygons.value_or(std::vector<protocol::SheetOutline>{})) {
    points += polygon.size();
    for (auto& in_units = unrolled.polygons.emplace_back(); const glm::dvec2& point : polygon)
      in_units.push_back(point * units_per_mm);
  }
  for (const auto& stroke : body.strokes.value_or(std::vector<protocol::SheetStroke>{})) {
    points += stroke.path.size();
    auto& in_units = unrolled.strokes.emplace_back();
    in_units.radius = stroke.radius_mm * units_per_mm;
    for (const glm::dvec2& point : stroke.path) in_units.path.push_back(point * units_per_mm);
  }
  if (points > kMaxOutlinePoints)
    return fail(ErrorCode::invalid, "Too many points",
                "The polygons and strokes can have at most " + std::to_string(kMaxOutlinePoints) +
                    " points in total. Draw a simpler area.",
                field);
  return unrolled;
}

Result<room::Selection::Combined> RegionReader::combined(std::vector<nlohmann::json>& parts,
                                                         const std::string& field, int depth) {
  if (depth == kMaxRegionDepth)
    return fail(ErrorCode::invalid, "Nested too deep",
                "Combinations can be nested at most " + std::to_string(kMaxRegionDepth) +
                    " deep. Combine the parts in fewer steps.",
                field);
  room::Selection::Combined combined;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const std::string at = field + "[" + std::to_string(i) + "]";
    const room::Combination combination = combination_of(parts[i]);
    if (i == 0 && combination != room::Combination::add)
      return fail(ErrorCode::invalid, "Nothing to combine",
                  "The first part can only be added, because there is nothing before it.",
                  at + ".combine");
    protocol::Within within;
    protocol::read(parts[i].at("within"), within);
    STRATA_TRY(protocol::check(within, at + ".within"));
    auto part = STRATA_TRY(region(within, at + ".within", depth + 1));
    parts[i]["within"] = protocol::to_json(within);
    part.combination = combination;
    combined.parts.push_back(std::move(part));
  }
  return combined;
}

Result<room::Selection::Combined> RegionReader::saved(protocol::LayerRef& ref,
                                                      const std::string& field, int depth) {
  auto found = selections_.find(room_.model().id, protocol::to_ref(ref), reader_);
  if (!found) {
    found.error().field = field;
    return tl::unexpected(std::move(found.error()));
  }
  const std::int64_t id = found->id.number();
  if (std::ranges::find(open_, id) != open_.end())
    return fail(ErrorCode::invalid, "Selection uses itself",
                "The selection " + found->name +
                    " would use itself. Remove it from its own definition, and from the "
                    "selections that the definition uses.",
                field);
  if (open_.size() > kMaxRegionDepth)
    return fail(ErrorCode::invalid, "Nested too deep",
                "Saved selections can use each other at most " + std::to_string(kMaxRegionDepth) +
                    " deep. Use fewer selections.",
                field);
  if (found->content.at("audience") == "personal" && personal_field_.empty())
    personal_field_ = field;
  ref = id;
  open_.push_back(id);
  protocol::Within within;
  protocol::read(found->content.at("within"), within);
  auto definition = STRATA_TRY(region(within, field, depth));
  open_.pop_back();
  room::Selection::Combined combined;
  combined.parts.push_back(std::move(definition));
  return combined;
}

Result<room::Selection::Region> RegionReader::region(protocol::Within& within,
                                                     const std::string& field, int depth) {
  room::Selection::Region region;
  region.field = field;
  const Unit unit = room_.model().unit;
  if (within.grow_mm) region.grow = in_model_units(*within.grow_mm, unit);
  if (within.smooth_mm) region.smooth = in_model_units(*within.smooth_mm, unit);
  if (within.parts) {
    region.area = STRATA_TRY(combined(*within.parts, field + ".parts", depth));
    return region;
  }
  if (within.selection) {
    region.area = STRATA_TRY(saved(*within.selection, field + ".selection", depth));
    return region;
  }
  if (++leaves_ > kMaxRegionLeaves)
    return fail(ErrorCode::invalid, "Too many parts",
                "A selection can have at most " + std::to_string(kMaxRegionLeaves) +
                    " parts, including those of saved selections.",
                field);
  if (within.path) {
    auto outline =
        outline_of(*within.camera, *within.path, within.through.value_or(false), within.steps);
    if (!outline) return at_field(outline.error(), field + "." + outline.error().field);
    region.area = std::move(*outline);
  } else if (within.like) {
    region.area = STRATA_TRY(like(*within.like, field + ".like"));
  } else if (within.unrolled) {
    region.area = STRATA_TRY(unrolled(*within.unrolled, field + ".unrolled"));
  } else if (within.where) {
    auto condition = STRATA_TRY(query::parse_condition(*within.where, field + ".where"));
    region.area = room::Selection::Where{std::move(condition), *within.where};
  } else {
    region.area =
        room::Selection::Around{place_of(*within.at), in_model_units(*within.radius_mm, unit)};
  }
  return region;
}

Result<room::Selection::Region> RegionReader::read(protocol::Within& within,
                                                   const std::string& field) {
  return region(within, field, 0);
}

}  // namespace strata::net
