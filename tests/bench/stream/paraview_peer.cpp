#include "bench/stream/paraview_peer.h"

#include <cstdio>
#include <cstdlib>

#include "core/uuid.h"
#include "strata_dirs.h"

namespace strata::bench {
namespace {

constexpr std::chrono::seconds kStarting{120};

}  // namespace

std::optional<ParaViewPeer> ParaViewPeer::find(std::string& why) {
  const auto pvpython = on_path("pvpython"), xvfb = on_path("Xvfb");
  ParaViewPeer peer;
  peer.script_ = std::filesystem::path(STRATA_SOURCE_DIR) / "tests/bench/peers/paraview_frames.py";
  if (!pvpython || !xvfb || !std::filesystem::exists(peer.script_)) {
    why = !pvpython ? "there is no pvpython"
          : !xvfb   ? "there is no Xvfb"
                    : "there is no " + peer.script_.string();
    why += " (apt-get install --no-install-recommends paraview python3-paraview xvfb)";
    return std::nullopt;
  }
  peer.pvpython_ = *pvpython;
  peer.xvfb_ = *xvfb;
  return peer;
}

nlohmann::json ParaViewPeer::measure(const std::filesystem::path& ply, int width, int height,
                                     double seconds, const std::filesystem::path& folder) const {
  const std::string size = std::to_string(width) + "x" + std::to_string(height);
  const std::string run = to_string(random_uuid());
  ChildProcess screen(
      {xvfb_.string(), "-displayfd", "1", "-screen", "0", size + "x24", "-nolisten", "tcp"},
      folder / ("xvfb-" + run + ".log"));
  const auto display = screen.said("", kStarting);  // the first line is the display's number
  if (!display) {
    std::fprintf(stderr, "strata-bench: Xvfb: %s\n", screen.last_words().c_str());
    std::exit(1);
  }
  ChildProcess peer({"/usr/bin/env", "DISPLAY=:" + *display, pvpython_.string(), script_.string(),
                     ply.string(), "--size", size, "--seconds", std::to_string(seconds),
                     "--screen-pid", std::to_string(screen.pid())},
                    folder / ("paraview-" + run + ".log"));
  const auto figures =
      peer.said("figures: ", kStarting + std::chrono::seconds(std::int64_t(10 * seconds)));
  if (!figures) {
    std::fprintf(stderr, "strata-bench: ParaView: %s\n", peer.last_words().c_str());
    std::exit(1);
  }
  return nlohmann::json::parse(*figures);
}

}  // namespace strata::bench
