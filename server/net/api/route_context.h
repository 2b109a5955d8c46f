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
class BinKeeper;
class TemplateShelf;
class ToolShelf;
}  // namespace app
}  // namespace strata

namespace strata::net {

class Authenticator;
class EditBook;
class LiveSockets;
class QuestionDesk;
class WorkerPool;
struct Metrics;
struct ServerOptions;

// What use cases work with, and what handlers need beside it. Lives as long as the router. Who uses
// a part includes its header.
struct RouteContext : app::Services {
  const ServerOptions& options;
  jobs::JobQueue& jobs;
  render::Renderer& renderer;
  Authenticator& auth;
  EditBook& edit_book;
  LiveSockets& live_sockets;
  Metrics& metrics;
  WorkerPool& workers;
  QuestionDesk& questions;
  app::ToolShelf& tools;
  const app::TemplateShelf& templates;
  app::BinKeeper& bin_keeper;
};

}  // namespace strata::net
