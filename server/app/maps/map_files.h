#pragma once

#include <filesystem>
#include <initializer_list>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.h"
#include "mesh/io/input_files.h"

namespace strata::app {

enum class MapKind { geojson, shapefile, picture, tiff };

struct MapFile {
  std::filesystem::path path;
  std::string name;      // the sender's file name; may be empty
  bool is_ours = false;  // deleted as soon as it is open
};

// The files of one map as the user sent them: the request body, the files of a form, or the files
// in a zip. The first bytes of a file show its type, so a body does not need a name.
class MapFiles {
 public:
  // Extracts a zip to unnamed files in `scratch`, which exist as long as this object. Refuses the
  // same files as unpack_archive does (malformed, too_large, unsupported, invalid). Also refuses
  // several maps, or files without a map.
  static Result<MapFiles> open(const std::vector<MapFile>& files,
                               const std::filesystem::path& scratch);

  MapKind kind() const { return kind_; }
  std::span<const std::uint8_t> main() const { return files_[main_].bytes; }
  std::string_view text() const;
  // Returns the bytes of the file with the name of the main file and one of these extensions
  // ("prj"). Returns no bytes if the user did not send this file.
  std::span<const std::uint8_t> companion(std::initializer_list<std::string_view> endings) const;
  std::string_view companion_text(std::initializer_list<std::string_view> endings) const;
  // Returns the size and hash of the body for the journal, or a list `files` if there are several
  // files.
  nlohmann::json record() const;

 private:
  Result<void> choose_main();

  std::vector<mesh::InputFiles::Entry> files_;
  std::size_t main_ = 0;
  MapKind kind_ = MapKind::geojson;
};

}  // namespace strata::app
