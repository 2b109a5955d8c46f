#pragma once

#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "bench/processes.h"

namespace strata::bench {

// ParaView's web engine (peers/paraview_frames.py) on a separate, invisible screen, as ParaView's
// own server needs on a machine without a screen.
class ParaViewPeer {
 public:
  // Returns nothing if a program is missing. Then `why` names it and the command that installs it.
  static std::optional<ParaViewPeer> find(std::string& why);

  // Turns the camera around the mesh of a PLY file for `seconds`. Requests each frame after the
  // previous one has arrived. Ends the bench if the peer fails. The logs are written to `folder`.
  nlohmann::json measure(const std::filesystem::path& ply, int width, int height, double seconds,
                         const std::filesystem::path& folder) const;

 private:
  std::filesystem::path pvpython_, xvfb_, script_;
};

}  // namespace strata::bench
