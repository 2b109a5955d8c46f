// Figures and condition reports, which are files for one user.
#include "app/figures/figures.h"
#include "app/reports/report.h"
#include "net/api/models/figure_request.h"
#include "net/api/models/made_file.h"
#include "net/api/models/report_request.h"
#include "net/transport/server_options.h"

namespace strata::net {
namespace {

// The memory for simultaneous drawings. An A3 drawing at 600 dpi needs 260 MB.
constexpr std::uint64_t kFigureBytes = 320u << 20;

Result<Response> answer_figure(const RouteContext& context,
                               const std::shared_ptr<ByteBudget>& budget, const Request& request) {
  auto figure = STRATA_TRY(read_figure_request(context, request));
  const auto room = figure.room;
  const std::int64_t sequence = *figure.shown.at;
  return respond_with_file(context, request, *room, sequence,
                           [&context, budget, figure = std::move(figure)](Progress& progress) {
                             const auto& folder = context.options.upload_dir;
                             return app::make_figure(context, *budget, figure, folder, progress);
                           });
}

Result<Response> answer_report(const RouteContext& context,
                               const std::shared_ptr<ByteBudget>& budget, const Request& request) {
  auto report = STRATA_TRY(read_report_request(context, request));
  const auto room = report.room;
  const std::int64_t sequence = *report.shown.at;
  return respond_with_file(context, request, *room, sequence,
                           [&context, budget, report = std::move(report)](Progress& progress) {
                             return app::make_report(context, *budget, report,
                                                     context.options.upload_dir, progress);
                           });
}

}  // namespace

void add_figure_routes(Router& router, const RouteContext& context) {
  const auto budget = std::make_shared<ByteBudget>(kFigureBytes);
  router.add({.method = Method::post,
              .pattern = "/api/v1/models/{model}/figures",
              .handler = answering([&context, budget](const Request& request) {
                return answer_figure(context, budget, request);
              }),
              .query = {"lang"},
              .body = BodyKind::memory,
              .max_body = context.options.max_json_bytes,
              .is_question = true});
  router.add({.method = Method::post,
              .pattern = "/api/v1/models/{model}/report",
              .handler = answering([&context, budget](const Request& request) {
                return answer_report(context, budget, request);
              }),
              .body = BodyKind::memory,
              .max_body = context.options.max_json_bytes,
              .is_question = true});
}

}  // namespace strata::net
