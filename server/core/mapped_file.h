#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string_view>

#include "core/error.h"

namespace strata {

// A file as read-only memory. The file must not shrink meanwhile: uploads and imports are finished
// before they are read.
class MappedFile {
 public:
  // An Error `invalid` that says why a file cannot be read. An empty file has no bytes.
  static Result<MappedFile> open(const std::filesystem::path& file);
  MappedFile(MappedFile&& other) noexcept;
  MappedFile& operator=(MappedFile&&) = delete;
  ~MappedFile();

  std::span<const std::uint8_t> bytes() const {
    return {static_cast<const std::uint8_t*>(data_), size_};
  }
  // Lets go of the memory that holds this part of it, which is read from the file again when it is
  // wanted: who goes through gigabytes once needs no memory for them.
  void release(std::string_view part) const;
  std::string_view view() const { return {static_cast<const char*>(data_), size_}; }

 private:
  MappedFile() = default;

  void* data_ = nullptr;
  std::size_t size_ = 0;
};

}  // namespace strata
