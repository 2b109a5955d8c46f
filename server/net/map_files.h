#pragma once

#include <filesystem>
#include <initializer_list>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "mesh/input_files.h"
#include "net/http/http_types.h"

namespace strata::net {

enum class MapKind { geojson, shapefile, picture, tiff };

// The files of one flat map as they were sent: the body, the files of a form, or those of a zip.
// Told apart by their first bytes, so that a body needs no name.
class MapFiles {
 public:
  // Parts of a form and of a zip lie in `scratch`, without names, while this lives. Refused (400,
  // 413, 415, 422): as take_upload and unpack_archive refuse, several maps, no map.
  static Result<MapFiles> take(const Request& request, const std::filesystem::path& scratch);

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

}  // namespace strata::net
