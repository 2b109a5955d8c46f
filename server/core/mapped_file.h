#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string_view>

#include "core/error.h"

namespace strata {

// A file as read-only memory. The file must not shrink while it is mapped: uploads and imports are
// complete before they are read.
class MappedFile {
 public:
  // Error `invalid`: the reason why the file cannot be read. An empty file has no bytes.
  static Result<MappedFile> open(const std::filesystem::path& file);
  MappedFile(MappedFile&& other) noexcept;
  MappedFile& operator=(MappedFile&&) = delete;
  ~MappedFile();

  std::span<const std::uint8_t> bytes() const {
    return {static_cast<const std::uint8_t*>(data_), size_};
  }
  // Releases the memory that holds this part; a later access reads it from the file again. A single
  // pass through gigabytes thus needs little memory.
  void release(std::string_view part) const;
  std::string_view view() const { return {static_cast<const char*>(data_), size_}; }

 private:
  MappedFile() = default;

  void* data_ = nullptr;
  std::size_t size_ = 0;
};

}  // namespace strata
