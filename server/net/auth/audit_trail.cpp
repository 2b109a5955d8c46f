#include "net/auth/audit_trail.h"

#include "core/text/percent.h"
#include "core/text/slug.h"
#include "core/text/utf8.h"
#include "net/api/route_context.h"
#include "net/auth/login_throttle.h"
#include "net/auth/project_authorization.h"
#include "store/people/audit.h"
#include "store/store.h"

namespace strata::net {
namespace {

constexpr std::string_view kAttachment = "attachment";
constexpr std::string_view kFileName = "filename*=UTF-8''";
constexpr std::size_t kMaxPath = 500;  // bytes of the path and of the media type in the log
constexpr std::size_t kMaxIdLength = 18;

// The parameters of a path that can name the downloaded object. Uses the first match.
constexpr const char* kSubjects[] = {"layer", "attachment", "table", "job", "model", "project"};

std::string attached_name(const Response& response) {
  const std::string_view header = response.header("Content-Disposition");
  const auto at = header.find(kFileName);
  if (at == std::string_view::npos) return {};
  return percent_decode(header.substr(at + kFileName.size())).value_or(std::string());
}

std::string cut_text(std::string_view text) { return mended_utf8(text.substr(0, kMaxPath)); }

bool is_export(const Request& request, const Response& response) {
  if (request.method == Method::head || (response.status != 200 && response.status != 206))
    return false;
  // A client may fetch a large file in many parts. The audit log contains only the first part.
  if (response.status == 206 && !response.header("Content-Range").starts_with("bytes 0-"))
    return false;
  return response.header("Content-Disposition").starts_with(kAttachment);
}

}  // namespace

store::Actor actor_of(const Request& request) {
  store::Actor actor;
  actor.address = address_of(request);
  if (!request.principal) return actor;
  const Principal& who = *request.principal;
  // The owner's token has no id.
  const bool is_token = who.is_script || who.secret == 0;
  actor.kind = who.kiosk ? "kiosk" : is_token ? "token" : "person";
  actor.name = who.user;
  return actor;
}

store::Actor signing_in(const Request& request, std::string way, std::string user) {
  store::Actor actor;
  if (!user.empty()) actor.kind = way == "link" || way == "invitation" ? "link" : "person";
  actor.name = std::move(user);
  actor.address = address_of(request);
  actor.sign_in = std::move(way);
  return actor;
}

Result<void> audit_export(const RouteContext& context, const Request& request,
                          const Response& response) {
  if (!is_export(request, response)) return {};
  store::AuditExport data;
  data.kind = "site";
  for (const char* param : kSubjects) {
    const auto found = request.params.find(param);
    if (found == request.params.end()) continue;
    data.kind = param;
    if (is_all_digits(found->second) && found->second.size() <= kMaxIdLength)
      data.id = std::stoll(found->second);
    break;
  }
  data.file = attached_name(response);
  data.project = STRATA_TRY(addressed_project(context, request));
  data.details = {{"path", cut_text(request.path)},
                  {"type", cut_text(response.header("Content-Type"))}};
  return context.store.audit().exported(data);
}

}  // namespace strata::net
