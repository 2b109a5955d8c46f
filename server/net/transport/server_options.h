#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "net/live/live_limits.h"

namespace strata::net {

// How long the server waits for clients.
struct Timeouts {
  std::chrono::seconds head{10};     // from the connect to the end of the first request head
  std::chrono::seconds idle{60};     // for the next head, and for the answer to a ping
  std::chrono::seconds stall{60};    // for a body or answer without progress
  std::chrono::seconds recheck{30};  // between checks that a connected user is still signed in
};

struct ServerOptions {
  std::string host = "127.0.0.1";            // IPv6 without brackets
  std::uint16_t port = 8080;                 // 0: any free one
  std::vector<std::string> allowed_origins;  // additional: "https://museum.example"
  std::filesystem::path static_dir;          // the built page (web-client/dist)
  std::filesystem::path protocol_dir;        // folder of openapi.json
  std::filesystem::path templates_dir;       // of tables and layers; empty: no templates
  std::filesystem::path upload_dir;          // unfinished uploads; emptied at start
  std::filesystem::path tls_chain, tls_key;  // PEM; empty: plain HTTP
  std::string owner_token;                   // STRATA_OWNER_TOKEN: empty or at least 32 characters
  int http_threads = 2;                      // for sockets; never block
  int worker_threads = 8;                    // for work that blocks
  int question_threads = 8;                  // for questions; a few per user at once
  int query_threads = 2;                     // for picks of the live connections
  std::size_t max_waiting_requests = 256;    // more get a 503
  std::size_t max_connections = 2048;
  std::uint64_t max_upload_bytes = 8ull << 30;
  std::uint64_t max_rasters_at_once = 2ull << 30;  // bytes of those being read and written
  std::uint64_t max_json_bytes = 1u << 20;
  std::uint64_t max_positions_bytes = 16u << 20;
  double requests_per_second = 1000;  // per connection
  double request_burst = 2000;
  int trash_days = 30;  // how long deleted entities can be restored; 0: erased at once
  Timeouts timeouts;
  LiveLimits live;
};

}  // namespace strata::net
