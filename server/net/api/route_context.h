#pragma once

#include "app/services.h"

namespace strata {
namespace jobs {
class JobQueue;
}
namespace render {
class Renderer;
}
namespace app {
class TrashPurger;
class TemplateRegistry;
class BrushShapeCache;
}  // namespace app
}  // namespace strata

namespace strata::net {

class Authenticator;
class EditIdempotency;
class LiveSockets;
class QuestionDesk;
class WorkerPool;
struct Metrics;
struct ServerOptions;

// The services that use cases need, and the services that only handlers need. Lives as long as the
// router. A file that uses a service includes its header.
struct RouteContext : app::Services {
  const ServerOptions& options;
  jobs::JobQueue& jobs;
  render::Renderer& renderer;
  Authenticator& auth;
  EditIdempotency& edit_idempotency;
  LiveSockets& live_sockets;
  Metrics& metrics;
  WorkerPool& workers;
  QuestionDesk& questions;
  app::BrushShapeCache& tools;
  const app::TemplateRegistry& templates;
  app::TrashPurger& trash_purger;
};

}  // namespace strata::net
