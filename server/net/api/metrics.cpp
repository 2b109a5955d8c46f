#include "net/api/metrics.h"

#include <sstream>
#include <string_view>

#include "core/version.h"

namespace strata::net {
namespace {

constexpr std::string_view kJobStates[] = {"queued", "running", "done", "failed", "cancelled"};

// Writes the lines of one metric after another.
class MetricsWriter {
 public:
  // A rate is the difference of two sums, so a long-running server needs many digits.
  MetricsWriter() { text_.precision(15); }
  void head(std::string_view name, std::string_view type, std::string_view help) {
    text_ << "# HELP " << name << ' ' << help << "\n# TYPE " << name << ' ' << type << '\n';
  }
  // `labels` has the form `{name="value"}`, or is empty.
  template <class Value>
  void value(std::string_view name, std::string_view labels, const Value& value) {
    text_ << name << labels << ' ' << value << '\n';
  }
  template <class Value>
  void counter(std::string_view name, std::string_view help, const Value& value) {
    head(name, "counter", help);
    this->value(name, {}, value);
  }
  template <class Value>
  void gauge(std::string_view name, std::string_view help, const Value& value) {
    head(name, "gauge", help);
    this->value(name, {}, value);
  }
  // Prometheus expects that each interval also contains the shorter durations. `labels` has no
  // braces.
  void histogram(std::string_view name, const std::string& labels, const Histogram& histogram) {
    const auto counts = histogram.counts();
    const std::string before = "{" + labels + (labels.empty() ? "" : ",") + "le=\"";
    const std::string braced = labels.empty() ? "" : "{" + labels + "}";
    std::uint64_t total = 0;
    for (std::size_t i = 0; i < counts.by_interval.size(); ++i) {
      total += counts.by_interval[i];
      text_ << name << "_bucket" << before;
      if (i < Histogram::kBounds_s.size())
        text_ << Histogram::kBounds_s[i];
      else
        text_ << "+Inf";
      text_ << "\"} " << total << '\n';
    }
    text_ << name << "_sum" << braced << ' ' << counts.sum_s << '\n';
    text_ << name << "_count" << braced << ' ' << total << '\n';
  }
  std::string text() const { return text_.str(); }

