#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <system_error>
#include <utility>

namespace strata {

// A file that was made for one user. The destructor deletes the file.
struct TemporaryFile {
  std::filesystem::path path;
  std::string name, media_type;  // for the download
  std::uint64_t bytes = 0;
  std::optional<std::uint64_t> triangles;  // of a 3D model
  TemporaryFile() = default;
  explicit TemporaryFile(std::filesystem::path file) : path(std::move(file)) {}
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  ~TemporaryFile() {
    std::error_code ignored;
    std::filesystem::remove(path, ignored);
  }
};

}  // namespace strata
