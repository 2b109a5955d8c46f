// The metadata of a project for a repository, its citation, and deposits. Viewers can read them,
// and curators can change them.
#include <array>
#include <memory>
#include <utility>

#include "app/deposit/citation.h"
#include "app/deposit/datacite.h"
#include "app/deposit/deposit.h"
#include "app/deposit/metadata.h"
#include "domain/people/role.h"
#include "domain/scene/model.h"
#include "jobs/job_queue.h"
#include "net/api/addressed.h"
#include "net/api/annotated_routes.h"
#include "net/api/routes.h"
#include "net/auth/project_authorization.h"
#include "net/http/idempotency_store.h"
#include "net/http/job_idempotency.h"
#include "net/transport/server_options.h"
#include "store/content/metadata.h"
#include "store/store.h"

namespace strata::net {
namespace {

nlohmann::json metadata_json(const protocol::DepositRecord& record, std::int64_t version) {
  return {{"record", protocol::to_json(record)},
          {"missing", app::missing_for_doi(record)},
          {"version", version}};
}

// Viewers may not see the people of a project, so only curators get a proposal with them.
Result<app::ProjectMetadata> metadata_for(const RouteContext& context, const Request& request,
                                          const Project& project) {
  return app::metadata_of(context.store, project, request.role() >= Role::curator);
}

Result<Response> get_metadata(const RouteContext& context, const Request& request) {
  const auto project = STRATA_TRY(stored_project(context, request));
  const auto metadata = STRATA_TRY(metadata_for(context, request, project));
  return with_etag(json_response(metadata_json(metadata.record, metadata.version)), request,
                   metadata.version);
}

Result<Response> replace_metadata(const RouteContext& context, const Request& request) {
  const auto body = STRATA_TRY(body_of<protocol::DepositRecord>(request));
  const auto project = STRATA_TRY(stored_project(context, request));
  const auto before = STRATA_TRY(context.store.metadata().of_project(project.id));
  STRATA_TRY(check_if_match(request, before.version));
  const auto record = STRATA_TRY(app::checked_metadata(body));
  const auto answer = [&record](const store::StoredMetadata& now) {
    return json_response(metadata_json(record, now.version)).with("ETag", etag_of(now.version));
  };
  const auto changed = STRATA_TRY(context.store.metadata().replace(
      project.id, protocol::to_json(record), before.version,
      idempotent_response<store::StoredMetadata>(request, answer)));
  return answer(changed);
}

struct CitationFormat {
  const char* name;
  const char* media_type;
  const char* extension;
  std::string (*write)(const protocol::DepositRecord&, const std::string& key);
};
constexpr std::array kCitationFormats{
    CitationFormat{"text", "text/plain; charset=utf-8", "txt",
                   [](const protocol::DepositRecord& record, const std::string&) {
                     return app::citation_text(record);
                   }},
    CitationFormat{"bibtex", "application/x-bibtex", "bib", app::bibtex},
    CitationFormat{
        "ris", "application/x-research-info-systems", "ris",
        [](const protocol::DepositRecord& record, const std::string&) { return app::ris(record); }},
    CitationFormat{"csl", "application/vnd.citationstyles.csl+json", "json",
                   [](const protocol::DepositRecord& record, const std::string& key) {
                     return app::csl_json(record, key).dump(2);
                   }},
    CitationFormat{"datacite", "application/vnd.datacite.datacite+json", "json",
                   [](const protocol::DepositRecord& record, const std::string&) {
                     return app::datacite_json(record).dump(2);
                   }},
    CitationFormat{"datacite-xml", "application/vnd.datacite.datacite+xml", "xml",
                   [](const protocol::DepositRecord& record, const std::string&) {
                     return app::datacite_xml(record);
                   }},
    CitationFormat{"jsonld", "application/ld+json", "jsonld",
                   [](const protocol::DepositRecord& record, const std::string&) {
                     return app::schema_org(record).dump(2);
                   }}};

Result<Response> get_citation(const RouteContext& context, const Request& request) {
  const std::string wanted = request.query_or("f", "text");
  for (const CitationFormat& format : kCitationFormats) {
    if (wanted != format.name) continue;
    const auto project = STRATA_TRY(stored_project(context, request));
    const auto metadata = STRATA_TRY(metadata_for(context, request, project));
    Response response =
        text_response(format.write(metadata.record, project.slug), format.media_type);
    if (wanted != "text") name_download(response, project.slug + "." + format.extension);
    return response;
  }
  return fail(ErrorCode::invalid, "Unknown format",
              "`f` must be text, bibtex, ris, csl, datacite, datacite-xml or jsonld.", "f");
}

std::string listed(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "`" : ", `") + name + "`";
  return text;
}

Result<Response> make_deposit(const RouteContext& context, JobIdempotency& book,
                              const Request& request) {
  const auto project = STRATA_TRY(stored_project(context, request));
  const auto metadata = STRATA_TRY(metadata_for(context, request, project));
  const auto missing = app::missing_for_doi(metadata.record);
  if (!missing.empty())
    return fail(ErrorCode::invalid, "Metadata incomplete",
                "A deposit needs more metadata. Set " + listed(missing) + " of the project first.",
                missing.front());
  const auto known = STRATA_TRY(book.find(request));
  if (known) return std::move(job_response(context, *known).with("Idempotency-Replayed", "true"));
  const auto job = STRATA_TRY(context.jobs.add(
      project.id,
      [&services = static_cast<const app::Services&>(context),
       deposit =
           app::DepositRequest{project, Author(request.user(), request.role()), metadata.record},
       folder = context.options.upload_dir](Progress& progress) -> Result<jobs::JobResult> {
        jobs::JobResult result{ModelId()};
        result.file = STRATA_TRY(app::make_deposit(services, deposit, folder, progress));
        return result;
      },
      request.user(), jobs::JobKind::figure));
  book.started(request, job);
  return job_response(context, job);
}

}  // namespace

void add_metadata_routes(Router& router, const RouteContext& context) {
  AnnotatedRoutes routes(router, context, Role::curator);
  const std::string project = "/api/v1/projects/{project}", metadata = project + "/metadata";
  routes.read(metadata, get_metadata);
  routes.change(Method::put, metadata, replace_metadata);
  routes.read(project + "/citation", get_citation, {"f"});
  auto book = std::make_shared<JobIdempotency>(context.jobs);
  router.add({.method = Method::post,
              .pattern = project + "/deposits",
              .handler = answering([&context, book](const Request& request) {
                return make_deposit(context, *book, request);
              }),
              .role = Role::curator});
}

}  // namespace strata::net