 private:
  std::ostringstream text_;
};

std::string metric_label(std::string_view name, std::string_view value) {
  return std::string(name) + "=\"" + std::string(value) + "\"";
}

void write_requests(MetricsWriter& out, const Metrics& metrics, const Gauges& gauges) {
  out.head("strata_http_requests_total", "counter", "HTTP responses by class of status.");
  for (std::size_t i = 1; i < metrics.requests.size(); ++i)
    out.value("strata_http_requests_total",
              "{" + metric_label("status", std::to_string(i) + "xx") + "}",
              metrics.requests[i].load());
  out.head("strata_http_request_seconds", "histogram",
           "Time until the response to a request is ready, without the transfer of its body.");
  out.histogram("strata_http_request_seconds", {}, metrics.request_times);
  out.head("strata_problems_total", "counter", "Problems that were sent to clients, by code.");
  for (std::size_t i = 0; i < metrics.problems.size(); ++i)
    out.value("strata_problems_total",
              "{" + metric_label("code", name(static_cast<ErrorCode>(i))) + "}",
              metrics.problems[i].load());
  out.gauge("strata_open_connections", "TCP connections.", metrics.open_connections.load());
  out.gauge("strata_open_sockets", "WebSocket connections.", metrics.open_sockets.load());
  out.gauge("strata_waiting_requests", "Requests that wait for a worker.", gauges.waiting_requests);
  out.gauge("strata_waiting_questions", "Queries that wait for their turn.",
            gauges.waiting_questions);
  out.gauge("strata_questions_under_way", "Queries in progress.", gauges.questions_under_way);
  out.counter("strata_questions_left_total",
              "Queries whose client disconnected before the response.",
              metrics.questions_left.load());
  out.counter("strata_question_steps_total",
              "Steps of queries: texels times the parts of a condition.", gauges.question_steps);
  out.counter("strata_messages_received_total", "WebSocket messages received.",
              metrics.messages_received.load());
  out.counter("strata_messages_refused_total", "WebSocket messages refused.",
              metrics.messages_refused.load());
}

void write_edits(MetricsWriter& out, const Metrics& metrics, const Gauges& gauges) {
  out.counter("strata_edits_applied_total", "Edits that became visible.",
              metrics.edits.applied.load());
  out.counter("strata_edits_saved_total", "Edits that became durable.", metrics.edits.saved.load());
  out.counter("strata_edits_unsaved_total", "Edits that were visible but could not be saved.",
              metrics.edits.unsaved.load());
  out.counter("strata_edits_refused_total", "Edits that were refused.",
              metrics.edits.refused.load());
  out.head("strata_edit_stage_seconds", "histogram", "Duration of each stage of saved edits.");
  for (std::size_t i = 0; i < room::kEditStages.size(); ++i) {
    const std::string stage = "," + metric_label("stage", room::kEditStages[i]);
    out.histogram("strata_edit_stage_seconds", metric_label("kind", "stroke") + stage,
                  gauges.edits.strokes[i]);
    out.histogram("strata_edit_stage_seconds", metric_label("kind", "other") + stage,
                  gauges.edits.other_edits[i]);
  }
  out.head("strata_journal_commit_seconds", "histogram",
           "Time of a transaction of the journal in the database.");
  out.histogram("strata_journal_commit_seconds", {}, gauges.commits);
  out.gauge("strata_journal_waiting", "Edits that wait for the journal.", gauges.journal_waiting);
  out.gauge("strata_journal_accepting", "1 if the journal accepts edits, otherwise 0.",
            gauges.journal_accepting);
  out.counter("strata_journal_failed_commits_total", "Transactions of the journal that failed.",
              gauges.journal_failed_commits);
}

void write_drawing(MetricsWriter& out, const Metrics& metrics, const Gauges& gauges) {
  out.counter("strata_frames_sent_total", "Encoded frames sent to clients.",
              metrics.frames_sent.load());
  out.counter("strata_frame_bytes_sent_total", "Bytes of the encoded frames.",
              metrics.frame_bytes_sent.load());
  out.head("strata_frame_seconds", "histogram", "Time that the GPU thread needs for a frame.");
  out.histogram("strata_frame_seconds", {}, gauges.frames);
  out.gauge("strata_gpu_ready", "1 if the graphics context works, otherwise 0.", gauges.gpu_ready);
  out.gauge("strata_gpu_bytes", "GPU memory in use.", gauges.gpu_bytes);
  out.gauge("strata_gpu_limit_bytes", "Limit of GPU memory (--gpu-memory).",
            gauges.gpu_limit_bytes);
}

void write_machine(MetricsWriter& out, const Metrics& metrics, const Gauges& gauges) {
  out.head("strata_build_info", "gauge", "1, with the version of the server.");
  out.value("strata_build_info", "{" + metric_label("version", version()) + "}", 1);
  out.gauge("strata_open_rooms", "Models in memory.", gauges.open_rooms);
  out.gauge("strata_memory_bytes", "Main memory that open models hold.", gauges.memory_bytes);
  out.gauge("strata_memory_limit_bytes", "Limit of main memory for open models (--memory).",
            gauges.memory_limit_bytes);
  out.gauge("strata_process_resident_bytes", "Main memory of the server process.",
            gauges.resident_bytes);
  if (gauges.disk_bytes > 0) {
    out.gauge("strata_disk_bytes", "Size of the disk with the data folder.", gauges.disk_bytes);
    out.gauge("strata_disk_free_bytes", "Free space of the disk with the data folder.",
              gauges.disk_free_bytes);
  }
  out.gauge("strata_database_ready", "1 if the database answers, otherwise 0.",
            gauges.database_ready);
  out.head("strata_jobs", "gauge", "Jobs by state, with only the newest ended jobs.");
  for (std::size_t i = 0; i < gauges.jobs.size(); ++i)
    out.value("strata_jobs", "{" + metric_label("state", kJobStates[i]) + "}", gauges.jobs[i]);
  if (const auto end = metrics.certificate_end.load())
    out.gauge("strata_certificate_end_seconds",
              "Expiry of the TLS certificate, in seconds since 1970.", end);
}

void write_node(MetricsWriter& out, const Metrics& metrics, const Gauges& gauges) {
  if (!gauges.node) return;
  out.gauge("strata_node_lease_seconds", "Time until the lease of the node ends. 0: it has ended.",
            gauges.node->lease_s);
  out.counter("strata_models_moved_total",
              "Open models that this node gave to other nodes or lost to them.",
              gauges.node->models_moved);
  out.gauge("strata_followed_models", "Models of other nodes that this node shows to viewers.",
            gauges.node->followed_models);
  out.gauge("strata_follower_lag_seconds",
            "Time since all models of other nodes were up to date. 0: there are none.",
            gauges.node->follower_lag_s);
  out.counter("strata_node_messages_received_total",
              "Messages about changes at other nodes that this node received.",
              metrics.node_messages.load());
  out.counter("strata_node_messages_missed_total",
              "Failures that may lose messages of other nodes, so all clients connect again.",
              metrics.node_messages_missed.load());
  out.head("strata_node_message_seconds", "histogram",
           "Time from a change at another node until this node has sent it to its clients.");
  out.histogram("strata_node_message_seconds", {}, metrics.node_message_ages);
}

void write_archive(MetricsWriter& out, const Gauges& gauges) {
  if (!gauges.archive) return;
  out.gauge("strata_archive_segment_seconds",
            "Time of the last archived WAL segment, in seconds since 1970. 0: none yet.",
            gauges.archive->archived_s);
  out.gauge("strata_archive_copy_seconds",
            "Time of the newest copy in the archive, in seconds since 1970. 0: none yet.",
            gauges.archive->copied_s);
  out.head("strata_archive_failures_total", "counter", "Failed tries to write to the archive.");
  out.value("strata_archive_failures_total", "{" + metric_label("of", "segment") + "}",
            gauges.archive->failed_segments);
  out.value("strata_archive_failures_total", "{" + metric_label("of", "copy") + "}",
            gauges.archive->failed_copies);
}

void write_files(MetricsWriter& out, const Gauges& gauges) {
  if (!gauges.files) return;
  constexpr const char* kName = "strata_file_faults_total";
  out.head(kName, "counter", "Failed reads of files outside the database.");
  out.value(kName, "{" + metric_label("kind", "missing") + "}", gauges.files->missing);
  out.value(kName, "{" + metric_label("kind", "changed") + "}", gauges.files->changed);
  out.value(kName, "{" + metric_label("kind", "unreachable") + "}", gauges.files->unreachable);
}

}  // namespace

std::string metrics_text(const Metrics& metrics, const Gauges& gauges) {
  MetricsWriter out;
  write_requests(out, metrics, gauges);
  write_edits(out, metrics, gauges);
  write_drawing(out, metrics, gauges);
  write_machine(out, metrics, gauges);
  write_node(out, metrics, gauges);
  write_archive(out, gauges);
  write_files(out, gauges);
  return out.text();
}

}  // namespace strata::net
