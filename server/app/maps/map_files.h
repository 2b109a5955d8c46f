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
  std::string name;      // as the sender calls it; empty when they did not say
  bool is_ours = false;  // is removed as soon as it is open
};

// The files of one flat map as they were sent: the body, the files of a form, or those of a zip.
// Told apart by their first bytes, so that a body needs no name.
class MapFiles {
 public:
  // Files of a zip lie in `scratch`, without names, while this lives. Refused (malformed,
  // too_large, unsupported, invalid): as unpack_archive refuses, several maps, no map.
  static Result<MapFiles> open(const std::vector<MapFile>& files,
                               const std::filesystem::path& scratch);

  MapKind kind() const { return kind_; }
  std::span<const std::uint8_t> main() const { return files_[main_].bytes; }
  std::string_view text() const;
  // The bytes of the file that goes with the main one and has one of these endings ("prj"); empty:
  // it was not sent.
  std::span<const std::uint8_t> companion(std::initializer_list<std::string_view> endings) const;
  std::string_view companion_text(std::initializer_list<std::string_view> endings) const;
  // Sizes and hashes, for the journal: those of the body, or `files` where it is several.
  nlohmann::json record() const;

 private:
  Result<void> choose_main();

  std::vector<mesh::InputFiles::Entry> files_;
  std::size_t main_ = 0;
  MapKind kind_ = MapKind::geojson;
};

}  // namespace strata::app
