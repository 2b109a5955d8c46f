#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <optional>
#include <string>

#include "app/edits.h"
#include "core/error.h"
#include "core/histogram.h"
#include "room/edit_timings.h"

namespace strata::net {

// Counters of the module `net`. All threads may change them.
struct Metrics {
  std::array<std::atomic<std::uint64_t>, 6> requests{};  // indexed by the first digit of the status
  std::atomic<std::int64_t> open_connections{0};
  std::atomic<std::int64_t> open_sockets{0};  // open WebSockets
  app::EditCounters edits;
  std::atomic<std::uint64_t> frames_sent{0}, frame_bytes_sent{0};
  std::atomic<std::uint64_t> messages_received{0}, messages_refused{0};
  // The number of messages of other nodes, and of the failures that may lose messages.
  std::atomic<std::uint64_t> node_messages{0}, node_messages_missed{0};
  Histogram node_message_ages;                   // time from a change until its message was handled
  std::atomic<std::uint64_t> questions_left{0};  // the client disconnected before the response
  // The expiry of the TLS certificate, in seconds since 1970. 0: the server uses plain HTTP.
  std::atomic<std::int64_t> certificate_end{0};

  std::array<std::atomic<std::uint64_t>, static_cast<std::size_t>(kLastErrorCode) + 1> problems{};
  Histogram request_times;  // time to the response, without the time to receive the body

  void count_problem(ErrorCode code) { ++problems[static_cast<std::size_t>(code)]; }
  void count_request(int status) { ++requests[status >= 100 && status < 600 ? status / 100 : 0]; }
};

// Values of a node in a site with several nodes.
struct NodeGauges {
  double lease_s = 0;  // seconds until the lease ends
  std::uint64_t models_moved = 0;
  std::size_t followed_models = 0;  // open models of other nodes
  double follower_lag_s = 0;        // seconds since all of them were up to date
};

// Values of a server with an archive (store/cluster/archive_keeper.h). Times are in seconds since
// 1970, or 0 before the first event.
struct ArchiveGauges {
  double archived_s = 0, copied_s = 0;
  std::uint64_t failed_segments = 0, failed_copies = 0;
};

// Failed reads of files outside the database (store/files/files.h).
struct FileGauges {
  std::uint64_t missing = 0, changed = 0, unreachable = 0;
};

// The values of other modules. The histograms must exist during the call of `metrics_text`.
struct Gauges {
  const room::EditTimings& edits;
  const Histogram& frames;
  const Histogram& commits;
  std::size_t open_rooms = 0;
  std::uint64_t gpu_bytes = 0, gpu_limit_bytes = 0, memory_bytes = 0, memory_limit_bytes = 0;
  std::uint64_t resident_bytes = 0;                   // of the process
  std::uint64_t disk_bytes = 0, disk_free_bytes = 0;  // 0: unknown
  std::size_t waiting_requests = 0;
  std::size_t waiting_questions = 0, questions_under_way = 0;
  std::uint64_t question_steps = 0;
  std::optional<NodeGauges> node{};        // empty if the server runs alone
  std::optional<ArchiveGauges> archive{};  // empty if the server has no archive
  std::optional<FileGauges> files{};       // empty if all content is in the database
  std::size_t journal_waiting = 0;
  std::uint64_t journal_failed_commits = 0;
  bool journal_accepting = false, database_ready = false, gpu_ready = false;
  std::array<std::size_t, 5> jobs{};  // by jobs::JobState
};

// Returns the metrics in the Prometheus text format 0.0.4.
std::string metrics_text(const Metrics& metrics, const Gauges& gauges);

}  // namespace strata::net
