// Measures a real server with many viewers over real WebSockets: frames of turning cameras, the
// time until viewers see strokes, resting viewers, slow links, and a stalled viewer. Also compares
// one viewer with ParaView's web engine on the same mesh.
#include <sys/resource.h>

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <sstream>

#include "bench/bench_commands.h"
#include "bench/bench_mesh.h"
#include "bench/harness.h"
#include "bench/stream/crowd.h"
#include "bench/stream/paraview_peer.h"
#include "bench/stream/stream_site.h"

namespace strata::bench {
namespace {

struct Options {
  std::vector<int> active{1, 4, 8}, idle{0, 100, 500};
  std::vector<std::string> links{"loopback", "20ms/50Mbit", "80ms/8Mbit"};
  std::vector<std::string> parts{"active", "idle", "stalled", "peer"};
  std::string idle_views = "own", window = "1280x720", model = "pot:100000", cache = "build/bench",
              json, server;
  double seconds = 10, radius = 40;
  int layers = 3, rounds = 2;
  bool quick = false;

  bool has(const std::string& part) const { return std::ranges::find(parts, part) != parts.end(); }
};

// One line of the results, and the function that makes one run of it.
struct Row {
  nlohmann::json json;  // collects the runs
  std::function<nlohmann::json()> run;
};

std::vector<Hands> hands_of(int active, bool can_paint) {
  if (!can_paint) return {Hands::turn};
  if (active == 1) return {Hands::turn, Hands::paint};
  return {Hands::turn, Hands::paint, Hands::turn_and_paint};
}

// Returns the cases. Each link has cases with each number of active viewers and the first number of
// idle ones. Only the first link has cases with more idle viewers and with the stalled viewer. All
// combinations of the lists would take a day and give little more information.
std::vector<std::pair<std::string, CrowdCase>> crowd_cases(const Options& options, bool can_paint) {
  std::vector<LinkQuality> links;
  for (const auto& link : options.links) links.push_back(*parse_link(link));
  CrowdCase common;
  common.idle = options.idle.front();
  common.is_same_view = options.idle_views == "same";
  std::vector<std::pair<std::string, CrowdCase>> cases;
  const auto add = [&](const char* part, CrowdCase one, const LinkQuality& link, int active,
                       Hands hands) {
    one.link = link;
    one.active = active;
    one.hands = hands;
    cases.emplace_back(part, one);
  };
  for (const auto& link : links) {
    for (const int active : options.active) {
      const auto all_hands = hands_of(active, can_paint);
      const bool stalls = options.has("stalled") && &link == &links.front();
      for (const Hands hands : all_hands)
        if (options.has("active") || (stalls && hands == all_hands.back()))
          add("active", common, link, active, hands);
      if (!stalls) continue;
      CrowdCase stalled = common;
      stalled.has_stalled = true;
      add("stalled", stalled, link, active, all_hands.back());  // to compare with the case above
    }
  }
  for (const int idle : options.idle) {
    if (!options.has("idle") || idle == 0) continue;
    CrowdCase resting = common;
    resting.idle = idle;
    add("idle", resting, links.front(), 0, Hands::rest);
    if (idle == options.idle.front() && options.has("active")) continue;  // measured above
    for (const int active : options.active)
      add("idle", resting, links.front(), active, hands_of(active, can_paint).back());
  }
  return cases;
}

std::string number(const nlohmann::json& json, const char* member, const char* format = "%.0f") {
  if (!json.is_object() || !json.contains(member) || !json.at(member).is_number()) return "—";
  char text[40];
  std::snprintf(text, sizeof text, format, json.at(member).get<double>());
  return text;
}

void print(const nlohmann::json& row, const nlohmann::json& run) {
  std::ostringstream line;
  line << row.value("part", "") << ": ";
  if (row.contains("program"))
    line << row["program"].get<std::string>() << ", " << row["layers"] << " layers, "
         << row["hands"].get<std::string>();
  else
    line << row["link"].get<std::string>() << ", " << row["active"] << " active ("
         << row["hands"].get<std::string>() << "), " << row["idle"] << " idle"
         << (row["stalled"].get<bool>() ? ", one stalled" : "");
  if (run.contains("camera_to_picture")) {
    line << ": " << number(run, "frames_per_s", "%.1f") << " frames/s, picture p50 "
         << number(run["camera_to_picture"], "ms_median") << " ms, p95 "
         << number(run["camera_to_picture"], "ms_p95") << "; "
         << number(run, "frames_per_cpu_s", "%.1f") << " frames a CPU second";
  } else {
    const auto& rates = run["frames_per_s"];
    line << ": frames/s turning " << number(rates["turning"], "median", "%.1f") << ", painting "
         << number(rates["painting"], "median", "%.1f") << ", idle "
         << number(rates["idle"], "median", "%.2f") << "; camera p50 "
         << number(run["camera_to_last_byte"], "ms_median") << " ms, p95 "
         << number(run["camera_to_last_byte"], "ms_p95");
    if (run.contains("strokes"))
      line << "; stroke → own p50 " << number(run["strokes"]["to_own_pixels"], "ms_median")
           << " ms, p95 " << number(run["strokes"]["to_own_pixels"], "ms_p95") << ", → others p50 "
           << number(run["strokes"]["to_others_pixels"]["still"], "ms_median") << " still, "
           << number(run["strokes"]["to_others_pixels"]["turning"], "ms_median") << " turning";
    line << "; " << number(run["bytes_per_s"], "all_active") << " + "
         << number(run["bytes_per_s"], "all_idle") << " bytes/s; cores "
         << number(run["cores"], "server", "%.3f") << ", "
         << number(run, "frames_per_cpu_s", "%.1f") << " frames a CPU second; "
         << number(run["server_mib"], "peak") << " MiB";
  }
  std::puts(line.str().c_str());
  std::fflush(stdout);
}

// A viewer uses one file descriptor in this process, or three with a link.
void raise_descriptor_limit() {
  rlimit limit{};
  if (getrlimit(RLIMIT_NOFILE, &limit) != 0) return;
  limit.rlim_cur = limit.rlim_max;
  setrlimit(RLIMIT_NOFILE, &limit);
}

void add_peer_rows(std::vector<Row>& rows, const StreamSite& site, const ParaViewPeer& peer,
                   double seconds) {
  for (const Stage* stage : {&site.plain(), &site.painted()}) {
    for (const Hands hands : {Hands::turn_step_by_step, Hands::turn}) {
      CrowdCase alone;
      alone.hands = hands;
      rows.push_back({{{"part", "peer"},
                       {"program", "strata"},
                       {"layers", stage->layers},
                       {"hands", name(hands)}},
                      [&site, stage, alone, seconds] {
                        return Crowd(alone, *stage, site.server()).measure(seconds);
                      }});
    }
    if (site.plain().model == site.painted().model) break;
  }
  rows.push_back({{{"part", "peer"},
                   {"program", "paraview"},
                   {"layers", 0},
                   {"hands", name(Hands::turn_step_by_step)}},
                  [&site, &peer, seconds] {
                    const Stage& stage = site.plain();
                    return peer.measure(site.mesh_file(), stage.width, stage.height, seconds,
                                        site.server().folder());
                  }});
}

int run(Options options) {
  raise_descriptor_limit();
  StreamSite::Settings settings;
  settings.server = options.server;
  settings.model = options.model;
  settings.cache = options.cache;
  settings.layers = options.layers;
  settings.radius_px = options.radius;
  std::sscanf(options.window.c_str(), "%dx%d", &settings.width, &settings.height);
  std::optional<ParaViewPeer> peer;
  std::string why_no_peer;
  if (options.has("peer")) {
    peer = ParaViewPeer::find(why_no_peer);
    if (!peer)
      std::fprintf(stderr, "strata-bench: ParaView is NOT measured: %s\n", why_no_peer.c_str());
  }
  settings.has_plain = peer.has_value();

  const StreamSite site(settings);
  std::printf("%s, %lld triangles, %d layers of 4096², %s, %.0f s each, %s\n",
              options.model.c_str(), static_cast<long long>(site.triangles()), options.layers,
              options.window.c_str(), options.seconds, site.server().renderer().c_str());
  std::vector<Row> rows;
  for (const auto& [part, one] : crowd_cases(options, options.layers > 0)) {
    nlohmann::json json = one.json();
    json["part"] = part;
    rows.push_back({json, [&site, one = one, seconds = options.seconds] {
                      return Crowd(one, site.painted(), site.server()).measure(seconds);
                    }});
  }
  if (peer) add_peer_rows(rows, site, *peer, options.seconds);

  // The order is A B B A, so a drift of the machine's speed affects all cases.
  for (int round = 0; round < options.rounds; ++round) {
    for (std::size_t i = 0; i < rows.size(); ++i) {
      Row& row = rows[round % 2 == 0 ? i : rows.size() - 1 - i];
      const auto figures = row.run();
      print(row.json, figures);
      row.json["runs"].push_back(figures);
    }
  }

  nlohmann::json results = nlohmann::json::array();
  for (const Row& row : rows) results.push_back(row.json);
  nlohmann::json about = machine(nullptr);
  about["gl_renderer"] = site.server().renderer();
  nlohmann::json more{{"method", "stream"},
                      {"model", options.model},
                      {"triangles", site.triangles()},
                      {"layers", options.layers},
                      {"resolution", StreamSite::kResolution},
                      {"window", options.window},
                      {"radius", options.radius}};
  if (!why_no_peer.empty()) more["not_run"] = {{{"program", "paraview"}, {"why", why_no_peer}}};
  write_result(options.json, about, results, more);
  return 0;
}

// Sets the options of `--quick`. Options from the command line take precedence.
void make_quick(Options& options, const CLI::App& command) {
  const auto set = [&](const char* option, auto& value, auto quick) {
    if (command.count(option) == 0) value = quick;
  };
  set("--active", options.active, std::vector{2});
  set("--idle", options.idle, std::vector{3});
  set("--links", options.links, std::vector<std::string>{"20ms/50Mbit"});
  set("--parts", options.parts, std::vector<std::string>{"active", "idle", "stalled"});
  set("--model", options.model, std::string("pot:20000"));
  set("--layers", options.layers, 1);
  set("--seconds", options.seconds, 2.0);
  set("--rounds", options.rounds, 1);
}

}  // namespace

Command add_stream(CLI::App& app) {
  auto* command = app.add_subcommand(
      "stream",
      "Many viewers of a real server: pictures, strokes, rest, slow links, beside ParaView");
  auto options = std::make_shared<Options>();
  const auto is_link = [](const std::string& text) {
    return parse_link(text) ? "" : text + " is neither loopback nor like 20ms/50Mbit";
  };
  const auto is_window = [](const std::string& text) {
    int width = 0, height = 0, end = 0;
    const bool is_size = std::sscanf(text.c_str(), "%4dx%4d%n", &width, &height, &end) == 2 &&
                         std::size_t(end) == text.size() && width > 0 && height > 0;
    return is_size ? "" : text + " is no size like 1280x720";
  };
  command->add_option("--active", options->active, "Numbers of viewers who turn and paint")
      ->delimiter(',')
      ->check(CLI::Range(1, 64))
      ->capture_default_str();
  command
      ->add_option("--idle", options->idle,
                   "Numbers of viewers at rest; the first of them is there in every case")
      ->delimiter(',')
      ->check(CLI::Range(0, 1500))
      ->capture_default_str();
  command
      ->add_option("--idle-views", options->idle_views,
                   "Whether they look from places of their own")
      ->check(CLI::IsMember({"own", "same"}))
      ->capture_default_str();
  command->add_option("--links", options->links, "loopback, or ROUND TRIPms/RATEMbit")
      ->delimiter(',')
      ->check(is_link)
      ->capture_default_str();
  command->add_option("--parts", options->parts, "Of active, idle, stalled, peer")
      ->delimiter(',')
      ->check(CLI::IsMember({"active", "idle", "stalled", "peer"}))
      ->capture_default_str();
  command->add_option("--seconds", options->seconds, "Of each run, after a second to warm up")
      ->check(CLI::Range(0.5, 3600.0))
      ->capture_default_str();
  command->add_option("--rounds", options->rounds, "Through all cases, there and back")
      ->check(CLI::Range(1, 100))
      ->capture_default_str();
  command->add_option("--window", options->window)->check(is_window)->capture_default_str();
  command
      ->add_option("--model", options->model,
                   "pot[:TRIANGLES], vessel, excavation, amazon, thai, or a PLY file")
      ->capture_default_str();
  command
      ->add_option("--layers", options->layers,
                   "Filled layers shown; the strokes go to the topmost (0: nobody paints)")
      ->check(CLI::Range(0, 64))
      ->capture_default_str();
  command->add_option("--radius", options->radius, "Brush radius in pixels")
      ->check(CLI::Range(1.0, 1000.0))
      ->capture_default_str();
  command
      ->add_option("--server", options->server,
                   "The server's program (default: strata beside this one)")
      ->check(CLI::ExistingFile);
  command->add_option("--cache", options->cache, "Where generated meshes are kept")
      ->capture_default_str();
  command->add_option("--json", options->json, "Write the results here");
  command->add_flag("--quick", options->quick,
                    "Two viewers and three at rest on one link, 2 s each: whether it works");
  return [options, command] {
    if (options->quick) make_quick(*options, *command);
    return run(*options);
  };
}

}  // namespace strata::bench
