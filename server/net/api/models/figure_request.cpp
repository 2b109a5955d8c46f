#include "net/api/models/figure_request.h"

#include <chrono>

#include "core/text/timestamp.h"
#include "domain/layers/layer.h"
#include "domain/scene/model.h"
#include "domain/tables/table.h"
#include "net/api/addressed.h"
#include "net/api/models/rollout_fit.h"
#include "net/serialization/as_of.h"
#include "net/serialization/at_field.h"
#include "net/serialization/people_serialization.h"
#include "net/serialization/view_serialization.h"
#include "room/edits.h"
#include "room/layers.h"
#include "room/room.h"
#include "room/view_settings.h"
#include "store/content/named_parts.h"
#include "store/content/projects.h"
#include "store/store.h"
#include "store/tables/tables.h"

namespace strata::net {
namespace {

using app::FigureRequest;

constexpr Rgba kPaper{255, 255, 255, 255};

// Directions, paper sizes and formats have the same order in the API, so a cast converts them.
static_assert(
    static_cast<int>(protocol::FigureDirection::right) ==
        static_cast<int>(figure::Direction::right) &&
    static_cast<int>(protocol::FigureRequestPaper::a3) == static_cast<int>(figure::Paper::a3) &&
    static_cast<int>(protocol::FigureFormat::pdf) == static_cast<int>(figure::Format::pdf) &&
    static_cast<int>(protocol::FigureFormat::dxf) == static_cast<int>(figure::Format::dxf) &&
    static_cast<int>(protocol::FigureDimensionDirection::vertical) ==
        static_cast<int>(figure::DimensionDirection::vertical));

// Copies the shown layers and images to `figure`, and the name of a saved view to `view_name`.
// Returns the camera, if there is one.
Result<std::optional<Camera>> read_shown(const RouteContext& context, const Request& request,
                                         const protocol::FigureRequest& body, FigureRequest& figure,
                                         std::string& view_name) {
  const room::Room& room = *figure.room;
  if (!body.view) {
    if (body.camera) STRATA_TRY(validate(*body.camera));
    auto shown = STRATA_TRY(shown_settings(room, body));
    figure.shown.shown = std::move(shown);
    return body.camera;
  }
  if (body.camera || body.layers || body.looks || body.light)
    return fail(ErrorCode::invalid, "View together with other settings",
                "A figure of a saved view uses the settings of the view. Leave out camera, "
                "layers, looks and light.",
                "view");
  const auto view = context.store.views().find(room.model().id, *body.view);
  if (!view) {
    return at_field(view.error(), "view");
  }
  const auto saved = STRATA_TRY(as_view_create(context, request, *view, room));
  auto shown = STRATA_TRY(shown_settings(room, saved));
  figure.shown.shown = std::move(shown);
  view_name = saved.name;
  return std::optional<Camera>(saved.camera);
}

// Returns the point in the middle of the camera's window. Its depth does not affect the drawing
// plane.
glm::dvec3 middle_of(const Camera& camera, const Model& model) {
  const Ray ray = ray_through_pixel(camera, camera.width / 2.0, camera.height / 2.0);
  const glm::dvec3 to_model = (model.bounds_min + model.bounds_max) / 2.0 - ray.origin;
  return ray.origin + glm::dot(to_model, ray.direction) * ray.direction;
}

Result<void> read_direction(const protocol::FigureRequest& body,
                            const std::optional<Camera>& camera, FigureRequest& figure) {
  const Model model = figure.room->model();
  if (body.direction && body.normal)
    return fail(ErrorCode::invalid, "Direction and normal together",
                "Send either a direction or a normal, but not both.", "normal");
  if (camera) {
    figure.section = camera->section;
    figure.hidden_parts = camera->hidden_parts;
  }
  if (body.normal) {
    if (!(glm::length(*body.normal) > 1e-12))
      return fail(ErrorCode::invalid, "Invalid normal",
                  "The length of the normal must not be 0. For example, [0, 0, 1] is a surface "
                  "that faces along z.",
                  "normal");
    figure.plane = figure::plane_square_to(*body.normal, model.up);
    figure.from = "face";
  } else if (body.direction || !camera) {
    const auto direction = body.direction.value_or(protocol::FigureDirection::top);
    figure.plane = figure::plane_from(static_cast<figure::Direction>(direction), model.up);
    figure.from = protocol::name(direction);
  } else {
    figure.plane = figure::plane_of(*camera);
    figure.from = body.view.value_or("view");
    figure.center = middle_of(*camera, model);
  }
  if (body.center) figure.center = body.center;
  return {};
}

// Reads the rollout, which replaces the direction.
Result<void> read_unrolled(const protocol::FigureRequest& body, FigureRequest& figure) {
  const auto refused = [](const char* field) {
    return fail(
        ErrorCode::invalid, "Setting without effect",
        "A rollout has no camera, light, direction, normal, center, labels and dimensions. Leave "
        "out `" +
            std::string(field) + "`, or leave out `rollout`.",
        field);
  };
  if (body.camera) return refused("camera");
  if (body.light) return refused("light");
  if (body.direction) return refused("direction");
  if (body.normal) return refused("normal");
  if (body.center) return refused("center");
  if (body.labels) return refused("labels");
  if (body.dimensions) return refused("dimensions");
  const auto sheet = read_sheet(*body.rollout);
  if (!sheet) return at_field(sheet.error(), "rollout." + sheet.error().field);
  figure.rollout.emplace(FigureRequest::Rollout{sheet->fit, sheet->cut, body.rollout->relief});
  figure.from = "rollout";
  return {};
}

// Reads whether areas are outlines.
Result<void> read_areas(const protocol::FigureRequest& body, FigureRequest& figure) {
  constexpr double kTolerance_mm = 0.1;
  if (figure.format == figure::Format::dxf) {
    if (body.rollout)
      return fail(ErrorCode::invalid, "DXF of a rollout",
                  "A rollout cannot be a DXF file. Choose another format, or leave out `rollout`.",
                  "format");
    figure.outline_tolerance_mm = body.tolerance_mm.value_or(kTolerance_mm);
    return {};
  }
  if (body.areas == protocol::FigureRequestAreas::pixels) {
    if (!body.tolerance_mm) return {};
    return fail(ErrorCode::invalid, "Setting without effect",
                "Pixels have no tolerance. Leave out `tolerance_mm`, or set `areas` to `outlines`.",
                "tolerance_mm");
  }
  if (body.rollout)
    return fail(ErrorCode::invalid, "Outlines of a rollout",
                "The areas of a rollout are pixels. Leave out `areas`, or leave out `rollout`.",
                "areas");
  if (figure.format != figure::Format::svg && figure.format != figure::Format::pdf)
    return fail(ErrorCode::invalid, "Outlines in a picture",
                "PNG and TIFF files contain only pixels. Choose the format `pdf` or `svg` for "
                "outlines.",
                "areas");
  figure.outline_tolerance_mm = body.tolerance_mm.value_or(kTolerance_mm);
  return {};
}

Result<void> read_dimensions(const std::vector<protocol::FigureDimension>& body,
                             FigureRequest& figure) {
  for (std::size_t i = 0; i < body.size(); ++i) {
    const protocol::FigureDimension& each = body[i];
    if (each.from == each.to)
      return fail(ErrorCode::invalid, "Dimension without length",
                  "The two points of a dimension must be different.",
                  "dimensions[" + std::to_string(i) + "].to");
    const auto direction = each.direction.value_or(protocol::FigureDimensionDirection::aligned);
    figure.dimensions.push_back(
        {each.from, each.to, static_cast<figure::DimensionDirection>(direction)});
  }
  return {};
}

// Returns the title block without its scale. Texts that the body does not have come from the model,
// its project and the user.
Result<figure::TitleBlock> title_block(const RouteContext& context, const Request& request,
                                       const Model& model, const std::string& title,
                                       const protocol::FigureTitleBlock& body) {
  const auto project = STRATA_TRY(context.store.projects().find(to_string(model.project_id)));
  const auto labels = body.labels.value_or(protocol::FigureTitleBlockLabels{});
  const std::string object =
      model.name + (model.inventory_number.empty() ? "" : " (" + model.inventory_number + ")");
  constexpr std::size_t kDay = 10;  // length of YYYY-MM-DD
  figure::TitleBlock block;
  block.organization = {labels.organization, body.organization.value_or(model.owner)};
  block.project = {labels.project, body.project.value_or(project.name)};
  block.object = {labels.object, body.object.value_or(object)};
  block.title = {labels.title, title};
  block.author = {labels.author,
                  body.author ? *body.author : written_name(context.store, request.user())};
  block.checked_by = {labels.checked_by, body.checked_by.value_or("")};
  block.date = {labels.date, body.date
                                 ? *body.date
                                 : utc_text(std::chrono::system_clock::now()).substr(0, kDay)};
  block.status = {labels.status, body.status.value_or("")};
  block.scale = {labels.scale, ""};
  block.number = {labels.number, body.number.value_or("")};
  block.sheet = {labels.sheet, body.sheet};
  return block;
}

Result<void> read_labels(const RouteContext& context, const protocol::FigureLabels& body,
                         FigureRequest& figure) {
  const auto layer = figure.room->layers().find(protocol::to_ref(body.layer));
  if (!layer) {
    return at_field(layer.error(), "labels.layer");
  }
  if (!layer->table)
    return fail(ErrorCode::invalid, "Layer has no records",
                "The layer '" + layer->slug + "' is not a layer of records, so it has no records.",
                "labels.layer");
  const auto table = context.store.tables().find(to_string(*layer->table), figure.role);
  if (!table) return tl::unexpected(table.error());
  const Column* column = find_column(table->columns, body.column);
  if (!column || holds_lists(column->kind))
    return fail(ErrorCode::invalid, "Column not found",
                "The table '" + table->slug + "' has no column '" + body.column +
                    "' with one value in each record. Choose such a column for the labels.",
                "labels.column");
  figure.labels = {*layer, *column};
  return {};
}

Result<void> check_sheet_of_views(const protocol::FigureRequest& body) {
  const auto refused = [](const char* field) {
    return fail(ErrorCode::invalid, "Setting of a single view",
                "With `views`, each view has its own `" + std::string(field) + "`. Move `" +
                    std::string(field) + "` to the views, or leave out `views`.",
                field);
  };
  if (body.direction) return refused("direction");
  if (body.normal) return refused("normal");
  if (body.center) return refused("center");
  if (body.rollout) return refused("rollout");
  if (body.dimensions) return refused("dimensions");
  if (body.format == protocol::FigureFormat::dxf)
    return fail(
        ErrorCode::invalid, "DXF of several views",
        "A DXF file contains a single drawing. Choose another format, or leave out `views`.",
        "format");
  return {};
}

// Returns the request for a view alone.
protocol::FigureRequest body_of_view(const protocol::FigureRequest& body,
                                     const protocol::FigureView& view) {
  protocol::FigureRequest alone = body;
  alone.views.reset();
  alone.title_block.reset();
  if (view.view) {
    alone.view = view.view;
    alone.camera.reset();
    alone.layers.reset();
    alone.looks.reset();
    alone.light.reset();
  }
  if (view.camera) alone.camera = view.camera;
  alone.direction = view.direction;
  alone.normal = view.normal;
  alone.center = view.center;
  alone.scale = view.scale;
  alone.rollout = view.rollout;
  alone.dimensions = view.dimensions;
  if (!view.rollout) return alone;
  if (!view.camera) alone.camera.reset();  // of the figure
  alone.light.reset();
  alone.labels.reset();
  alone.areas = protocol::FigureRequestAreas::pixels;
  alone.tolerance_mm.reset();
  return alone;
}

// Reads a sheet with several views. All of them show the same state of the layers.
Result<FigureRequest> figure_of_views(const RouteContext& context, const Request& request,
                                      std::shared_ptr<room::Room> room,
                                      const protocol::FigureRequest& body) {
  STRATA_TRY(check_sheet_of_views(body));
  auto sheet = STRATA_TRY(figure_request(context, request, room, body));
  sheet.from = "views";
  for (std::size_t i = 0; i < body.views->size(); ++i) {
    const protocol::FigureView& view = (*body.views)[i];
    auto figure = figure_request(context, request, room, body_of_view(body, view));
    if (!figure) {
      const std::string at = "views[" + std::to_string(i) + "]";
      return at_field(figure.error(),
                      figure.error().field.empty() ? at : at + "." + figure.error().field);
    }
    figure->shown.at = sheet.shown.at;
    if (!figure->rollout) figure->shown.provisional = sheet.shown.provisional;
    figure->view_title = view.title.value_or(figure->view_title);
    sheet.views.push_back(std::move(*figure));
  }
  return sheet;
}

}  // namespace

Result<FigureRequest> read_figure_request(const RouteContext& context, const Request& request) {
  const auto body = STRATA_TRY(body_of<protocol::FigureRequest>(request));
  auto room = STRATA_TRY(open_room(context, request));
  const auto language = STRATA_TRY(requested_language(request));
  auto figure = body.views ? figure_of_views(context, request, std::move(room), body)
                           : figure_request(context, request, std::move(room), body);
  if (!figure) return figure;
  figure->language = language;
  for (FigureRequest& view : figure->views) view.language = language;
  return figure;
}

Result<FigureRequest> figure_request(const RouteContext& context, const Request& request,
                                     std::shared_ptr<room::Room> room,
                                     const protocol::FigureRequest& body) {
  FigureRequest figure;
  figure.room = std::move(room);
  figure.role = request.role();
  std::string view_name;  // empty without a saved view
  const auto camera = STRATA_TRY(read_shown(context, request, body, figure, view_name));
  if (body.rollout)
    STRATA_TRY(read_unrolled(body, figure));
  else
    STRATA_TRY(read_direction(body, camera, figure));
  const auto at = STRATA_TRY(find_sequence(context, *figure.room, body.at));
  // Selects the layers before it reads the state of the review. Otherwise, a layer that becomes
  // visible in the meantime would appear in the figure without marks.
  for (Layer& layer : figure.room->layers().all())
    if (figure.shown.shown.of(layer.id).visible.value_or(layer.visible))
      figure.layers.push_back(layer);
  room::sort_as_shown(figure.layers, figure.shown.shown);
  figure.shown.layers.emplace();
  for (const Layer& layer : figure.layers) figure.shown.layers->push_back(to_string(layer.id));
  if (at) {
    figure.shown.at = at;
  } else {
    room::DurableState newest = figure.room->edits().durable_state();
    figure.shown.at = newest.sequence;
    // A rollout does not mark edits that wait for review.
    if (!figure.rollout) figure.shown.provisional = std::move(newest.provisional);
  }
  figure.shown.shown.background = {kPaper, kPaper};
  STRATA_TRY(validate(figure.shown.shown.light));
  if (body.labels) STRATA_TRY(read_labels(context, *body.labels, figure));
  if (body.dimensions) STRATA_TRY(read_dimensions(*body.dimensions, figure));
  figure.scale = body.scale;
  figure.paper = static_cast<figure::Paper>(body.paper);
  if (body.orientation)
    figure.landscape = *body.orientation == protocol::FigureRequestOrientation::landscape;
  figure.dpi = body.dpi;
  figure.format = static_cast<figure::Format>(body.format.value_or(protocol::FigureFormat::pdf));
  STRATA_TRY(read_areas(body, figure));
  const Model model = figure.room->model();
  // In a DXF file, a legend and texts would only take space from the drawing.
  const bool has_sheet = figure.format != figure::Format::dxf;
  figure.legend = has_sheet && body.legend;
  if (has_sheet)
    figure.captions = {body.title.value_or(model.name), body.caption.value_or(""),
                       body.credit.value_or(model.credit), body.continued};
  if (has_sheet && body.title_block) {
    const auto block = STRATA_TRY(
        title_block(context, request, model, body.title.value_or(view_name), *body.title_block));
    figure.captions.block = block;
  }
  figure.view_title = std::move(view_name);
  figure.waiting_label = body.provisional;
  return figure;
}

}  // namespace strata::net
