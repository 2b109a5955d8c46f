#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string_view>

#include "core/error.h"

namespace strata {

// A file that is mapped into memory, read-only. The file must not become shorter while it is
// mapped. Uploads and imports are therefore complete before they are read.
class MappedFile {
 public:
  // Returns the error `invalid`, with the reason, if the file cannot be read. An empty file has no
  // bytes.
  static Result<MappedFile> open(const std::filesystem::path& file);
  MappedFile(MappedFile&& other) noexcept;
  MappedFile& operator=(MappedFile&&) = delete;
  ~MappedFile();

  std::span<const std::uint8_t> bytes() const {
    return {static_cast<const std::uint8_t*>(data_), size_};
  }
  // Releases the memory that holds this part. A later access reads the part from the file again. So
  // a single pass through gigabytes needs little memory.
  void release(std::string_view part) const;
  std::string_view view() const { return {static_cast<const char*>(data_), size_}; }

 private:
  MappedFile() = default;

  void* data_ = nullptr;
  std::size_t size_ = 0;
};

}  // namespace strata
