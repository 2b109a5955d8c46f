#pragma once

#include <filesystem>

namespace strata::cli {

// Where the files that come with the program lie: beside the binary in an installed tree
// (`share/strata`), in the source tree otherwise; STRATA_SHARE names another place.
struct InstallDirs {
  std::filesystem::path shaders, migrations, web_client, protocol, templates;
};
InstallDirs install_dirs();

}  // namespace strata::cli
