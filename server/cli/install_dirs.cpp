#include "cli/install_dirs.h"

#include <cstdlib>

namespace strata::cli {

InstallDirs install_dirs() {
  namespace fs = std::filesystem;
  fs::path root;
  if (const char* share = std::getenv("STRATA_SHARE")) {
    root = share;
  } else {
    const fs::path installed =
        fs::read_symlink("/proc/self/exe").parent_path().parent_path() / "share" / "strata";
    root = fs::is_directory(installed / "shaders") ? installed : fs::path(STRATA_SOURCE_DIR);
  }
  return {root / "shaders", root / "db" / "migrations", root / "web-client" / "dist",
          root / "protocol" / "generated", root / "templates"};
}

}  // namespace strata::cli
