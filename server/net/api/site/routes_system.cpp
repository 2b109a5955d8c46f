#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <tuple>

#include "app/nodes/node_lease.h"
#include "core/log.h"
#include "core/memory_ledger.h"
#include "core/version.h"
#include "jobs/job_queue.h"
#include "net/api/metrics.h"
#include "net/api/problems_page.h"
#include "net/api/route_help.h"
#include "net/api/routes.h"
#include "net/http/question_desk.h"
#include "net/http/worker_pool.h"
#include "net/transport/server_options.h"
#include "render/renderer.h"
#include "room/rooms.h"
#include "store/cluster/archive_keeper.h"
#include "store/files/files.h"
#include "store/journal/journal_writer.h"
#include "store/store.h"

namespace strata::net {
namespace {

// Returns the size and the free space of the disk with the data. Both are 0 if they are unknown.
std::pair<std::uint64_t, std::uint64_t> disk_of(const std::filesystem::path& folder) {
  std::error_code unknown;
  const auto space = std::filesystem::space(folder, unknown);
  if (unknown) return {0, 0};
  return {space.capacity, space.available};
}

std::uint64_t resident_bytes() {
  std::uint64_t all_pages = 0, resident_pages = 0;
  std::ifstream("/proc/self/statm") >> all_pages >> resident_pages;
  return resident_pages * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
}

std::optional<NodeGauges> node_gauges(const RouteContext& context) {
  if (!context.options.lease) return std::nullopt;
  return NodeGauges{
      std::chrono::duration<double>(context.options.lease->left()).count(),
      context.rooms.models_moved(),
      context.rooms.followed_models(),
      context.rooms.follower_lag().count(),
  };
}

double seconds_since_1970(const std::optional<std::chrono::system_clock::time_point>& time) {
  return time ? std::chrono::duration<double>(time->time_since_epoch()).count() : 0;
}

std::optional<ArchiveGauges> archive_gauges(const RouteContext& context) {
  if (!context.options.archive) return std::nullopt;
  const auto status = context.options.archive->status();
  return ArchiveGauges{seconds_since_1970(status.archiver.archived),
                       seconds_since_1970(status.copied), status.archiver.failures,
                       status.failed_copies};
}

std::optional<FileGauges> file_gauges(const RouteContext& context) {
  if (!context.store.files().is_open()) return std::nullopt;
  const auto faults = context.store.files().faults();
  return FileGauges{faults.missing, faults.changed, faults.unreachable};
}

Gauges gauges_of(const RouteContext& context) {
  const store::JournalWriter& journal = context.rooms.journal();
  Gauges gauges{context.rooms.edit_timings(), context.renderer.frame_times(),
                journal.commit_times()};
  gauges.open_rooms = context.rooms.open_rooms();
  gauges.gpu_bytes = context.renderer.gpu_bytes_used();
  gauges.gpu_limit_bytes = context.renderer.gpu_bytes_limit();
  gauges.memory_bytes = context.rooms.memory_bytes_used();
  gauges.memory_limit_bytes = context.rooms.memory().budget();
  gauges.resident_bytes = resident_bytes();
  std::tie(gauges.disk_bytes, gauges.disk_free_bytes) = disk_of(context.options.upload_dir);
  gauges.waiting_requests = context.workers.waiting();
  gauges.waiting_questions = context.questions.waiting();
  gauges.questions_under_way = context.questions.under_way();
  gauges.question_steps = context.questions.steps();
  gauges.journal_waiting = journal.waiting();
  gauges.journal_failed_commits = journal.failed_commits();
  gauges.journal_accepting = journal.accepting();
  gauges.database_ready = context.store.ready();
  gauges.gpu_ready = context.renderer.ready();
  gauges.jobs = context.jobs.counts();
  gauges.node = node_gauges(context);
  gauges.archive = archive_gauges(context);
  gauges.files = file_gauges(context);
  return gauges;
}

log::Level level_of(protocol::LogLevel level) { return *log::level_named(name(level)); }

nlohmann::json levels_json(const log::Levels& levels) {
  nlohmann::json modules = nlohmann::json::array();
  for (std::size_t i = 0; i < log::kModules; ++i)
    if (const auto level = levels.of_modules[i])
      modules.push_back({{"module", log::kModuleNames[i]}, {"level", log::name(*level)}});
  return {{"default", log::name(levels.by_default)}, {"modules", std::move(modules)}};
}

Result<Response> set_log_levels(const Request& request) {
  const auto body = STRATA_TRY(body_of<protocol::LogLevels>(request));
  log::Levels levels;
  levels.by_default = level_of(body.default_value);
  for (const auto& [module, level] : body.modules) {
    auto& own = levels.of_modules[static_cast<std::size_t>(*log::module_named(name(module)))];
    if (own)
      return fail(ErrorCode::invalid, "Module listed twice",
                  "Send only one log level for the module " + std::string(name(module)) + ".",
                  "modules");
    own = level_of(level);
  }
  log::set_levels(levels);
  log::info(request.user() + " set the log levels to " + log::to_string(levels));
  return json_response(levels_json(levels));
}

Response readiness(const RouteContext& context) {
  nlohmann::json reasons = nlohmann::json::array();
  if (!context.store.ready()) reasons.push_back("The database does not answer.");
  if (!context.renderer.ready())
    reasons.push_back("The server lost the graphics context and cannot restore it yet.");
  if (const app::NodeLease* lease = context.options.lease) {
    if (lease->draining()) reasons.push_back("The node is stopping.");
    if (!lease->holds())
      reasons.push_back("The node has no lease, because it cannot renew it in the database.");
  }
  const bool ready = reasons.empty();
  return json_response({{"ready", ready}, {"reasons", reasons}}, ready ? 200 : 503);
}

// Adds a tag with a hash of the response's bytes. Returns 304 to a client that already has them.
Response revalidated(Response response, const Request& request) {
  const auto tag = tag_of_body(response).value_or("");
  response.with("ETag", tag).with("Cache-Control", "no-cache");
  return names_tag(request.header("if-none-match"), tag) ? not_modified(response)
                                                         : std::move(response);
}

Result<Response> contract(const RouteContext& context, const Request& request) {
  std::ifstream file(context.options.protocol_dir / "openapi.json", std::ios::binary);
  if (!file)
    return fail(ErrorCode::unavailable, "API description missing",
                "This installation does not contain openapi.json.");
  std::ostringstream text;
  text << file.rdbuf();
  return revalidated(text_response(std::move(text).str(), "application/json"), request);
}

}  // namespace

void add_system_routes(Router& router, const RouteContext& context) {
  auto open = [&](std::string pattern, std::function<Result<Response>(const Request&)> answer) {
    router.add({.method = Method::get,
                .pattern = std::move(pattern),
                .handler = answering(std::move(answer)),
                .role = std::nullopt});
  };
  open("/livez", [](const Request&) -> Result<Response> {
    return text_response("ok\n", "text/plain; charset=utf-8");
  });
  open("/readyz", [&context](const Request&) -> Result<Response> { return readiness(context); });
  open("/api/v1/version", [](const Request& request) -> Result<Response> {
    return revalidated(json_response({{"version", version()}}), request);
  });
  open("/metrics", [&context](const Request&) -> Result<Response> {
    return text_response(metrics_text(context.metrics, gauges_of(context)),
                         "text/plain; version=0.0.4; charset=utf-8");
  });
  router.add({.method = Method::get,
              .pattern = "/api/v1/log-levels",
              .handler = answering([](const Request&) -> Result<Response> {
                return json_response(levels_json(log::levels()));
              }),
              .role = Role::administrator});
  router.add({.method = Method::put,
              .pattern = "/api/v1/log-levels",
              .handler = answering(set_log_levels),
              .role = Role::administrator,
              .body = BodyKind::memory,
              .max_body = context.options.max_json_bytes});
  open("/api/v1/openapi.json",
       [&context](const Request& request) { return contract(context, request); });
  open("/problems", [](const Request&) -> Result<Response> {
    return text_response(problems_html(), "text/html; charset=utf-8");
  });
}

}  // namespace strata::net
