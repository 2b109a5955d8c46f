#include "app/maps/map_files.h"

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <optional>

#include "core/digest.h"
#include "core/mapped_file.h"
#include "core/text/ascii.h"
#include "media/picture.h"
#include "mesh/io/unpack.h"
#include "query/maps/map_tiff.h"
#include "query/maps/shapefile.h"

namespace strata::app {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxNamed = 5;

std::string_view last_part(std::string_view name) {
  return name.substr(name.find_last_of("/\\") + 1);
}

std::string ending_of(std::string_view name) {
  const auto dot = last_part(name).rfind('.');
  return dot == std::string_view::npos ? std::string() : to_lower(last_part(name).substr(dot + 1));
}

std::string stem_of(std::string_view name) {
  const std::string_view last = last_part(name);
  return to_lower(last.substr(0, last.rfind('.')));
}

bool is_map_file(std::string_view name) {
  static constexpr std::array<std::string_view, 16> kEndings{
      "shp", "dbf", "prj",  "cpg", "geojson", "json", "tif", "tiff",
      "png", "jpg", "jpeg", "tfw", "pgw",     "jgw",  "wld", "tifw"};
  return std::find(kEndings.begin(), kEndings.end(), ending_of(name)) != kEndings.end();
}

std::string_view as_text(std::span<const std::uint8_t> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

// Returns the type of a map file. Returns nothing for a file that only accompanies another file.
std::optional<MapKind> kind_of(const mesh::InputFiles::Entry& file, bool is_alone) {
  if (query::is_shapefile(file.bytes) && ending_of(file.name) != "shx") return MapKind::shapefile;
  if (query::is_tiff(file.bytes)) return MapKind::tiff;
  if (picture_format(file.bytes)) return MapKind::picture;
  const std::string ending = ending_of(file.name);
  if (ending == "tif" || ending == "tiff") return MapKind::tiff;
  if (ending == "png" || ending == "jpg" || ending == "jpeg") return MapKind::picture;
  if (ending == "shp") return MapKind::shapefile;
  if (ending == "geojson" || ending == "json") return MapKind::geojson;
  const bool is_part = ending == "dbf" || ending == "prj" || ending == "cpg" || ending == "shx";
  // Detects JSON without a known extension: `{` or `[` after blanks and a byte order mark.
  const std::string_view text = as_text(file.bytes);
  const auto begin = text.find_first_not_of("\xef\xbb\xbf \t\r\n");
  const bool may_be_json =
      begin == std::string_view::npos || text[begin] == '{' || text[begin] == '[';
  return is_alone && !is_part && may_be_json ? std::optional(MapKind::geojson) : std::nullopt;
}

bool is_zip(std::span<const std::uint8_t> bytes) {
  return as_text(bytes).starts_with("PK\x03\x04");
}

}  // namespace

Result<MapFiles> MapFiles::open(const std::vector<MapFile>& files, const fs::path& scratch) {
  MapFiles map;
  std::optional<Error> unreadable;
  for (const MapFile& file : files) {
    auto mapped = MappedFile::open(file.path);
    if (file.is_ours) {
      std::error_code ignored;
      fs::remove(file.path, ignored);  // the memory mapping stays valid
    }
    if (!mapped) {
      unreadable = mapped.error();
      continue;
    }
    const auto bytes = mapped->bytes();
    map.files_.push_back({file.name, bytes, std::move(*mapped)});
  }
  if (unreadable) return tl::unexpected(*unreadable);
  if (map.files_.size() == 1 && is_zip(map.files_[0].bytes)) {
    Progress progress;
    auto unpacked = mesh::unpack_archive(map.files_[0].bytes, scratch, progress, is_map_file);
    if (!unpacked) {
      Error problem = unpacked.error();
      problem.field = "body";
      return tl::unexpected(std::move(problem));
    }
    map.files_ = std::move(*unpacked);
  }
  STRATA_TRY(map.choose_main());
  return map;
}

Result<void> MapFiles::choose_main() {
  std::vector<std::size_t> maps;
  for (std::size_t i = 0; i < files_.size(); ++i)
    if (kind_of(files_[i], files_.size() == 1)) maps.push_back(i);
  if (maps.empty())
    return fail(
        ErrorCode::unsupported, "No map found",
        files_.empty()
            ? "The zip contains no map: no .shp, .geojson, .tif, .png or .jpg file."
            : std::string(last_part(files_.front().name)).substr(0, 100) +
                  " is not a map on its own. Send it together with its .shp file or its picture. "
                  "The server can read GeoJSON, shapefiles, TIFF, PNG and JPEG. Convert a "
                  "GeoPackage or KML to GeoJSON first, for example with QGIS or ogr2ogr.",
        "body");
  if (maps.size() > 1) {
    std::string named;
    for (std::size_t i = 0; i < std::min(maps.size(), kMaxNamed); ++i)
      named += (i ? ", " : "") + std::string(last_part(files_[maps[i]].name)).substr(0, 100);
    return fail(ErrorCode::invalid, "More than one map",
                "Send one map at a time. The upload contains several: " + named +
                    (maps.size() > kMaxNamed ? ", …" : "") + ".",
                "body");
  }
  main_ = maps.front();
  kind_ = *kind_of(files_[main_], files_.size() == 1);
  return {};
}

std::string_view MapFiles::text() const { return as_text(main()); }

std::span<const std::uint8_t> MapFiles::companion(
    std::initializer_list<std::string_view> endings) const {
  const mesh::InputFiles::Entry* other = nullptr;
  for (std::size_t i = 0; i < files_.size(); ++i) {
    const auto& file = files_[i];
    const std::string ending = ending_of(file.name);
    if (i == main_ || std::find(endings.begin(), endings.end(), ending) == endings.end()) continue;
    if (stem_of(file.name) == stem_of(files_[main_].name)) return file.bytes;
    other = &file;
  }
  return other ? other->bytes : std::span<const std::uint8_t>();
}

std::string_view MapFiles::companion_text(std::initializer_list<std::string_view> endings) const {
  std::string_view text = as_text(companion(endings));
  if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);
  while (!text.empty() && static_cast<unsigned char>(text.front()) <= ' ') text.remove_prefix(1);
  while (!text.empty() && static_cast<unsigned char>(text.back()) <= ' ') text.remove_suffix(1);
  return text;
}

nlohmann::json MapFiles::record() const {
  if (files_.size() == 1)
    return {{"bytes", files_[0].bytes.size()}, {"sha256", sha256_hex(as_text(files_[0].bytes))}};
  nlohmann::json list = nlohmann::json::array();
  for (const auto& file : files_)
    list.push_back({{"name", std::string(last_part(file.name))},
                    {"bytes", file.bytes.size()},
                    {"sha256", sha256_hex(as_text(file.bytes))}});
  return {{"files", std::move(list)}};
}

}  // namespace strata::app
