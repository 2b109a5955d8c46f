#include "net/auth/kiosk_authorization.h"

#include <algorithm>
#include <limits>
#include <set>

#include "domain/layers/layer.h"
#include "domain/people/role.h"
#include "domain/tables/table.h"
#include "net/auth/project_authorization.h"
#include "store/content/layers.h"
#include "store/content/models.h"
#include "store/content/named_parts.h"
#include "store/store.h"
#include "store/tables/attachments.h"
#include "store/tables/tables.h"

namespace strata::net {
namespace {

// The only routes that kiosks may use. All of them only read. A new route is closed to kiosks
// unless it is added here.
constexpr std::string_view kOpen[] = {
    "/api/v1/kiosk",
    "/api/v1/models/{model}",
    "/api/v1/models/{model}/live",
    "/api/v1/models/{model}/layers",
    "/api/v1/models/{model}/layers/{layer}",
    "/api/v1/models/{model}/layers/{layer}/records/{key}",
    "/api/v1/models/{model}/layers/{layer}/records/{key}/attachments",
    "/api/v1/models/{model}/looks",
    "/api/v1/models/{model}/looks/{look}",
    "/api/v1/models/{model}/views",
    "/api/v1/models/{model}/views/{view}",
    "/api/v1/models/{model}/views/{view}/picture",
    "/api/v1/models/{model}/tours/{tour}",
    "/api/v1/models/{model}/tours/{tour}/files/{file}",
    "/api/v1/tables/{table}",
    "/api/v1/tables/{table}/columns",
    "/api/v1/tables/{table}/records/{key}",
    "/api/v1/tables/{table}/records/{key}/attachments",
    "/api/v1/tables/{table}/terms",
    "/api/v1/attachments/{attachment}",
};

using Tables = std::set<TableId>;

// Returns the tables of the model's public layers and of the tour. Includes the term lists that the
// public columns of these tables use.
Result<Tables> tables_of(const RouteContext& context, const KioskPass& kiosk) {
  const auto layers = STRATA_TRY(context.store.layers().of_model(kiosk.model, Role::viewer));
  const auto tour = STRATA_TRY(context.store.tours().find(kiosk.model, to_string(kiosk.tour)));
  Tables tables;
  for (const Layer& layer : layers)
    if (layer.table) tables.insert(*layer.table);
  for (const nlohmann::json& stop : tour.content.at("stops"))
    for (const nlohmann::json& records : stop.at("records"))
      tables.insert(records.at("table").get<TableId>());
  Tables with_terms = tables;
  for (const TableId id : tables) {
    const auto table = context.store.tables().find(to_string(id), Role::viewer);
    if (!table && table.error().code == ErrorCode::not_found) continue;
    if (!table) return tl::unexpected(table.error());
    for (const Column& column : table->columns)
      if (column.kind == ColumnKind::term && column.target) with_terms.insert(*column.target);
  }
  return with_terms;
}

Result<bool> has_table(const RouteContext& context, const KioskPass& kiosk,
                       const std::string& ref) {
  const auto table = context.store.tables().find(ref, Role::viewer);
  if (!table)
    return table.error().code == ErrorCode::not_found ? Result<bool>(false)
                                                      : tl::unexpected(table.error());
  const auto tables = STRATA_TRY(tables_of(context, kiosk));
  return tables.contains(table->id);
}

// A path parameter, and the check whether the kiosk can see the entity that it names.
struct Place {
  const char* param;
  Result<bool> (*is_own)(const RouteContext& context, const KioskPass& kiosk,
                         const std::string& ref);
};
constexpr Place kPlaces[] = {
    {"model",
     [](const RouteContext& context, const KioskPass& kiosk,
        const std::string& ref) -> Result<bool> {
       const auto model = context.store.models().find(ref);
       if (!model && model.error().code != ErrorCode::not_found)
         return tl::unexpected(model.error());
       return model && model->id == kiosk.model;
     }},
    {"tour",
     [](const RouteContext& context, const KioskPass& kiosk,
        const std::string& ref) -> Result<bool> {
       const auto tour = context.store.tours().find(kiosk.model, ref);
       if (!tour && tour.error().code != ErrorCode::not_found) return tl::unexpected(tour.error());
       return tour && tour->id == kiosk.tour;
     }},
    {"table", has_table},
    {"attachment",
     [](const RouteContext& context, const KioskPass& kiosk,
        const std::string& ref) -> Result<bool> {
       const auto id = parse_integer(ref, 1, std::numeric_limits<std::int64_t>::max(), {});
       if (!id) return false;
       const auto attachment =
           context.store.attachments().find(AttachmentId(*id), {{}, Role::viewer});
       if (!attachment)
         return attachment.error().code == ErrorCode::not_found
                    ? Result<bool>(false)
                    : tl::unexpected(attachment.error());
       return has_table(context, kiosk, to_string(attachment->table_id));
     }},
};

}  // namespace

Result<void> enter_as_kiosk(const RouteContext& context, Request& request, const Route& route) {
  Principal& who = *request.principal;
  if (route.method != Method::get || std::ranges::find(kOpen, route.pattern) == std::end(kOpen))
    return fail(ErrorCode::forbidden, "Not allowed for kiosks",
                "A kiosk can only read the content of its tour. It cannot change anything.");
  who.role = Role::viewer;
  for (const Place& place : kPlaces) {
    const auto param = request.params.find(place.param);
    if (param == request.params.end()) continue;
    const auto own = STRATA_TRY(place.is_own(context, *who.kiosk, param->second));
    if (!own) return no_such(place.param, param->second);
  }
  return {};
}

bool may_send_as_kiosk(const protocol::ClientMessage& message) {
  using namespace protocol;
  return std::holds_alternative<Hello>(message) || std::holds_alternative<CameraUpdate>(message) ||
         std::holds_alternative<LayersUpdate>(message) || std::holds_alternative<Ack>(message) ||
         std::holds_alternative<Pick>(message);
}

std::optional<protocol::ServerMessage> filtered_for_kiosk(const protocol::ServerMessage& message) {
  using namespace protocol;
  ServerMessage filtered = message;
  const auto without_user = [&](auto* event) {
    if (event) event->user.reset();
    return event != nullptr;
  };
  if (auto* layer = std::get_if<LayerEvent>(&filtered))
    layer->review.reset();  // contains user names
  if (without_user(std::get_if<LayerEvent>(&filtered)) ||
      without_user(std::get_if<ViewEvent>(&filtered)) ||
      std::holds_alternative<Welcome>(filtered) || std::holds_alternative<LookEvent>(filtered) ||
      std::holds_alternative<ModelEvent>(filtered) || std::holds_alternative<Picked>(filtered) ||
      std::holds_alternative<DatabaseState>(filtered) ||
      std::holds_alternative<ProblemMessage>(filtered))
    return filtered;
  return std::nullopt;
}

}  // namespace strata::net
