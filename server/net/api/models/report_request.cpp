#include "net/api/models/report_request.h"

#include <algorithm>
#include <set>

#include "core/text/base64.h"
#include "domain/scene/model.h"
#include "net/api/addressed.h"
#include "net/api/models/figure_request.h"
#include "net/serialization/at_field.h"
#include "net/serialization/people_serialization.h"
#include "room/edits.h"
#include "room/layers.h"
#include "room/room.h"
#include "store/content/named_parts.h"
#include "store/store.h"
#include "store/tables/tables.h"

namespace strata::net {
namespace {

using app::ReportPart;
using app::ReportRequest;

constexpr std::size_t kMaxLogoBytes = 500'000;

// Formats, languages and sections have the same order in the API, so a cast converts them.
static_assert(
    static_cast<int>(protocol::ReportFormat::pdf) == static_cast<int>(app::ReportFormat::pdf) &&
    static_cast<int>(protocol::ReportLanguage::es) == static_cast<int>(app::ReportLanguage::es) &&
    static_cast<int>(protocol::ReportPart::provenance) == static_cast<int>(ReportPart::provenance));

const char* word_of(const app::ReportWords& words, protocol::FigureDirection direction) {
  switch (direction) {
    case protocol::FigureDirection::top: return words.top;
    case protocol::FigureDirection::bottom: return words.bottom;
    case protocol::FigureDirection::front: return words.front;
    case protocol::FigureDirection::back: return words.back;
    case protocol::FigureDirection::left: return words.left;
    case protocol::FigureDirection::right: return words.right;
  }
  return "";
}

Result<void> read_sections(const protocol::ReportRequest& body, ReportRequest& report) {
  if (!body.sections) {
    for (int part = 0; part <= static_cast<int>(ReportPart::provenance); ++part)
      report.sections.push_back({static_cast<ReportPart>(part), {}, {}});
    return {};
  }
  std::set<ReportPart> met;
  for (std::size_t i = 0; i < body.sections->size(); ++i) {
    const protocol::ReportSection& section = (*body.sections)[i];
    const auto part = static_cast<ReportPart>(section.part);
    if (!met.insert(part).second)
      return fail(ErrorCode::invalid, "Section appears twice",
                  "A report can contain each section once. Remove one of them.",
                  "sections[" + std::to_string(i) + "].part");
    report.sections.push_back({part, section.heading.value_or(""), section.text.value_or("")});
  }
  return {};
}

Result<void> read_logo(const std::string& text, ReportRequest& report) {
  auto bytes = from_base64(text);
  if (!bytes)
    return fail(ErrorCode::invalid, "Invalid logo", "The logo must be a file in base64.", "logo");
  if (bytes->size() > kMaxLogoBytes)
    return fail(ErrorCode::too_large, "Logo too large",
                "The logo can have at most 500 kB. Reduce the size of the picture.", "logo");
  report.logo = std::make_shared<const std::vector<std::uint8_t>>(std::move(*bytes));
  return {};
}

// Sets the layers of the report.
Result<void> read_layers(const protocol::ReportRequest& body, ReportRequest& report) {
  const std::vector<Layer> all = report.room->layers().all();
  if (!body.layers) {
    std::ranges::copy_if(all, std::back_inserter(report.layers), &Layer::visible);
  } else {
    std::vector<std::string> refs;
    for (const auto& ref : *body.layers) refs.push_back(protocol::to_ref(ref));
    const auto chosen = STRATA_TRY(find_layers(*report.room, refs, "layers"));
    std::ranges::copy_if(all, std::back_inserter(report.layers), [&](const Layer& layer) {
      return std::ranges::find(chosen, layer.id, &Layer::id) != chosen.end();
    });
  }
  return {};
}

// Returns the body of a figure with the layers of the report.
protocol::FigureRequest with_layers(const ReportRequest& report) {
  protocol::FigureRequest figure;
  figure.layers.emplace();
  for (const Layer& layer : report.room->layers().all()) {
    protocol::LayerOverride shown;
    shown.layer = layer.id.number();
    shown.visible = std::ranges::find(report.layers, layer.id, &Layer::id) != report.layers.end();
    figure.layers->push_back(std::move(shown));
  }
  figure.direction = protocol::FigureDirection::front;
  return figure;
}

Result<ReportRequest::MeasuredFigure> read_figure(const RouteContext& context,
                                                  const Request& request,
                                                  const ReportRequest& report,
                                                  const protocol::ReportFigure& body) {
  const app::ReportWords& words = app::words_in(report.language);
  protocol::FigureRequest figure;
  std::string name;
  if (body.view) {
    figure.view = body.view;
    const auto view = context.store.views().find(report.room->model().id, *body.view);
    if (!view) return at_field(view.error(), "view");
    name = view->name;
  } else {
    figure = with_layers(report);
    figure.direction = body.direction;
    name = word_of(words, *body.direction);
  }
  figure.scale = body.scale;
  figure.provisional = words.provisional;
  auto read = STRATA_TRY(figure_request(context, request, report.room, figure));
  read.language = words.tag;
  read.shown.at = report.shown.at;
  return ReportRequest::MeasuredFigure{std::move(read), body.caption.value_or(name)};
}

Result<void> read_figures(const RouteContext& context, const Request& request,
                          const protocol::ReportRequest& body, ReportRequest& report) {
  using enum protocol::FigureDirection;
  std::vector<protocol::ReportFigure> figures;
  if (body.figures)
    figures = *body.figures;
  else
    for (const auto direction : {front, right, back, left})
      figures.emplace_back().direction = direction;
  for (std::size_t i = 0; i < figures.size(); ++i) {
    auto figure = read_figure(context, request, report, figures[i]);
    if (!figure) {
      const std::string& part = figure.error().field;
      return at_field(figure.error(),
                      "figures[" + std::to_string(i) + "]" + (part.empty() ? "" : "." + part));
    }
    report.figures.push_back(std::move(*figure));
  }
  return {};
}

// Sets the states of the tables that the report shows.
Result<void> find_records_at(const RouteContext& context, const Request& request,
                             const std::vector<Layer>& layers, ReportRequest& report) {
  for (const Layer& layer : layers) {
    if (!layer.table || report.records_at.contains(*layer.table)) continue;
    const auto table =
        STRATA_TRY(context.store.tables().find(to_string(*layer.table), request.role()));
    report.records_at[table.id] = table.sequence;
  }
  return {};
}

}  // namespace

Result<ReportRequest> read_report_request(const RouteContext& context, const Request& request) {
  const auto body = STRATA_TRY(body_of<protocol::ReportRequest>(request));
  auto room = STRATA_TRY(open_room(context, request));
  ReportRequest report{.room = std::move(room), .reader = request.author()};
  report.format =
      static_cast<app::ReportFormat>(body.format.value_or(protocol::ReportFormat::docx));
  report.language =
      static_cast<app::ReportLanguage>(body.language.value_or(protocol::ReportLanguage::en));
  report.title = body.title.value_or(report.room->model().name);
  report.subject = body.subject.value_or("");
  report.author = body.author ? *body.author : written_name(context.store, request.user());
  for (const auto& field : body.fields.value_or(std::vector<protocol::ReportField>{}))
    report.fields.emplace_back(field.label, field.value);
  if (body.logo) STRATA_TRY(read_logo(*body.logo, report));
  STRATA_TRY(read_sections(body, report));
  STRATA_TRY(read_layers(body, report));
  // The settings of a drawing of the whole report: its layers, and its state.
  const auto drawing =
      STRATA_TRY(figure_request(context, request, report.room, with_layers(report)));
  report.shown = drawing.shown;
  report.layers = drawing.layers;  // from bottom to top
  STRATA_TRY(read_figures(context, request, body, report));
  STRATA_TRY(find_records_at(context, request, report.layers, report));
  for (const auto& figure : report.figures)  // views have their own layers
    STRATA_TRY(find_records_at(context, request, figure.request.layers, report));
  report.max_records = static_cast<std::size_t>(body.max_records);
  report.record_pictures = body.record_pictures;
  return report;
}

}  // namespace strata::net
