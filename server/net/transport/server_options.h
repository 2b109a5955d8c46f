#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "net/live/live_limits.h"
#include "sign_on/config.h"

namespace strata::app {
class NodeLease;
}
namespace strata::store {
class ArchiveKeeper;
}

namespace strata::net {

// The times that the server waits for clients.
struct Timeouts {
  std::chrono::seconds head{10};     // from connecting to the end of the first request head
  std::chrono::seconds idle{60};     // until the next request head, or until the response to a ping
  std::chrono::seconds stall{60};    // without progress of a body or response
  std::chrono::seconds recheck{30};  // between checks that a connected user is still signed in
};

struct ServerOptions {
  std::string host = "127.0.0.1";            // IPv6 addresses without brackets
  std::uint16_t port = 8080;                 // 0: any free port
  std::vector<std::string> allowed_origins;  // further origins: "https://museum.example"
  std::filesystem::path static_dir;          // the built page (web-client/dist)
  std::filesystem::path protocol_dir;        // contains openapi.json
  std::filesystem::path templates_dir;       // templates of tables and layers; empty: no templates
  std::filesystem::path upload_dir;          // unfinished uploads; deleted when the server starts
  std::filesystem::path tls_chain, tls_key;  // PEM files; empty: plain HTTP
  std::string owner_token;                   // STRATA_OWNER_TOKEN: empty or at least 32 characters
  std::vector<sign_on::Provider> sign_on_providers;  // OpenID Connect
  bool local_accounts = true;                        // users can sign in with passwords
  int http_threads = 2;                              // threads for sockets, which never block
  int worker_threads = 8;                            // threads for work that blocks
  int question_threads = 8;                // threads for questions; each user gets only a few
  int query_threads = 2;                   // threads for picks of live connections
  std::size_t max_waiting_requests = 256;  // further requests get a 503
  std::size_t max_connections = 2048;
  std::uint64_t max_upload_bytes = 8ull << 30;
  std::uint64_t max_rasters_at_once = 2ull << 30;  // bytes of all rasters being read or written
  std::uint64_t max_json_bytes = 1u << 20;
  std::uint64_t max_positions_bytes = 16u << 20;
  double requests_per_second = 1000;  // per connection
  double request_burst = 2000;
  int trash_days = 30;   // days until deleted entities are erased; 0: immediately
  int audit_days = 730;  // days until rows of the audit log are deleted; 0: never
  int file_days = 30;    // days until files outside the database that nothing uses are deleted
  // Time from the end of a stroke until its batches become one edit of the journal. 0: never.
  std::chrono::seconds merge_after{60};
  // Requests that take longer, without the transfer of bodies, are logged. 0: no limit.
  std::chrono::milliseconds slow_after{1000};
  Timeouts timeouts;
  LiveLimits live;
  const app::NodeLease* lease = nullptr;          // null: the server runs alone
  const store::ArchiveKeeper* archive = nullptr;  // null: the server has no archive
};

}  // namespace strata::net
