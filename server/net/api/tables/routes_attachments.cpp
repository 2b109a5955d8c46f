#include <algorithm>

#include "app/change_notifier.h"
#include "core/no_such.h"
#include "domain/people/role.h"
#include "domain/tables/attachment.h"
#include "domain/tables/table.h"
#include "media/media_type.h"
#include "net/api/stored_file.h"
#include "net/auth/project_authorization.h"
#include "net/http/idempotency_store.h"
#include "net/http/upload.h"
#include "net/live/live_sockets.h"
#include "net/live/table_events.h"
#include "net/serialization/record_place.h"
#include "net/serialization/table_serialization.h"
#include "net/transport/server_options.h"
#include "store/store.h"
#include "store/tables/attachments.h"
#include "store/tables/table_changes.h"
#include "store/tables/tables.h"

namespace strata::net {
namespace {

using Attached = store::Attached;
using NewAttachment = store::NewAttachment;

constexpr const char* kAccepted =
    "Send the file as the body, with its `name` in the address, or send one or several files in a "
    "multipart/form-data form.";

bool is_shown_in_place(std::string_view media_type) {
  return is_raster_picture(media_type) || media_type == "application/pdf";
}

NewAttachment inspected(const Upload& upload, const std::string& requested_name) {
  const InspectedFile found =
      inspect_file(upload.file, requested_name.empty() ? upload.filename : requested_name);
  NewAttachment file;
  file.file = upload.file;
  file.name = found.name;
  file.media_type = found.media_type;
  file.width = found.width;
  file.height = found.height;
  return file;
}

nlohmann::json list_json(const std::vector<Attachment>& attachments) {
  nlohmann::json list = nlohmann::json::array();
  for (const Attachment& attachment : attachments) list.push_back(to_json(attachment));
  const std::size_t total = list.size();
  return {{"attachments", std::move(list)}, {"total", total}};
}

Result<Response> attach(const RouteContext& context, const Request& request) {
  auto key = STRATA_TRY(record_key(request));
  auto place = STRATA_TRY(record_place(context, request));
  std::optional<ColumnId> column_id;
  if (const std::string ref = request.query_or("column", {}); !ref.empty()) {
    const Column* column = find_column(place.table.columns, ref);
    if (!column)
      return fail(ErrorCode::invalid, "Column not found",
                  place.table.name + " has no column `" + ref.substr(0, 100) + "`.", "column");
    column_id = column->id;
  }
  auto version = STRATA_TRY(expected_record_version(context, request, place.table, key));
  auto uploads = STRATA_TRY(take_upload(request, context.options.upload_dir, kAccepted));
  const UploadedFiles cut_out(uploads, request.body_file);
  const std::string name = request.query_or("name", {});
  if (!name.empty() && uploads.size() > 1)
    return fail(ErrorCode::invalid, "Name given for several files",
                "You can use `name` only with a single file. In a form, each file has its own "
                "name.",
                "name");
  const auto visibility = parse_visibility(request.query_or("visibility", "public"));
  if (!visibility)
    return fail(ErrorCode::invalid, "Unknown visibility",
                "`visibility` must be public, team or private.", "visibility");
  std::vector<NewAttachment> files;
  for (const Upload& upload : uploads) {
    files.push_back(inspected(upload, name));
    files.back().visibility = *visibility;
  }
  const auto answer = [role = request.role()](const Attached& attached) {
    auto body = list_json(attached.attachments);
    body["record"] =
        to_json(attached.change.records.front(), seen_by(attached.change.table, role).columns);
    return json_response(body, 201)
        .with("Location", "/api/v1/attachments/" + to_string(attached.attachments.front().id))
        .with("ETag", etag_of(attached.change.records.front().version));
  };
  auto attached = STRATA_TRY(context.store.attachments().attach(
      place.table.id, key, column_id, files, version, request.author(),
      idempotent_response<Attached>(request, answer)));
  context.changes.records_changed(attached.change, request.user());
  return answer(attached);
}

// Lists the attachments by column. Within a column, the order is as in the record's value.
Result<Response> list_attachments(const RouteContext& context, const Request& request) {
  auto key = STRATA_TRY(record_key(request));
  auto place = STRATA_TRY(record_place(context, request));
  std::optional<std::int64_t> at;
  if (auto text = request.query.find("at"); text != request.query.end()) {
    auto sequence = STRATA_TRY(sequence_at(context.store, place.table, text->second));
    at = sequence;
  }
  Table then;
  auto record = STRATA_TRY(stored_record(context, place.table, request.role(), key, at, &then));
  std::vector<std::pair<AttachmentId, const Column*>> ids;
  std::vector<AttachmentId> requested_ids;
  for (const Column& column : then.columns) {
    if (!holds_attachments(column.kind)) continue;
    const auto cell = record.values.find(column.id);
    if (cell == record.values.end()) continue;
    for (const auto& id : cell->second) {
      ids.emplace_back(id.get<AttachmentId>(), &column);
      requested_ids.push_back(id.get<AttachmentId>());
    }
  }
  auto found =
      STRATA_TRY(context.store.attachments().of_table(then.id, request.author(), requested_ids));
  nlohmann::json list = nlohmann::json::array();
  for (const auto& [id, column] : ids)
    for (const Attachment& attachment : found)
      if (attachment.id == id) {
        list.push_back(to_json(attachment));
        list.back()["user"] = visible_name(request, attachment.user);
        list.back()["column"] = column->slug;
      }
  const std::size_t total = list.size();
  return json_response({{"attachments", std::move(list)}, {"total", total}})
      .with("ETag", etag_of(record.version));
}

Result<AttachmentId> attachment_id(const Request& request) {
  return id_of<AttachmentId>(request, "attachment");
}

Result<Response> read_attachment(const RouteContext& context, const Request& request) {
  auto id = STRATA_TRY(attachment_id(request));
  auto attachment = STRATA_TRY(context.store.attachments().find(id, request.author()));
  return stored_file_response(context, request,
                              {attachment.name, attachment.media_type, attachment.sha256,
                               attachment.bytes, is_shown_in_place(attachment.media_type)});
}

Result<Response> change_attachment(const RouteContext& context, const Request& request) {
  auto id = STRATA_TRY(attachment_id(request));
  auto attachment = STRATA_TRY(context.store.attachments().find(id, request.author()));
  if (request.role() < Role::curator && request.user() != attachment.user)
    return fail(ErrorCode::forbidden, "Not allowed",
                "Only curators and the person who attached a file can change its visibility.");
  auto body = STRATA_TRY(body_of<protocol::AttachmentPatch>(request));
  const auto answer = [](const Attachment& now) { return json_response(to_json(now)); };
  auto now = STRATA_TRY(context.store.attachments().show(
      id, body.visibility, idempotent_response<Attachment>(request, answer)));
  if (auto table = context.store.tables().find(to_string(now.table_id), Role::owner))
    tell_table(context.live_sockets, protocol::TableEventEvent::changed, *table, request.user());
  return answer(now);
}

Result<Response> detach(const RouteContext& context, const Request& request) {
  auto id = STRATA_TRY(attachment_id(request));
  STRATA_TRY(context.store.attachments().find(id, request.author()));
  const auto answer = [](const store::TableChange&) { return empty_response(204); };
  auto change = context.store.attachments().detach(
      id, request.user(), idempotent_response<store::TableChange>(request, answer));
  if (!change) return tl::unexpected(change.error());
  context.changes.records_changed(*change, request.user());
  return answer(*change);
}

}  // namespace

void add_attachment_routes(Router& router, const RouteContext& context) {
  for (const std::string parent :
       {"/api/v1/tables/{table}", "/api/v1/models/{model}/layers/{layer}"}) {
    const std::string attachments = parent + "/records/{key}/attachments";
    router.add({.method = Method::get,
                .pattern = attachments,
                .handler = answering([&context](const Request& request) {
                  return list_attachments(context, request);
                }),
                .query = {"at"}});
    router.add({.method = Method::post,
                .pattern = attachments,
                .handler = answering(
                    [&context](const Request& request) { return attach(context, request); }),
                .role = Role::annotator,
                .query = {"name", "column", "visibility"},
                .body = BodyKind::file,
                .max_body = context.options.max_upload_bytes,
                .keeps_answer = true});
  }
  const std::string attachment = "/api/v1/attachments/{attachment}";
  router.add({.method = Method::get,
              .pattern = attachment,
              .handler = answering(
                  [&context](const Request& request) { return read_attachment(context, request); }),
              .query = {"thumbnail"}});
  router.add({.method = Method::patch,
              .pattern = attachment,
              .handler = answering([&context](const Request& request) {
                return change_attachment(context, request);
              }),
              .role = Role::annotator,
              .body = BodyKind::memory,
              .max_body = context.options.max_json_bytes,
              .keeps_answer = true});
  router.add({.method = Method::remove,
              .pattern = attachment,
              .handler = answering(
                  [&context](const Request& request) { return detach(context, request); }),
              .role = Role::annotator,
              .keeps_answer = true});
}

}  // namespace strata::net
