#pragma once

#include <filesystem>

namespace strata::cli {

// The folders of the files that are installed with the program. In an installed tree, they are next
// to the binary (`share/strata`). Otherwise, they are in the source tree. STRATA_SHARE overrides
// both.
struct InstallDirs {
  std::filesystem::path shaders, migrations, web_client, protocol, templates;
};
InstallDirs install_dirs();

}  // namespace strata::cli
