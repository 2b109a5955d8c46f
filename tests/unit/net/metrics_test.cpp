#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <optional>
#include <regex>
#include <set>
#include <sstream>
#include <string>

#include "net/api/metrics.h"
#include "strata_dirs.h"

namespace strata::net {
namespace {

using namespace std::chrono_literals;

struct Values {
  Metrics metrics;
  room::EditTimings edits;
  Histogram frames, commits;
  std::optional<NodeGauges> node = NodeGauges{2.5, 3, 2, 0.25};
  std::optional<ArchiveGauges> archive = ArchiveGauges{1'900'000'000.5, 1'900'000'000, 4, 1};
  std::optional<FileGauges> files = FileGauges{1, 2, 3};

  std::string text(bool has_disk = true) {
    Gauges gauges{edits, frames, commits};
    gauges.open_rooms = 2;
    gauges.gpu_bytes = 1024;
    gauges.gpu_ready = true;
    gauges.jobs = {0, 1, 5, 2, 0};
    if (has_disk) gauges.disk_bytes = 1u << 30;
    gauges.node = node;
    gauges.archive = archive;
    gauges.files = files;
    return metrics_text(metrics, gauges);
  }
};

bool has_line(const std::string& text, const std::string& line) {
  return ("\n" + text).find("\n" + line + "\n") != std::string::npos;
}

// Returns the names in `# TYPE` lines. A histogram also has the names of its series.
std::set<std::string> names_of(const std::string& text) {
  std::set<std::string> names;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string hash, type_word, name, type;
    if (!(words >> hash >> type_word >> name >> type) || hash != "#" || type_word != "TYPE")
      continue;
    EXPECT_TRUE(names.insert(name).second) << name << " has two heads";
    if (type == "histogram")
      for (const char* series : {"_bucket", "_sum", "_count"}) names.insert(name + series);
  }
  return names;
}

std::string read(const std::string& path) {
  std::ifstream file(std::filesystem::path(STRATA_SOURCE_DIR) / path);
  EXPECT_TRUE(file) << path;
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

std::set<std::string> metrics_in(const std::string& text) {
  static const std::regex kName("strata_[a-z0-9_]+");
  std::set<std::string> found;
  for (std::sregex_iterator at(text.begin(), text.end(), kName), end; at != end; ++at)
    found.insert(at->str());
  return found;
}

TEST(Metrics, counters_and_gauges_have_their_values) {
  Values values;
  values.metrics.count_request(204);
  values.metrics.count_request(404);
  values.metrics.count_request(404);
  values.metrics.count_problem(ErrorCode::not_found);
  values.metrics.frames_sent = 7;
  const std::string text = values.text();
  EXPECT_TRUE(has_line(text, "strata_http_requests_total{status=\"4xx\"} 2"));
  EXPECT_TRUE(has_line(text, "strata_problems_total{code=\"not_found\"} 1")) << text;
  EXPECT_TRUE(has_line(text, "strata_frames_sent_total 7"));
  EXPECT_TRUE(has_line(text, "strata_open_rooms 2"));
  EXPECT_TRUE(has_line(text, "strata_gpu_bytes 1024"));
  EXPECT_TRUE(has_line(text, "strata_gpu_ready 1"));
  EXPECT_TRUE(has_line(text, "strata_database_ready 0"));
  EXPECT_TRUE(has_line(text, "strata_jobs{state=\"failed\"} 2"));
}

TEST(Metrics, an_interval_of_a_histogram_contains_all_shorter_durations) {
  Values values;
  auto& total = values.edits.of(true, room::EditStage::total);
  total.add(3ms);
  total.add(40ms);
  total.add(40ms);
  total.add(2min);
  const std::string text = values.text(), stroke = "{kind=\"stroke\",stage=\"total\"";
  EXPECT_TRUE(has_line(text, "strata_edit_stage_seconds_bucket" + stroke + ",le=\"0.005\"} 1"));
  EXPECT_TRUE(has_line(text, "strata_edit_stage_seconds_bucket" + stroke + ",le=\"0.05\"} 3"));
  EXPECT_TRUE(has_line(text, "strata_edit_stage_seconds_bucket" + stroke + ",le=\"+Inf\"} 4"));
  EXPECT_TRUE(has_line(text, "strata_edit_stage_seconds_count" + stroke + "} 4"));
  EXPECT_TRUE(has_line(text, "strata_edit_stage_seconds_sum" + stroke + "} 120.083")) << text;
  EXPECT_TRUE(has_line(text, "strata_edit_stage_seconds_count{kind=\"other\",stage=\"total\"} 0"));
}

TEST(Metrics, a_value_that_does_not_exist_is_left_out) {
  Values values;
  EXPECT_EQ(values.text(false).find("strata_disk"), std::string::npos);
  EXPECT_EQ(values.text().find("strata_certificate_end_seconds"), std::string::npos);
  values.metrics.certificate_end = 1'900'000'000;
  EXPECT_TRUE(has_line(values.text(), "strata_certificate_end_seconds 1900000000"));
}

TEST(Metrics, only_a_node_has_a_lease_and_messages_of_other_nodes) {
  Values values;
  values.metrics.node_messages = 7;
  values.metrics.node_messages_missed = 1;
  values.metrics.node_message_ages.add(20ms);
  EXPECT_TRUE(has_line(values.text(), "strata_node_lease_seconds 2.5"));
  EXPECT_TRUE(has_line(values.text(), "strata_models_moved_total 3"));
  EXPECT_TRUE(has_line(values.text(), "strata_followed_models 2"));
  EXPECT_TRUE(has_line(values.text(), "strata_follower_lag_seconds 0.25"));
  EXPECT_TRUE(has_line(values.text(), "strata_node_messages_received_total 7"));
  EXPECT_TRUE(has_line(values.text(), "strata_node_messages_missed_total 1"));
  EXPECT_TRUE(has_line(values.text(), "strata_node_message_seconds_count 1"));
  values.node.reset();
  EXPECT_EQ(values.text().find("strata_node"), std::string::npos);
}

TEST(Metrics, only_a_server_with_an_archive_has_its_metrics) {
  Values values;
  EXPECT_TRUE(has_line(values.text(), "strata_archive_segment_seconds 1900000000.5"));
  EXPECT_TRUE(has_line(values.text(), "strata_archive_failures_total{of=\"segment\"} 4"));
  values.archive.reset();
  EXPECT_EQ(values.text().find("strata_archive"), std::string::npos);
}

TEST(Metrics, the_dashboard_and_the_alerts_use_only_metrics_that_exist) {
  Values values;
  values.metrics.certificate_end = 1;
  const auto names = names_of(values.text());
  for (const char* path :
       {"examples/monitoring/grafana-dashboard.json", "examples/monitoring/alerts.yaml"}) {
    const auto used = metrics_in(read(path));
    EXPECT_GT(used.size(), 5u) << path;
    for (const auto& name : used) EXPECT_TRUE(names.contains(name)) << path << ": " << name;
  }
}

TEST(Metrics, the_guide_lists_every_metric_and_no_other) {
  Values values;
  values.metrics.certificate_end = 1;
  const std::string text = values.text();
  const auto names = names_of(text);
  const auto listed = metrics_in(read("docs/how-to/watch-the-server.md"));
  for (const auto& name : listed) EXPECT_TRUE(names.contains(name)) << name;
  for (const auto& name : names) {
    const bool is_series = text.find("# TYPE " + name + " ") == std::string::npos;
    EXPECT_TRUE(is_series || listed.contains(name)) << name << " is not in the guide";
  }
}

}  // namespace
}  // namespace strata::net
