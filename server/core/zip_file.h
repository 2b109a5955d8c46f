#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "core/error.h"
#include "core/progress.h"

namespace strata {

// Appends the next piece of a content to a text. Returns false at the end, without a piece.
using NextPiece = std::function<bool(std::string& text)>;

// A file in a zip.
struct ZipEntry {
  std::string name;  // with folders, separated by "/"
  // Bytes, which must outlive the writing, a file, or a function that begins to make the content.
  // Pieces are made while the zip is written, so the content is never complete in memory.
  std::variant<std::span<const std::uint8_t>, std::filesystem::path, std::function<NextPiece()>>
      content;
  bool deflates = true;  // false: stored, for content that is compressed already
};

// Writes a zip with these files. The result depends only on the entries, so all files have the same
// time. Returns `storage_full` if the zip could not be written, and `cancelled`. No unfinished file
// remains.
Result<void> write_zip(const std::vector<ZipEntry>& entries, const std::filesystem::path& file,
                       Progress& progress);

}  // namespace strata
