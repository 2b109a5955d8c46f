#pragma once

#include <filesystem>
#include <string>
#include <system_error>

#include <sys/types.h>

#include "core/error.h"

namespace strata::store {

// A folder that the destructor deletes with its content.
class ScratchFolder {
 public:
  explicit ScratchFolder(std::filesystem::path folder) : folder_(std::move(folder)) {}
  ScratchFolder(ScratchFolder&& other) noexcept : folder_(std::move(other.folder_)) {
    other.folder_.clear();
  }
  ScratchFolder& operator=(ScratchFolder&&) = delete;
  ~ScratchFolder();

  // Makes a folder `strata-PURPOSE-…` with a new name in the folder for temporary files (TMPDIR).
  // A folder for a private database needs the mode 0755, because the database user must be able to
  // enter it. The folder of the database in it has the mode 0700.
  static Result<ScratchFolder> make(const std::string& purpose, mode_t mode = 0700);

  const std::filesystem::path& folder() const { return folder_; }
  // Renames the folder. If this succeeds, the destructor does not delete it.
  std::error_code keep_as(const std::filesystem::path& name);

 private:
  std::filesystem::path folder_;
};

}  // namespace strata::store
