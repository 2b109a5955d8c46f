#pragma once

#include <shapefil.h>

#include <cstdint>
#include <map>
#include <span>
#include <string>

namespace strata::query {

// Files in memory for shapelib, and its first error message about them. While this object exists,
// calls of shapelib through `hooks` on the same thread read only these files. Nothing is written.
class ShapelibMemory {
 public:
  using Files = std::map<std::string, std::span<const std::uint8_t>>;
  explicit ShapelibMemory(Files files);  // by name; a file without bytes does not exist
  ~ShapelibMemory();
  ShapelibMemory(const ShapelibMemory&) = delete;
  ShapelibMemory& operator=(const ShapelibMemory&) = delete;

  SAHooks* hooks() { return &hooks_; }
  // Returns "<what>: <message of the library>." as the text of an error.
  std::string complaint(const std::string& what) const;

  struct OpenFile {
    std::span<const std::uint8_t> bytes;
    std::size_t at = 0;
  };

 private:
  static SAFile open(const char* name, const char* access);
  static void complain(const char* message);

  Files files_;
  SAHooks hooks_{};
  std::string complaint_;
  ShapelibMemory* outer_;
};

}  // namespace strata::query
