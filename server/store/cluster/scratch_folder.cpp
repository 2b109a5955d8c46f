#include "store/cluster/scratch_folder.h"

#include <stdlib.h>
#include <sys/stat.h>

#include <cerrno>
#include <cstring>

namespace strata::store {
namespace fs = std::filesystem;

ScratchFolder::~ScratchFolder() {
  std::error_code ignored;
  if (!folder_.empty()) fs::remove_all(folder_, ignored);
}

Result<ScratchFolder> ScratchFolder::make(const std::string& purpose, mode_t mode) {
  std::error_code error;
  std::string folder =
      (fs::temp_directory_path(error) / ("strata-" + purpose + "-XXXXXX")).string();
  if (!mkdtemp(folder.data()) || chmod(folder.c_str(), mode) != 0)
    return fail(ErrorCode::internal, "Cannot create folder",
                folder + ": " + std::strerror(errno) + ". Choose another folder with TMPDIR.");
  return ScratchFolder(folder);
}

std::error_code ScratchFolder::keep_as(const fs::path& name) {
  std::error_code error;
  fs::rename(folder_, name, error);
  if (!error) folder_.clear();
  return error;
}

}  // namespace strata::store
