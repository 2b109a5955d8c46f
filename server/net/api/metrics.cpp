#include "net/api/metrics.h"

#include <string_view>

namespace strata::net {
namespace {

void add(std::string& text, std::string_view name, std::string_view type, std::string_view help,
         const std::string& value) {
  text.append("# HELP ").append(name).append(" ").append(help).append("\n");
  text.append("# TYPE ").append(name).append(" ").append(type).append("\n");
  text.append(name).append(" ").append(value).append("\n");
}

}  // namespace

std::string metrics_text(const Metrics& metrics, const Gauges& gauges) {
  std::string text =
      "# HELP strata_http_requests_total HTTP responses by class of status code.\n# TYPE strata_http_requests_total counter\n";
  for (std::size_t i = 1; i < metrics.requests.size(); ++i)
    text += "strata_http_requests_total{status=\"" + std::to_string(i) + "xx\"} " +
            std::to_string(metrics.requests[i].load()) + "\n";
  auto counter = [&](std::string_view name, std::string_view help,
                     const std::atomic<std::uint64_t>& value) {
    add(text, name, "counter", help, std::to_string(value.load()));
  };
  auto gauge = [&](std::string_view name, std::string_view help, auto value) {
    add(text, name, "gauge", help, std::to_string(value));
  };
  gauge("strata_open_connections", "TCP connections.", metrics.open_connections.load());
  gauge("strata_open_sockets", "WebSocket connections.", metrics.open_sockets.load());
  gauge("strata_open_rooms", "Models in memory.", gauges.open_rooms);
  gauge("strata_waiting_requests", "Requests that wait for a worker.", gauges.waiting_requests);
  gauge("strata_waiting_questions", "Questions that wait to be answered.",
        gauges.waiting_questions);
  gauge("strata_questions_under_way", "Questions that are being answered.",
        gauges.questions_under_way);
  gauge("strata_gpu_bytes", "GPU memory in use.", gauges.gpu_bytes);
  gauge("strata_memory_bytes", "Main memory that open models use.", gauges.memory_bytes);
  counter("strata_edits_applied_total", "Edits that became visible.", metrics.edits.applied);
  counter("strata_edits_saved_total", "Edits that became durable.", metrics.edits.saved);
  counter("strata_edits_unsaved_total", "Visible edits that could not be saved and were undone.",
          metrics.edits.unsaved);
  counter("strata_edits_refused_total", "Edits that were refused.", metrics.edits.refused);
  counter("strata_frames_sent_total", "Encoded frames sent to viewers.", metrics.frames_sent);
  counter("strata_frame_bytes_sent_total", "Bytes of the encoded frames.",
          metrics.frame_bytes_sent);
  counter("strata_messages_received_total", "WebSocket messages received.",
          metrics.messages_received);
  counter("strata_messages_refused_total", "WebSocket messages refused.", metrics.messages_refused);
  counter("strata_questions_left_total", "Questions whose client disconnected before the answer.",
          metrics.questions_left);
  add(text, "strata_question_steps_total", "counter",
      "Steps of questions: texels times the parts of a condition.",
      std::to_string(gauges.question_steps));
  if (gauges.node) {
    gauge("strata_node_lease_seconds", "Time until the lease of the node ends. 0: it has ended.",
          gauges.node->lease_s);
    add(text, "strata_models_moved_total", "counter",
        "Open models that this node gave to other nodes or lost to them.",
        std::to_string(gauges.node->models_moved));
  }
  return text;
}

}  // namespace strata::net
