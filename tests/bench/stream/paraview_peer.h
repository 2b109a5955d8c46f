#pragma once

#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "bench/processes.h"

namespace strata::bench {

// ParaView's web engine (peers/paraview_frames.py) on a screen of its own that nobody sees, as its
// server runs where there is none.
class ParaViewPeer {
 public:
  // Nothing where a program is missing: `why` says which, and how to install it.
  static std::optional<ParaViewPeer> find(std::string& why);

  // Turns the camera around the mesh of a PLY file for so long, each picture asked for when the one
  // before is there. Ends the bench where the peer fails. `folder`: for its logs.
  nlohmann::json measure(const std::filesystem::path& ply, int width, int height, double seconds,
                         const std::filesystem::path& folder) const;

 private:
  std::filesystem::path pvpython_, xvfb_, script_;
};

}  // namespace strata::bench
