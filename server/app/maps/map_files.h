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
  std::string name;      // the sender's name; may be empty
  bool is_ours = false;  // removed as soon as it is open
};

// The files of one map as they were sent: the body, the files of a form, or those of a zip. Their
// first bytes distinguish them, so a body needs no name.
class MapFiles {
 public:
  // Extracts a zip to unnamed files in `scratch`, which live as long as this. Refuses (malformed,
  // too_large, unsupported, invalid) as unpack_archive does, and several maps or none.
  static Result<MapFiles> open(const std::vector<MapFile>& files,
                               const std::filesystem::path& scratch);

  MapKind kind() const { return kind_; }
  std::span<const std::uint8_t> main() const { return files_[main_].bytes; }
  std::string_view text() const;
  // Returns the bytes of the main file's companion with one of these extensions ("prj"); empty if
  // it was not sent.
  std::span<const std::uint8_t> companion(std::initializer_list<std::string_view> endings) const;
  std::string_view companion_text(std::initializer_list<std::string_view> endings) const;
  // Returns sizes and hashes for the journal: those of the body, or `files` for several.
  nlohmann::json record() const;

 private:
  Result<void> choose_main();

  std::vector<mesh::InputFiles::Entry> files_;
  std::size_t main_ = 0;
  MapKind kind_ = MapKind::geojson;
};

}  // namespace strata::app
