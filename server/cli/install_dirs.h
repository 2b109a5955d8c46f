#pragma once

#include <filesystem>

namespace strata::cli {

// The folders of the files that are installed with the program: next to the binary in an installed
// tree (`share/strata`), in the source tree otherwise; STRATA_SHARE overrides both.
struct InstallDirs {
  std::filesystem::path shaders, migrations, web_client, protocol, templates;
};
InstallDirs install_dirs();

}  // namespace strata::cli
